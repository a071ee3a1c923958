#include "model/sensor/read_out.h"

#include <cmath>

#include "base/error/check.h"

namespace strut {
namespace {

int to_int(std::size_t i) { return static_cast<int>(i); }

std::vector<double> list_sample_times(const SamplePlan& plan, int count) {
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) times.push_back(calc_sample_time(plan, static_cast<double>(i)));
  return times;
}

/// Readings of one channel and lane at `times`: those of its samples, in steps of `interval`, then,
/// if `times` has one more, that of its snapshot.
std::vector<double> make_readings(const LaneResults& run, int channel, int lane,
                                  const ChannelSensor& sensor, double interval,
                                  const std::vector<double>& times) {
  std::vector<double> values = run.get_history(channel, lane);
  if (sensor.has_memory()) return read_sensor(sensor, interval, std::move(values), times);
  if (times.size() > values.size()) values.push_back(run.get_snapshot(channel, lane));
  for (double& value : values) value = sensor.amplify(value);
  return values;
}

/// Replaces samples and, where there is one more reading, the snapshot.
void put_readings(const std::vector<double>& readings, int channel, int lane, LaneResults& run) {
  for (int i = 0; i < run.sample_count; ++i) {
    run.history[run.find_sample(i, channel, lane)] = readings[static_cast<std::size_t>(i)];
  }
  if (to_int(readings.size()) > run.sample_count) {
    run.snapshot[run.find_snapshot(channel, lane)] = readings.back();
  }
}

/// Keeps every `parts`-th sample from the first; none for 0.
void thin_out(int parts, LaneResults& run) {
  if (run.sample_count == 0) return;
  const std::size_t row = run.history.size() / static_cast<std::size_t>(run.sample_count);
  std::size_t kept = 0;
  for (int i = 0; parts > 0 && i < run.sample_count; i += parts, ++kept) {
    const std::size_t from = static_cast<std::size_t>(i) * row;
    for (std::size_t k = 0; k < row; ++k) run.history[kept * row + k] = run.history[from + k];
  }
  run.sample_count = to_int(kept);
  run.history.resize(kept * row);
}

}  // namespace

ReadOut::ReadOut(const std::vector<ChannelInfo>& channels,
                 const std::vector<const EffectSettings*>& effects) {
  for (std::size_t lane = 0; lane < effects.size(); ++lane) {
    for (std::size_t c = 0; c < channels.size() && !effects[lane]->empty(); ++c) {
      const ChannelSensor sensor = find_sensor(*effects[lane], channels[c]);
      if (!sensor.is_on()) continue;
      readings_.push_back({to_int(lane), to_int(c), sensor});
      has_memory_ = has_memory_ || sensor.has_memory();
    }
  }
}

SamplePlan ReadOut::make_plan(const SamplePlan& requested) const {
  if (!has_memory_ || (requested.interval <= 0.0 && !requested.snapshot)) return requested;
  SamplePlan dense = requested;
  if (dense.interval <= 0.0) dense.interval = kSensorInterval;
  dense.parts = static_cast<int>(std::ceil(dense.interval / kSensorInterval - 1e-9));
  return dense;
}

void ReadOut::read(const SamplePlan& requested, LaneResults& run) const {
  const SamplePlan plan = make_plan(requested);
  const std::vector<double> sample_times = list_sample_times(plan, run.sample_count);
  for (const auto& [lane, channel, sensor] : readings_) {
    STRUT_CHECK(run.recorded.empty(), "ReadOut: sensor effects need the history of all channels");
    if (!run.is_done(lane)) continue;
    std::vector<double> times = sample_times;
    if (requested.snapshot && run.has_snapshot(lane)) times.push_back(run.get_event_time(lane));
    const double interval = plan.interval / plan.parts;
    put_readings(make_readings(run, channel, lane, sensor, interval, times), channel, lane, run);
  }
  if (plan.parts == requested.parts && plan.interval == requested.interval) return;
  thin_out(requested.interval > 0.0 ? plan.parts : 0, run);
}

}  // namespace strut
