// From finished simulations to readings: the channels as their sensors read them. Every program
// that writes or shows channels runs its simulations through ReadOut.
#pragma once

#include <vector>

#include "model/car/channels.h"
#include "model/integrate/run_plan.h"
#include "model/sensor/sensors.h"

namespace strut {

/// Maximum interval of the samples from which a sensor with memory makes its readings [s].
inline constexpr double kSensorInterval = 1e-3;

/// The sensor effects of simulations that run in lanes.
class ReadOut {
 public:
  /// `channels` of the model, and the effects of the simulation in each lane.
  ReadOut(const std::vector<ChannelInfo>& channels,
          const std::vector<const EffectSettings*>& effects);

  /// The plan to simulate for the readings that `requested` describes: it has more samples where a
  /// sensor with memory is on. The requested samples and the snapshot keep every bit.
  SamplePlan make_plan(const SamplePlan& requested) const;

  /// Turns history and snapshot of a run by make_plan into readings at the requested samples.
  /// Simulations that failed and channels without effects keep every bit. Where a sensor is on, the
  /// history must hold all channels.
  void read(const SamplePlan& requested, LaneResults& run) const;

 private:
  struct Reading {
    int lane, channel;
    ChannelSensor sensor;
  };

  std::vector<Reading> readings_;  // channels whose sensor is on
  bool has_memory_ = false;
};

/// Readings of `simulate(plan)`, which runs the simulations of `out`.
template <class Simulate>
LaneResults simulate_readings(const ReadOut& out, const SamplePlan& requested,
                              const Simulate& simulate) {
  LaneResults run = simulate(out.make_plan(requested));
  out.read(requested, run);
  return run;
}

}  // namespace strut
