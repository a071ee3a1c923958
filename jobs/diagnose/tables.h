// A diagnosis as sentences and tables: for a person, and as CSV files.
#pragma once

#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"
#include "jobs/compare/curves.h"
#include "jobs/diagnose/folder.h"
#include "report/html.h"

namespace strut {

/// Where the residual is seen best, in one sentence; empty where there is nothing to say.
std::string make_where_text(const Where& where);

/// Causes, members of the group, the first runners-up, and that it is none of them. Nothing where
/// nothing was fitted.
std::vector<ReportTable> make_cause_tables(const Diagnosis& diagnosis,
                                           std::size_t most_runners_up = 12);
/// By channel over the runs held out.
ReportTable make_gain_table(const Diagnosis& diagnosis);
/// Nothing where the campaign lets the model adjust nothing.
std::vector<ReportTable> make_parameter_tables(const Diagnosis& diagnosis);

/// What the terminal shows: verdict, probabilities, gain, next measurement.
std::string make_diagnose_text(const Diagnosis& diagnosis);

/// Baseline; extended where there is such a model.
std::vector<ModelCurves> list_model_curves(const Diagnosis& diagnosis, const DiagnosedRun& run);

/// For every run NAME.csv: time, and of every channel measured, baseline, extended; of a force map
/// force_map.csv. Returns their names. Throws EnvironmentError.
std::vector<std::string> write_diagnose_tables(const DiagnoseFolder& folder,
                                               const CampaignData& data,
                                               const Diagnosis& diagnosis);

}  // namespace strut
