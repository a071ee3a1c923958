#include "model/sensor/read_out.h"

#include <cmath>

namespace strut {
namespace {

/// One channel of a run in lanes: its samples and, behind them, its snapshot.
class Channel {
 public:
  Channel(LaneResults& run, std::size_t channels, std::size_t channel, std::size_t lane)
      : run_(run),
        stride_(channels * static_cast<std::size_t>(run.lanes)),
        first_(channel * static_cast<std::size_t>(run.lanes) + lane),
        samples_(static_cast<std::size_t>(run.sample_count)) {}

  std::vector<double> get_samples() const {
    std::vector<double> values(samples_);
    for (std::size_t i = 0; i < samples_; ++i) values[i] = run_.history[i * stride_ + first_];
    return values;
  }
  /// The readings of a sensor that knows but the instant, the first `count` of all.
  std::vector<double> amplify(const ChannelSensor& sensor, std::size_t count) const {
    std::vector<double> values = get_samples();
    if (count > samples_) values.push_back(run_.snapshot[first_]);
    for (double& y : values) y = sensor.amplify(y);
    return values;
  }
  /// The snapshot's reading may be absent.
  void put(const std::vector<double>& readings) {
    for (std::size_t i = 0; i < samples_; ++i) run_.history[i * stride_ + first_] = readings[i];
    if (readings.size() > samples_) run_.snapshot[first_] = readings.back();
  }

 private:
  LaneResults& run_;
  std::size_t stride_, first_, samples_;
};

/// Keeps the first of every `parts` samples; none for 0.
void thin_out(std::size_t parts, std::size_t row, LaneResults& run) {
  const auto count = static_cast<std::size_t>(run.sample_count);
  std::size_t kept = 0;
  for (std::size_t i = 0; parts > 0 && i < count; i += parts, ++kept) {
    for (std::size_t k = 0; k < row; ++k) run.history[kept * row + k] = run.history[i * row + k];
  }
  run.sample_count = static_cast<int>(kept);
  run.history.resize(kept * row);
}

}  // namespace

ReadOut::ReadOut(const std::vector<ChannelInfo>& channels,
                 const std::vector<const EffectSettings*>& effects)
    : channel_count_(channels.size()) {
  for (std::size_t lane = 0; lane < effects.size(); ++lane) {
    for (std::size_t c = 0; c < channels.size() && !effects[lane]->empty(); ++c) {
      const ChannelSensor sensor = find_sensor(*effects[lane], channels[c].name);
      if (!sensor.is_on()) continue;
      readings_.push_back({lane, c, sensor});
      has_memory_ = has_memory_ || sensor.has_memory();
    }
  }
}

SamplePlan ReadOut::make_plan(const SamplePlan& asked) const {
  if (!has_memory_ || (asked.interval <= 0.0 && !asked.snapshot)) return asked;
  SamplePlan dense = asked;
  if (dense.interval <= 0.0) dense.interval = kSensorInterval;
  dense.parts = static_cast<int>(std::ceil(dense.interval / kSensorInterval - 1e-9));
  return dense;
}

void ReadOut::read(const SamplePlan& asked, LaneResults& run) const {
  const SamplePlan plan = make_plan(asked);
  std::vector<double> times(static_cast<std::size_t>(run.sample_count));
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] = calc_sample_time(plan, static_cast<double>(i));
  }
  for (const auto& [lane, channel, sensor] : readings_) {
    if (run.status[lane] != static_cast<int>(RunStatus::kDone)) continue;
    Channel values(run, channel_count_, channel, lane);
    if (asked.snapshot && std::isfinite(run.event_time[lane]))
      times.push_back(run.event_time[lane]);
    values.put(sensor.has_memory()
                   ? read_sensor(sensor, plan.interval / plan.parts, values.get_samples(), times)
                   : values.amplify(sensor, times.size()));
    times.resize(static_cast<std::size_t>(run.sample_count));
  }
  if (plan.parts == asked.parts && plan.interval == asked.interval) return;
  thin_out(asked.interval > 0.0 ? static_cast<std::size_t>(plan.parts) : 0,
           channel_count_ * static_cast<std::size_t>(run.lanes), run);
}

}  // namespace strut
