// A run's measured curves beside those of models: a chart, and columns of a table.
#pragma once

#include <string>
#include <vector>

#include "diagnose/baseline/baseline.h"
#include "io/format/csv.h"
#include "report/chart.h"

namespace strut {

struct ModelCurves {
  std::string name;  // "calibrated"
  int color = 1;     // of charts
  const RunEvaluation* evaluation = nullptr;

  bool is_simulated() const {
    return evaluation->failure.empty() && !evaluation->curves.channel.empty();
  }
};

/// "run_2_chirp_A2": of a run's files.
std::string make_run_name(const CampaignData& data, std::size_t run);

/// "run_2_chirp_A2.csv": the tables of all runs.
std::vector<std::string> list_run_tables(const CampaignData& data);

/// More points are not seen, and make a report too large to mail: every so many of `count` will do.
std::size_t choose_stride(std::size_t count);

/// Every channel over time, below it what the models leave; those that could not be simulated are
/// left out, one must not be.
Chart make_curve_chart(const CampaignData& data, std::size_t run,
                       const std::vector<ModelCurves>& models);

/// time, and of every channel measured and simulated: "sprung_position",
/// "sprung_position_calibrated".
std::vector<CsvColumn> make_curve_columns(const CampaignData& data, std::size_t run,
                                          const std::vector<ModelCurves>& models);

}  // namespace strut
