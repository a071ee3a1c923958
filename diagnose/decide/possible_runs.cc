#include "diagnose/decide/possible_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/format_number.h"

namespace strut {
namespace {

/// Factors closer to 1 give the same run again.
constexpr double kSame = 0.05;

// --- rigs ---------------------------------------------------------------------------------------

/// The motion of an input in a run, and its bounds over all runs.
struct InputMotion {
  double travel = 0.0;  // peak to peak
  double rate = 0.0;    // root mean square
};
struct MotionLimits {
  double min_travel = 0.0, max_travel = 0.0, max_rate = 0.0;
};

InputMotion measure_motion(const InputSignal& signal) {
  double low = signal.cells.front().c0, high = low, squares = 0.0;
  for (const SignalCell& cell : signal.cells) {
    low = std::min(low, cell.c0);
    high = std::max(high, cell.c0);
    squares += cell.c1 * cell.c1;
  }
  return {high - low, std::sqrt(squares / static_cast<double>(signal.cells.size()))};
}

bool moves(const CampaignData& data, const InputSignal& signal) {
  const auto input = static_cast<std::size_t>(find_input(data.model(), signal.channel));
  return data.model().inputs[input].moves;
}

/// Over the runs that have this input and move it.
MotionLimits find_limits(const CampaignData& data, const std::string& channel) {
  MotionLimits limits;
  for (const MeasuredRun& run : data.runs) {
    for (const InputSignal& signal : run.setup.rig().inputs) {
      if (signal.channel != channel) continue;
      const InputMotion motion = measure_motion(signal);
      if (motion.travel <= 0.0) continue;
      const bool is_first = limits.max_travel == 0.0;
      limits.min_travel = is_first ? motion.travel : std::min(limits.min_travel, motion.travel);
      limits.max_travel = std::max(limits.max_travel, motion.travel);
      limits.max_rate = std::max(limits.max_rate, motion.rate);
    }
  }
  return limits;
}

/// The bounds of the factor on all moving inputs of a run.
struct FactorBounds {
  double low = 0.0, high = 1e3;
};

FactorBounds find_factor_bounds(const CampaignData& data, const MeasuredRun& run) {
  FactorBounds bounds;
  for (const InputSignal& signal : run.setup.rig().inputs) {
    const InputMotion motion = measure_motion(signal);
    if (!moves(data, signal) || motion.travel <= 0.0) continue;
    const MotionLimits limits = find_limits(data, signal.channel);
    bounds.low = std::max(bounds.low, limits.min_travel / motion.travel);
    bounds.high = std::min(bounds.high, limits.max_travel / motion.travel);
    if (motion.rate > 0.0) bounds.high = std::min(bounds.high, limits.max_rate / motion.rate);
  }
  return bounds;
}

/// Two digits, towards 1, as printed.
double round_factor(double factor) {
  const double unit = std::pow(10.0, std::floor(std::log10(factor)) - 1.0);
  const double digits = factor / unit;
  return (factor > 1.0 ? std::floor(digits + 1e-9) : std::ceil(digits - 1e-9)) * unit;
}

std::vector<PossibleRun> list_amplitudes(const CampaignData& data, std::size_t run) {
  const FactorBounds bounds = find_factor_bounds(data, data.runs[run]);
  std::vector<PossibleRun> list;
  for (const double wanted : {bounds.low, 0.3, 2.0, 4.0, bounds.high}) {
    if (!(wanted > 0.0) || wanted < bounds.low || wanted > bounds.high) continue;
    const double factor = round_factor(wanted);
    if (std::abs(factor - 1.0) < kSame) continue;
    CampaignData one = take_run(data, run);
    for (InputSignal& signal : one.runs[0].setup.rig().inputs) {
      if (moves(data, signal)) correct_signal(signal, {factor, {}});
    }
    list.push_back({fmt::format("repeat {} at {} times its amplitude", data.campaign.runs[run].name,
                                format_rounded(factor)),
                    run, std::move(one)});
  }
  return list;
}

// --- cars ---------------------------------------------------------------------------------------

constexpr double kKilometersPerHour = 3.6;

/// The car with another speed, in whole km/h, which reaches the bump at the same time.
void set_speed(ManeuverSpec& maneuver, double kilometers_per_hour) {
  const double speed = kilometers_per_hour / kKilometersPerHour;
  maneuver.bump_distance *= speed / maneuver.speed;
  maneuver.speed = speed;
}

double find_max_speed(const CampaignData& data) {
  double speed = 0.0;
  for (const MeasuredRun& run : data.runs) {
    speed = std::max(speed, run.setup.car().maneuver.speed);
  }
  return speed;
}

std::vector<PossibleRun> list_speeds(const CampaignData& data, std::size_t run) {
  constexpr double kSlowest = 3.0;  // km/h
  std::vector<PossibleRun> list;
  const double own = kKilometersPerHour * data.runs[run].setup.car().maneuver.speed;
  const double fastest = kKilometersPerHour * find_max_speed(data);
  for (const double factor : {0.5, 0.75, 1.5, 2.0, fastest / own}) {
    const double speed = std::round(factor * own);
    if (speed < kSlowest || speed > fastest + 0.5 || std::abs(speed / own - 1.0) < kSame) continue;
    CampaignData one = take_run(data, run);
    set_speed(one.runs[0].setup.car().maneuver, speed);
    list.push_back(
        {fmt::format("repeat {} at {} km/h", data.campaign.runs[run].name, format_rounded(speed)),
         run, std::move(one)});
  }
  return list;
}

std::vector<PossibleRun> list_bumps(const CampaignData& data, std::size_t run) {
  std::vector<PossibleRun> list;
  std::vector<RoadSpec> seen = {data.runs[run].setup.car().maneuver.road};
  for (std::size_t other = 0; other < data.run_count(); ++other) {
    const RoadSpec& road = data.runs[other].setup.car().maneuver.road;
    if (!meets_bump(data, other) || std::find(seen.begin(), seen.end(), road) != seen.end()) {
      continue;
    }
    seen.push_back(road);
    CampaignData one = take_run(data, run);
    ManeuverSpec& maneuver = one.runs[0].setup.car().maneuver;
    maneuver.road = road;
    const double speed = std::round(kKilometersPerHour * maneuver.speed);
    set_speed(maneuver, speed);
    list.push_back({fmt::format("drive over the bump of {} at {} km/h",
                                data.campaign.runs[other].name, format_rounded(speed)),
                    run, std::move(one)});
  }
  return list;
}

}  // namespace

std::vector<PossibleRun> list_possible_runs(const CampaignData& data, std::size_t run) {
  if (data.has_inputs()) return list_amplitudes(data, run);
  if (!meets_bump(data, run)) return {};
  std::vector<PossibleRun> list = list_speeds(data, run);
  for (PossibleRun& bump : list_bumps(data, run)) list.push_back(std::move(bump));
  return list;
}

}  // namespace strut
