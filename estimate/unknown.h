// The unknowns of a fit: parameters of the model, and nuisances of each run.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "estimate/measured_run.h"
#include "model/effects/force_map.h"
#include "model/rig/rigs.h"

namespace strut {

enum class UnknownKind {
  kParameter,     // a parameter of the model (model_files/read_model.h)
  kHitTime,       // simulated time minus the time of the measuring clock [s]
  kBias,          // offset added to a simulated channel, in its unit
  kInputGain,     // factor on a recorded input
  kInputBias,     // offset of the sensor of an input or of one of its time derivatives
  kInitialState,  // initial offset of a mass from rest [m], or its initial velocity [m/s]
  kForceMap,      // factor on a part of a strut's force map
  kSensorGain,    // relative error of a channel's gain (estimate/sensor_error.h)
  kSensorSkew,    // delay of a channel against the others [s]
};

/// Gaussian prior; an infinite sigma is no prior.
struct Prior {
  double mean = 0.0;
  double sigma = std::numeric_limits<double>::infinity();

  bool informs() const { return sigma < std::numeric_limits<double>::infinity(); }
};

inline constexpr int kEveryRun = -1;

struct Unknown {
  UnknownKind kind = UnknownKind::kParameter;
  std::string name;     // "front_stiffness", "hit_time", "imu_rate_y_bias"
  std::string unit;     // "1" if dimensionless
  int run = kEveryRun;  // index of its run, or kEveryRun: one value for all runs
  int channel = -1;     // of a sensor's error: index in ModelInfo::channels
  int input = -1;       // kInputGain, kInputBias: index in ModelInfo::inputs
  int derivative = 0;   // kInputBias: time derivative of the input that its sensor reads
  int state = -1;      // kInitialState: index in the list of all masses' positions, then velocities
  double start = 0.0;  // initial guess
  double scale = 1.0;  // 100 %: its size, or the sigma of its prior where it starts from 0
  double low = 0.0, high = 0.0;  // bounds
  Prior prior;
  std::shared_ptr<const ForceMap> part{};  // kForceMap: the map that the factor multiplies
};

/// Whether an unknown belongs to run number `run`, alone or as one of all runs.
inline bool belongs(const Unknown& u, std::size_t run) {
  return u.run == kEveryRun || static_cast<std::size_t>(u.run) == run;
}

/// Whether an unknown is a small error that a sensor's data sheet allows: of its gain, or its skew.
inline bool is_sensor_tolerance(const Unknown& u) {
  return u.kind == UnknownKind::kSensorGain || u.kind == UnknownKind::kSensorSkew;
}

/// Whether an unknown is an error of a channel's sensor (estimate/sensor_error.h).
inline bool is_sensor_error(const Unknown& u) {
  return u.kind == UnknownKind::kBias || is_sensor_tolerance(u);
}

/// Whether the simulation depends on an unknown: not on hit times and errors of sensors, which only
/// affect the readings.
inline bool is_simulated(const Unknown& u) {
  return u.kind != UnknownKind::kHitTime && !is_sensor_error(u);
}

/// Makes a parameter within its plausible range, with its value in the run's setup as initial guess
/// (kEveryRun: in the first run's). Throws InputError with the nearest known name, or where it
/// cannot be fitted.
Unknown make_parameter(const std::vector<MeasuredRun>& runs, const std::string& name,
                       int run = kEveryRun);

/// Makes an unknown that all runs share, by its name: a parameter, INPUT_gain, INPUT_bias, or
/// CHANNEL_bias of a channel of runs.front(). Throws InputError with the nearest known name.
Unknown make_shared_unknown(const std::vector<MeasuredRun>& runs, const std::string& name);

/// Makes the bias of a sensor that reads an input or one of its time derivatives: its reading less
/// the true value, starts at prior.mean. `scale`: the size of the readings. Throws CheckError for a
/// derivative that the input does not have.
Unknown make_input_bias(const ModelInfo& model, int run, const InputDerivative& sensor,
                        const Prior& prior, double scale);

/// Corrections of recorded inputs by the gains and biases among `values` that belong to every run
/// or to run number `run`, in the order of ModelInfo::inputs. A gain acts on the reading less its
/// bias.
std::array<InputCorrection, kMaxRigInputs> list_corrections(const std::vector<Unknown>& unknowns,
                                                            const std::vector<double>& values,
                                                            int run);

/// Makes a hit time, bounded by mean +/- kHitTimeReach sigma. sigma > 0.
Unknown make_hit_time(int run, const Prior& prior);
inline constexpr double kHitTimeReach = 5.0;
inline constexpr char kHitTimeName[] = "hit_time";

/// Makes the bias of a channel, without bounds. sigma > 0, may be infinite.
Unknown make_bias(const ModelInfo& model, int run, int channel, const Prior& prior);

/// Bounds of gain errors and skews, in standard deviations. Where the model is far off, a fit would
/// need more than a sensor can be wrong.
inline constexpr double kSensorReach = 3.0;

/// Makes the relative error of a channel's gain or its skew [s], kSensorGain or kSensorSkew, around
/// 0, within kSensorReach sigma. sigma > 0.
Unknown make_sensor_unknown(UnknownKind kind, const ModelInfo& model, int run, int channel,
                            double sigma);

/// Makes the factor on a part of the force map at the part's location; starts at prior.mean,
/// without bounds.
Unknown make_map_unknown(const std::string& name, std::shared_ptr<const ForceMap> part,
                         const Prior& prior);

/// Adds `factor` times a part to the map at its location, which is created if missing. Throws
/// ModelError where the map there has a different grid.
void add_map_part(ForceMaps& maps, const ForceMap& part, double factor);

/// Whether the list has an unknown of this name, for any run.
bool is_among(const std::vector<Unknown>& unknowns, const std::string& name);

/// The initial guess of every unknown.
std::vector<double> list_starts(const std::vector<Unknown>& unknowns);

/// Returns the run with the unknowns set that belong to every run or to run number `run`:
/// parameters, force maps, gains (which also scale the noise) and biases of inputs, initial states,
/// but not hit times and biases. Throws as set_parameter does.
MeasuredRun set_unknowns(MeasuredRun measured, const std::vector<Unknown>& unknowns,
                         const std::vector<double>& values, int run = kEveryRun);

/// Sets an initial state of a rig; `state` as in Unknown::state.
void set_initial_state(RigSpec& rig, int state, double value);

/// Throws InputError where an unknown is listed twice, belongs to a run that does not exist, starts
/// outside of its bounds, or has a prior whose sigma is not positive.
void check_unknowns(const std::vector<Unknown>& unknowns, std::size_t run_count);

}  // namespace strut
