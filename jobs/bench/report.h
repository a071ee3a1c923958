// Results of `strut bench` as a table and as JSON, and their ratios to an earlier result.
#pragma once

#include <algorithm>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "io/format/read_json.h"
#include "jobs/bench/cases.h"
#include "jobs/bench/pipeline.h"
#include "jobs/cli/machine.h"
#include "model/kernel/count_flops.h"

namespace strut {

struct Figure {
  BenchSetting setting;
  double runs_per_s = 0.0;
  double real_time_factor = 0.0;
  double error = 0.0;         // measure_error()
  double spin_control = 0.0;  // during the best repeat; 1: undisturbed machine
  double rhs_per_s = 0.0;     // right-hand sides of single cases per second
  // Independent of other programs on the machine:
  double rhs_per_run = 0.0;  // count_right_hand_sides()
  double flops_per_run = 0.0;
  std::optional<double> instructions_per_run = {};  // where the system counts them
};

struct ThreadFigure {
  int threads = 1;
  double runs_per_s = 0.0;
  double spin_control =
      0.0;  // spin rate of all threads together, relative to one undisturbed thread
};

struct BenchResult {
  std::vector<Figure> single_core;
  std::vector<Figure> candidates;  // speed over error: all that were tried for the fastest
  std::vector<ThreadFigure> threads;
  FlopCount newton, table;
  double peak = 0.0;  // peak of one core [flop/s]
  double seconds_to_prepare = 0.0;
  std::optional<PipelineResult> pipeline;  // empty: no sweep was run
  Machine machine;

  const Figure& figure(const std::string& name) const {
    return *std::find_if(single_core.begin(), single_core.end(),
                         [&](const Figure& f) { return f.setting.label == name; });
  }
  double speedup_over_double(const Figure& f) const {
    return f.runs_per_s / figure("double").runs_per_s;
  }
  double fraction_of_peak(const Figure& f) const {
    return f.flops_per_run / f.rhs_per_run * f.rhs_per_s / peak;
  }
};

/// The output of an earlier `strut bench --json`.
using Baseline = Json;

/// Throws InputError if the file is not such an output.
Baseline read_baseline(const std::string& path);

/// new / old of one figure.
struct FigureRatio {
  std::string name;
  double ratio = 0.0;
  /// The ratio of speeds on undisturbed processors, by spin control; nothing where a measurement
  /// has no spin control, or one below half of an undisturbed core.
  std::optional<double> corrected = {};
  bool is_count = false;  // that no other program changes
};

/// The ratios of all figures that both results have.
std::vector<FigureRatio> compare(const BenchResult& result, const Baseline& baseline);

/// `ratios` may be empty.
void print_json(std::ostream& stream, const BenchResult& result,
                const std::vector<FigureRatio>& ratios);
void print_table(std::ostream& stream, const BenchResult& result,
                 const std::vector<FigureRatio>& ratios);

}  // namespace strut
