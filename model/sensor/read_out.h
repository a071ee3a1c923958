// From finished simulations to what is given out of them: the channels as their sensors read them.
// Whatever writes or shows channels runs its simulation through here.
#pragma once

#include <vector>

#include "model/car/channels.h"
#include "model/integrate/run_plan.h"
#include "model/sensor/sensors.h"

namespace strut {

/// Longest time between the samples of which a sensor with memory makes its readings [s].
inline constexpr double kSensorInterval = 1e-3;

class ReadOut {
 public:
  /// `channels` of the model, and the effects of each simulation that runs in lanes.
  ReadOut(const std::vector<ChannelInfo>& channels,
          const std::vector<const EffectSettings*>& effects);

  /// What to record where `asked` is to be read: more samples where a sensor with memory is on.
  /// Those of `asked` and the snapshot stay as they are, bit for bit.
  SamplePlan make_plan(const SamplePlan& asked) const;

  /// History and snapshot become readings, with the samples that `asked` wants. Simulations that
  /// failed and channels without effects keep every bit.
  void read(const SamplePlan& asked, LaneResults& run) const;

 private:
  struct Reading {
    std::size_t lane, channel;
    ChannelSensor sensor;
  };

  std::size_t channel_count_;
  std::vector<Reading> readings_;  // those that are on
  bool has_memory_ = false;
};

/// `simulate(plan)` runs what `out` was made for.
template <class Simulate>
LaneResults simulate_readings(const ReadOut& out, const SamplePlan& asked,
                              const Simulate& simulate) {
  LaneResults run = simulate(out.make_plan(asked));
  out.read(asked, run);
  return run;
}

}  // namespace strut
