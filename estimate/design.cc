#include "estimate/design.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error/input_error.h"
#include "base/text/nearest_name.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

constexpr int kMaxInstants = 3;
constexpr int kAddedSensors = 3;

void check_axis(const Grid& grid, const std::string& name) {
  std::vector<std::string> names;
  names.reserve(grid.axes().size());
  for (const Axis& axis : grid.axes()) names.push_back(axis.name);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw InputError(
      fmt::format("--at {}: not an axis of this sweep{}; axes: {}; set other parameters by --set",
                  name, suggest_name(name, names), join_names(names)));
}

const std::string& get_name(int channel) {
  return list_car_channels()[static_cast<std::size_t>(channel)].name;
}

DesignChoice make_choice(const std::vector<Eigen::MatrixXd>& informations, int count) {
  const InstantChoice choice = choose_instants(informations, count);
  return {choice.instants, calc_bounds(choice.information)};
}

SensorSet make_sensor_set(const Sensitivity& s, const std::string& label,
                          const std::vector<int>& channels, const SensorNoise& noise) {
  const auto informations = calc_informations(s, channels, noise);
  return {label, channels, calc_bounds(calc_information(s, s.snapshot, channels, noise)),
          make_choice(informations, 1), calc_bounds(sum_informations(informations))};
}

std::vector<SensorSet> make_sensor_sets(const Sensitivity& s, const std::vector<int>& channels,
                                        const SensorNoise& noise) {
  std::vector<SensorSet> sets{make_sensor_set(s, "the channels", channels, noise)};
  sets.reserve(1 + channels.size() + kAddedSensors);
  for (std::size_t i = 0; i < channels.size() && channels.size() > 1; ++i) {
    std::vector<int> fewer = channels;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
    sets.push_back(make_sensor_set(s, "without " + get_name(channels[i]), fewer, noise));
  }
  std::vector<int> more = channels;
  for (int i = 0; i < kAddedSensors; ++i) {
    const int sensor = choose_sensor(s, s.snapshot, more, list_sensors(noise), noise);
    if (sensor < 0) break;
    more.push_back(sensor);
    sets.push_back(make_sensor_set(s, (i == 0 ? "with " : "and ") + get_name(sensor), more, noise));
  }
  return sets;
}

}  // namespace

Case make_base_point(const Case& base, const Grid& grid, const std::vector<std::string>& at,
                     const std::vector<std::string>& settings) {
  Case c = base;
  for (const Axis& axis : grid.axes()) {
    set_parameter(c, axis.name, 0.5 * (axis.from + axis.last()));
  }
  for (const std::string& setting : at) {
    check_axis(grid, parse_setting(setting).name);
    apply_setting(c, setting);
  }
  for (const std::string& setting : settings) apply_setting(c, setting);
  return c;
}

SolverOptions make_accurate(const SolverOptions& requested) {
  SolverOptions accurate;
  accurate.options.symmetry = true;
  StepOptions& step = accurate.options.step;
  if (requested.solver == Solver::kLanes) {
    step.step = std::min(step.step, requested.options.step.step);
  }
  return accurate;
}

Design calc_design(const Sensitivity& s, const std::vector<int>& channels,
                   const SensorNoise& noise) {
  for (const int channel : channels) {
    if (noise[static_cast<std::size_t>(channel)] > 0.0) continue;
    throw InputError(fmt::format("channel {0}: has no default sensor noise; give --noise {0}=SIGMA",
                                 get_name(channel)));
  }
  if (channels.empty()) throw InputError("no channels: give --channels");
  if (s.instants.size() < kMaxInstants) {
    throw InputError(
        "fewer than three instants along the way; choose a longer duration or a higher --rate");
  }
  Design design;
  design.snapshot = calc_bounds(calc_information(s, s.snapshot, channels, noise));
  const auto informations = calc_informations(s, channels, noise);
  design.scan.reserve(informations.size());
  for (const Eigen::MatrixXd& information : informations) {
    design.scan.push_back(calc_bounds(information));
  }
  design.best.reserve(kMaxInstants);
  for (int count = 1; count <= kMaxInstants; ++count) {
    design.best.push_back(make_choice(informations, count));
  }
  design.window = calc_bounds(sum_informations(informations));
  design.sensors = make_sensor_sets(s, channels, noise);
  return design;
}

std::pair<std::size_t, std::size_t> find_good_range(const Design& design) {
  const double max_rms = 1.1 * design.best[0].bounds.rms;
  std::size_t first = design.best[0].instants[0], last = first;
  while (first > 0 && design.scan[first - 1].rms < max_rms) --first;
  while (last + 1 < design.scan.size() && design.scan[last + 1].rms < max_rms) ++last;
  return {first, last};
}

WorstCurve find_worst_curve(const Sensitivity& s, const std::vector<int>& channels) {
  WorstCurve worst;
  for (const int channel : channels) {
    for (std::size_t p = 0; p < s.parameters.size(); ++p) {
      const double error = s.error[static_cast<std::size_t>(channel) * s.parameters.size() + p];
      if (error >= worst.error) worst = {error, channel, p};
    }
  }
  return worst;
}

}  // namespace strut
