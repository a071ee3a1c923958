// A comparison as tables: for terminal and page, and as CSV files.
#pragma once

#include <string>
#include <vector>

#include "diagnose/compare/compare.h"
#include "jobs/compare/curves.h"
#include "jobs/compare/folder.h"
#include "report/html.h"

namespace strut {

/// The comparison of a channel; null if the model could not be simulated or lacks the channel.
const ChannelComparison* find_channel(const ModelComparison& model, int channel);

/// One sentence: whether the model is adequate, or its worst channel.
std::string make_verdict_text(const CampaignData& data, const Comparison& comparison);

/// Tables of parameters, and of residuals by run and channel.
std::vector<ReportTable> make_compare_tables(const CampaignData& data,
                                             const Comparison& comparison);

/// Tables of one run's residuals of the calibrated model by time and band, and of its body balance.
std::vector<ReportTable> make_run_tables(const CampaignData& data, const RunComparison& run);

/// Writes channels.csv, and for every run NAME.csv: time and, for every channel, measured, nominal
/// and calibrated; where there is a body balance, its curves. Returns their names. Throws
/// EnvironmentError.
std::vector<std::string> write_compare_tables(const CompareFolder& folder, const CampaignData& data,
                                              const Comparison& comparison);

/// The curves of the nominal and the calibrated model.
std::vector<ModelCurves> list_model_curves(const RunComparison& run);

}  // namespace strut
