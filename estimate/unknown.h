// The unknowns of a fit: parameters of the model, and the nuisances of every measurement.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "estimate/measured_run.h"
#include "model/effects/force_map.h"

namespace strut {

enum class UnknownKind {
  kParameter,     // of model_files/read_model.h
  kHitTime,       // s: simulated time minus the time of the measuring clock
  kBias,          // what is to be added to a simulated channel, in its unit
  kInputGain,     // what a recorded input is to be multiplied by
  kInitialState,  // of a mass: offset of its start from rest [m], [m/s]
  kForceMap,      // how many times its part is in the force map of a strut
};

/// Prior knowledge: a Gaussian; sigma infinite: none.
struct Prior {
  double mean = 0.0;
  double sigma = std::numeric_limits<double>::infinity();

  bool informs() const { return sigma < std::numeric_limits<double>::infinity(); }
};

inline constexpr int kEveryRun = -1;

struct Unknown {
  UnknownKind kind = UnknownKind::kParameter;
  std::string name;     // "front_stiffness", "hit_time", "imu_rate_y_bias"
  std::string unit;     // "1" if none
  int run = kEveryRun;  // of which run, counted from 0; or one value for all
  /// kBias: of ModelInfo::channels; kInputGain: of its inputs; kInitialState: of its masses, their
  /// velocities behind all positions.
  int channel = 0;
  double start = 0.0;  // where the search begins
  double scale = 1.0;  // 100 % of it: its size, or the sigma of its prior where it starts from 0
  double low = 0.0, high = 0.0;  // bounds
  Prior prior;
  std::shared_ptr<const ForceMap> part{};  // of kForceMap
};

/// Whether an unknown is one of run number `run`.
inline bool belongs(const Unknown& u, std::size_t run) {
  return u.run == kEveryRun || static_cast<std::size_t>(u.run) == run;
}

/// Whether it changes what is simulated of a car in a maneuver, not only how that is read.
inline bool is_of_simulation(const Unknown& u) {
  return u.kind == UnknownKind::kParameter || u.kind == UnknownKind::kForceMap;
}

/// A parameter, bounded by what is plausible, starting at the value of the run's setup (kEveryRun:
/// of the first). Throws InputError with the nearest known name, or where it cannot be fitted.
Unknown make_parameter(const std::vector<MeasuredRun>& runs, const std::string& name,
                       int run = kEveryRun);

/// An unknown that all runs share, by its name: a parameter, NAME_gain of an input or NAME_bias of
/// a channel that runs.front() has. Throws InputError with the nearest known name.
Unknown make_shared_unknown(const std::vector<MeasuredRun>& runs, const std::string& name);

/// Bounds mean +- kHitTimeReach sigma. sigma > 0.
Unknown make_hit_time(int run, const Prior& prior);
inline constexpr double kHitTimeReach = 5.0;

/// Without bounds. sigma > 0, may be infinite.
Unknown make_bias(const ModelInfo& model, int run, int channel, const Prior& prior);

/// The factor of a part of the map at its place: begins at 0, without bounds.
Unknown make_map_unknown(const std::string& name, std::shared_ptr<const ForceMap> part,
                         const Prior& prior);

/// Adds `factor` times a part to the map at its place; where there is none the map is that alone.
/// Throws ModelError where the map there has another grid.
void add_map_part(ForceMaps& maps, const ForceMap& part, double factor);

/// Where the search of each begins.
std::vector<double> list_starts(const std::vector<Unknown>& unknowns);

/// The run with the parameters, force maps, gains of inputs and initial states among the unknowns
/// that belong to it: to all runs, or to number `run` alone. The noise of an input is scaled with
/// it; hit times and biases are left out. Throws what set_parameter throws.
MeasuredRun set_unknowns(MeasuredRun measured, const std::vector<Unknown>& unknowns,
                         const std::vector<double>& values, int run = kEveryRun);

/// Sets a rig's initial state: a kInitialState's `channel` and value.
void set_initial_state(RigSpec& rig, int channel, double value);

/// Throws InputError where one is named twice, belongs to no run, starts out of its bounds, or has
/// a prior whose sigma is not positive.
void check_unknowns(const std::vector<Unknown>& unknowns, std::size_t run_count);

}  // namespace strut
