// What `strut bench` found, as a table, as JSON, and against an earlier one.
#pragma once

#include <algorithm>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "io/format/read_json.h"
#include "jobs/bench/cases.h"
#include "jobs/bench/count_flops.h"
#include "jobs/bench/pipeline.h"
#include "jobs/cli/machine.h"

namespace strut {

struct Figure {
  BenchSetting setting;
  double runs_per_s = 0.0;
  double real_time_factor = 0.0;
  double error = 0.0;         // body acceleration rms, relative to CVODE at 1e-12, worst lane
  double spin_control = 0.0;  // during the best repeat, 1: machine undisturbed
  double rhs_per_s = 0.0;     // right-hand sides a second, of one case each
};

struct ThreadFigure {
  int threads = 1;
  double runs_per_s = 0.0;
  double spin_control = 0.0;  // spins of all threads at once over those of one alone
};

struct BenchResult {
  std::vector<Figure> single_core;
  std::vector<ThreadFigure> threads;
  FlopCount newton, table;
  double peak = 0.0;  // flop/s of one core
  double seconds_to_prepare = 0.0;
  std::optional<PipelineResult> pipeline;  // none where there is no sweep to run
  Machine machine;

  const Figure& figure(const std::string& name) const {
    return *std::find_if(single_core.begin(), single_core.end(),
                         [&](const Figure& f) { return f.setting.label == name; });
  }
  double speedup_over_double(const Figure& f) const {
    return f.runs_per_s / figure("double").runs_per_s;
  }
  double share_of_peak(const Figure& f) const {
    const FlopCount& flops = f.setting.options.closure == Closure::kNewton ? newton : table;
    return static_cast<double>(flops.arithmetic) * f.rhs_per_s / peak;
  }
};

/// The output of an earlier `strut bench --json`.
using Baseline = Json;

/// Throws InputError where the file is none.
Baseline read_baseline(const std::string& path);

/// new / old of one figure.
struct FigureRatio {
  std::string name;
  double ratio = 0.0;
};

/// The ratios of all figures that both have.
std::vector<FigureRatio> compare(const BenchResult& result, const Baseline& baseline);

/// `ratios` may be empty.
void print_json(std::ostream& stream, const BenchResult& result,
                const std::vector<FigureRatio>& ratios);
void print_table(std::ostream& stream, const BenchResult& result,
                 const std::vector<FigureRatio>& ratios);

}  // namespace strut
