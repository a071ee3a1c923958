// A comparison as tables: for a person, and as CSV files.
#pragma once

#include <string>
#include <vector>

#include "diagnose/compare/compare.h"
#include "jobs/compare/curves.h"
#include "jobs/compare/folder.h"
#include "report/html.h"

namespace strut {

/// Adequate or not, and where it fails most, in one sentence.
std::string make_verdict_text(const CampaignData& data, const Comparison& comparison);

/// Parameters; then residuals by run and channel.
std::vector<ReportTable> make_compare_tables(const CampaignData& data,
                                             const Comparison& comparison);

/// One run's residuals of the calibrated model by time and band, and its body balance.
std::vector<ReportTable> make_run_tables(const CampaignData& data, const RunComparison& run);

/// Writes channels.csv, and for every run NAME.csv: time, and of every channel measured, nominal,
/// calibrated; with a body balance its curves. Returns their names. Throws EnvironmentError.
std::vector<std::string> write_compare_tables(const CompareFolder& folder, const CampaignData& data,
                                              const Comparison& comparison);

/// Nominal and calibrated.
std::vector<ModelCurves> list_model_curves(const RunComparison& run);

}  // namespace strut
