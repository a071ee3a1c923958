// Runs of a rig simulated in many variants, as many at once as the processor has SIMD lanes, in
// steps that feel the stroke which a worn strut has lost.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "estimate/measured_run.h"
#include "estimate/unknown.h"
#include "model/integrate/run_plan.h"
#include "model/rig/rigs.h"

namespace strut {

/// What is not exact about a measured input.
struct InputNoise {
  double sigma = 0.0;       // 1 sigma per sample, in the input's unit
  double half_width = 0.0;  // s, of the local cubics that smoothed it; 0: none did
};

struct RigRun {
  std::string name;  // the file, for messages
  RigSpec setup;
  std::vector<InputSignal> inputs;        // over `times`' clock
  std::vector<double> times;              // s, ascending from 0
  std::vector<MeasuredChannel> channels;  // readings may be NaN: missing
  std::vector<InputNoise> input_noise{};  // of each input
};

struct RigOptions {
  /// s at most between steps; a tenth of a radian of the fastest natural frequency is kept, too:
  /// RK4 then errs by 1e-6 of a phase.
  double longest_step = 2e-3;
  double relative_step = 1e-5;  // h of the central differences as a share of the scale
  int threads = 1;              // no result depends on it
};

/// The highest undamped natural frequency of the rig on its linear parts [rad/s]; 0 without masses.
double calc_fastest_mode(const RigSpec& spec);

/// The whole signal times a factor.
void scale_signal(InputSignal& signal, double factor);

/// Whether an unknown is one of run number `run`.
bool belongs(const Unknown& unknown, int run);

/// A run's setup with its unknowns set, and what its inputs are multiplied by.
struct RigVariant {
  RigSpec spec;
  std::array<double, kMaxRigInputs> gain{};  // in the order of list_rig_inputs
};

/// With those of `values` that belong to run number `index`; biases are no part of it. Throws
/// InputError where a value is out of its range.
RigVariant make_variant(const RigRun& run, int index, const std::vector<Unknown>& unknowns,
                        const std::vector<double>& values);
double get_gain(const RigVariant& variant, const std::string& input);
std::vector<InputSignal> scale_inputs(const RigRun& run, const RigVariant& variant);

/// How a run is sampled: at its own times where they are even, else finely enough to interpolate.
struct RigSampling {
  double interval = 0.0, step = 0.0;  // s; whole steps lie between samples
  bool even = false;
};

/// As its nominal setup needs.
RigSampling choose_sampling(const RigRun& run, const RigOptions& options);

/// What is to be simulated of a run; it must not outlive the run.
struct RigCase {
  const RigRun* run = nullptr;
  std::string failure;  // why it cannot be; empty: it can
  RigVariant variant;
  RigSampling sampling;

  RigCase(const RigRun& of, int index, const std::vector<Unknown>& unknowns,
          const std::vector<double>& values, const RigOptions& options);
};

/// A simulation, read at the run's times.
class RigResult {
 public:
  explicit RigResult(std::string failure) : failure_(std::move(failure)) {}
  RigResult(const RigCase& of, const LaneResults& results, int lane);

  const std::string& failure() const { return failure_; }
  /// NaN where the simulation cannot be interpolated.
  double read(std::size_t time, std::size_t channel) const;

 private:
  void read_sensors(const RigSpec& spec);

  std::string failure_;
  const RigRun* run_ = nullptr;
  RigSampling sampling_;
  std::size_t channels_ = 0, count_ = 0;
  std::vector<double> history_;  // [sample][channel]
};

/// Simulates each case and hands its result to `take`, once and from any thread, with the case's
/// number. What a case gives depends on no other case. Histories are long: none outlives its call.
void simulate_cases(const std::vector<RigCase>& cases, int threads,
                    const std::function<void(std::size_t, const RigResult&)>& take);

}  // namespace strut
