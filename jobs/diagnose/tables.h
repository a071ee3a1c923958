// A diagnosis as sentences and tables: for terminal and page, and as CSV files.
#pragma once

#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"
#include "jobs/compare/curves.h"
#include "jobs/diagnose/folder.h"
#include "report/html.h"

namespace strut {

/// "0.300 (0.298 to 0.302)": to the second digit of the interval.
std::string describe_interval(double value, double low, double high);

/// One sentence on where the residual is largest; empty where there is none.
std::string make_where_text(const Where& where);

/// Causes, members of the group, the first runners-up, and no effect of the catalogue. Empty where
/// nothing was fitted.
std::vector<ReportTable> make_cause_tables(const Diagnosis& diagnosis,
                                           std::size_t max_runners_up = 12);
/// Errors of the nominal, the calibrated and the extended model by held-out run and channel.
ReportTable make_improvement_table(const CampaignData& data, const Diagnosis& diagnosis);
/// Meaning of each claimed effect, with its law and its entry in the documentation.
std::vector<std::string> describe_effects(const Verdict& verdict);
/// Parameters before and after the extension; empty where none is free.
std::vector<ReportTable> make_parameter_tables(const Diagnosis& diagnosis);

/// The text for the terminal: verdict, effects, probabilities, errors, parameters, next
/// measurement.
std::string make_diagnose_text(const CampaignData& data, const Diagnosis& diagnosis);

/// The curves of the calibrated and, where there is one, the extended model.
std::vector<ModelCurves> list_model_curves(const Diagnosis& diagnosis, const DiagnosedRun& run);

/// Writes for every run NAME.csv: time and, for every channel, measured, calibrated and extended;
/// and force_map.csv for a force map. Returns their names. Throws EnvironmentError.
std::vector<std::string> write_diagnose_tables(const DiagnoseFolder& folder,
                                               const CampaignData& data,
                                               const Diagnosis& diagnosis);

}  // namespace strut
