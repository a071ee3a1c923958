// A run's measured and simulated curves, as a chart and as columns of a table.
#pragma once

#include <string>
#include <vector>

#include "diagnose/baseline/baseline.h"
#include "io/table/csv.h"
#include "report/chart.h"

namespace strut {

/// Colors of one thing in all charts of comparisons and diagnoses.
inline constexpr int kMeasuredColor = kInk, kNominalColor = 6, kCalibratedColor = 5;
inline constexpr int kExtendedColor = 1, kNoiseColor = 4;

struct ModelCurves {
  std::string name;  // "calibrated"
  int color = kCalibratedColor;
  const RunEvaluation* evaluation = nullptr;

  bool is_simulated() const {
    return evaluation->failure.empty() && !evaluation->curves.channel.empty();
  }
};

/// The base name of a run's files: "run_2_chirp_A2".
std::string make_run_name(const CampaignData& data, std::size_t run);

/// The files of all runs' tables: "run_2_chirp_A2.csv".
std::vector<std::string> list_run_tables(const CampaignData& data);

/// The stride by which `count` points are thinned for a chart: more would not be visible and make
/// the report too large to mail.
std::size_t choose_stride(std::size_t count);

/// Every channel over time, with the models' residuals below. Models that could not be simulated
/// are left out; at least one must have been.
Chart make_curve_chart(const CampaignData& data, std::size_t run,
                       const std::vector<ModelCurves>& models);

/// Columns time and, for every channel, measured and simulated: "sprung_position",
/// "sprung_position_calibrated".
std::vector<CsvColumn> make_curve_columns(const CampaignData& data, std::size_t run,
                                          const std::vector<ModelCurves>& models);

}  // namespace strut
