#include "estimate/linearize.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "base/text/format_number.h"
#include "estimate/run_readings.h"
#include "model/channel/car_channels.h"
#include "model/effects/catalogue.h"
#include "model/error/model_error.h"
#include "model/sensor/sensors.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

/// One simulation of a run: the base point, or a parameter beside it.
struct Variant {
  std::size_t run = 0;
  std::size_t unknown = kNoUnknown;
  double value = 0.0;  // of that unknown
};

/// By run: the base, then of each of its parameters the upper and the lower side.
std::vector<Variant> list_variants(const std::vector<Unknown>& unknowns, std::size_t run_count,
                                   const std::vector<double>& values, double relative_step) {
  std::vector<Variant> variants;
  variants.reserve(run_count * (1 + 2 * unknowns.size()));
  for (std::size_t run = 0; run < run_count; ++run) {
    variants.push_back({run, kNoUnknown, 0.0});
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      if (!is_parameter_of(unknowns[i], run)) continue;
      const auto [upper, lower] = calc_sides(unknowns[i], values[i], relative_step);
      variants.push_back({run, i, upper});
      variants.push_back({run, i, lower});
    }
  }
  return variants;
}

SampledRun get_channels(const MeasuredRun& run, const LaneRun& result) {
  SampledRun sampled;
  sampled.reserve(run.channels.size());
  for (const MeasuredChannel& c : run.channels) sampled.push_back(result.get_series(c.channel));
  return sampled;
}

/// Channels that any of the runs reads.
std::vector<int> list_recorded(const std::vector<MeasuredRun>& runs) {
  std::set<int> channels;
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) channels.insert(c.channel);
  }
  return {channels.begin(), channels.end()};
}

bool is_sensor(const EffectSetting& setting) {
  return (find_effect(setting.effect)->places & kOnChannel) != 0;
}

/// The car alone: what its sensors do is no part of the simulation.
Case remove_sensors(Case c) {
  std::erase_if(c.vehicle.effects, is_sensor);
  return c;
}

/// The channels as their sensors read them.
SampledRun read_sensors(const Case& setup, const MeasuredRun& run, double interval,
                        SampledRun sampled) {
  for (std::size_t c = 0; c < sampled.size(); ++c) {
    const auto channel = static_cast<std::size_t>(run.channels[c].channel);
    sampled[c] = read_sensor(setup.vehicle.effects, run.setup.info().channels[channel].name,
                             interval, std::move(sampled[c]));
  }
  return sampled;
}

std::string explain_failure(const std::string& run, const LaneRun& result) {
  return run + ": the simulation ends at t = " +
         format_number(result.results->failure_time[static_cast<std::size_t>(result.lane)]) +
         " s: " + get_name(result.status());
}

}  // namespace

ReadingSimulator::ReadingSimulator(std::vector<MeasuredRun> runs, std::vector<Unknown> unknowns,
                                   const LinearizeOptions& options)
    : ReadingModel(std::move(unknowns)),
      runs_(std::move(runs)),
      options_(options),
      preparers_(runs_.size()) {
  if (runs_.empty()) throw InputError("fit: no measurement");
  check_unknowns(unknowns_, runs_.size());
  for (const Unknown& u : unknowns_) {
    const bool is_parameter = u.kind == UnknownKind::kParameter;
    parameters_.push_back(is_parameter ? &find_parameter(u.name) : nullptr);
  }
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    check_measured_run(runs_[r]);
    channels_.emplace_back();
    for (const MeasuredChannel& c : runs_[r].channels) channels_[r].push_back(c.channel);
    choose_readings(r);
  }
  align_durations();
  finish(runs_.front().name);
}

/// Simulates as long as the readings need, at most for the maneuver, and drops those outside.
void ReadingSimulator::choose_readings(std::size_t r) {
  MeasuredRun& run = runs_[r];
  if (run.times.empty()) throw InputError(run.name + ": no samples");
  const double step = 1.0 / options_.rate;
  const std::size_t hit = find_hit_time(unknowns_, r);
  const double shift = hit == kNoUnknown ? 0.0 : unknowns_[hit].start;
  const double earliest = hit == kNoUnknown ? 0.0 : unknowns_[hit].low;
  const double latest = hit == kNoUnknown ? 0.0 : unknowns_[hit].high;
  const double margin = static_cast<double>(kCurveMargin) * step;
  ManeuverSpec& maneuver = run.setup.car().maneuver;
  const double driven = maneuver.duration;
  const double last = std::min(run.times.back() + shift, driven) + latest - shift;
  const Range& allowed = find_parameter("duration").allowed;
  maneuver.duration = std::clamp(last + margin + 2.0 * step, allowed.low, allowed.high);
  const double end = maneuver.duration - margin - step;
  const std::size_t before = readings_.size();
  for (std::size_t t = 0; t < run.times.size(); ++t) {
    const bool inside = run.times[t] + earliest >= margin && run.times[t] + latest <= end;
    if (!inside) outside_count_ += run.channels.size();
    for (std::size_t c = 0; inside && c < run.channels.size(); ++c) {
      if (std::isfinite(run.channels[c].values[t])) readings_.push_back({r, t, c});
    }
  }
  if (readings_.size() > before) return;
  throw InputError(run.name + ": time runs from " + format_number(run.times.front()) + " to " +
                   format_number(run.times.back()) + " s, the maneuver from 0 to " +
                   format_number(driven) + " s: no reading can be compared");
}

/// Only cases of one duration share lanes: runs nearly as long as the longest are simulated as
/// long.
void ReadingSimulator::align_durations() {
  constexpr double kNearly = 0.7;
  double longest = 0.0;
  for (const MeasuredRun& run : runs_)
    longest = std::max(longest, run.setup.car().maneuver.duration);
  for (MeasuredRun& run : runs_) {
    double& duration = run.setup.car().maneuver.duration;
    if (duration > kNearly * longest) duration = longest;
  }
}

Case ReadingSimulator::make_setup(std::size_t run, const std::vector<double>& values) const {
  const Case& known = runs_[run].setup.car();
  Case c = known;
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const Unknown& u = unknowns_[i];
    if (!is_parameter_of(u, run)) continue;
    if (u.kind == UnknownKind::kForceMap) {
      add_map_part(c.vehicle.force_maps, *u.part, values[i]);
      continue;
    }
    // A value that does not change is not set: a corner's neutral effect would replace the axle's.
    if (values[i] != parameters_[i]->get(known)) parameters_[i]->set(c, values[i]);
  }
  return c;
}

void ReadingSimulator::sample(const std::vector<RunSetup>& setups, std::vector<SampledRun>& sampled,
                              std::vector<std::string>& failures) {
  SamplePlan plan;
  plan.interval = 1.0 / options_.rate;
  plan.snapshot = false;
  plan.recorded = list_recorded(runs_);
  sampled.assign(setups.size(), {});
  failures.assign(setups.size(), "");
  // As many at a time as keep their histories in some hundred megabytes.
  constexpr std::size_t kAtOnce = 128;
  for (std::size_t begin = 0; begin < setups.size(); begin += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, setups.size() - begin);
    std::vector<std::optional<PreparedCase>> prepared(count);
    const auto prepare = [&](std::size_t i, CasePreparer& preparer) {
      const RunSetup& s = setups[begin + i];
      try {
        prepared[i] = preparer.prepare(remove_sensors(s.setup));
      } catch (const ModelError& e) {
        failures[begin + i] = runs_[s.run].name + ": " + e.what();
      }
    };
    // Each run's first is the point that the others are near.
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t run = setups[begin + i].run;
      if (begin + i == 0 || setups[begin + i - 1].run != run) {
        prepare(i, preparers_[run]);
      } else {
        others.push_back(i);
      }
    }
    share_items(options_.threads, others.size(), [&](std::size_t k, int /*thread*/) {
      // A copy: what changes the mechanism must not drive the base point's out of the preparer.
      CasePreparer preparer = preparers_[setups[begin + others[k]].run];
      prepare(others[k], preparer);
    });
    std::vector<PreparedCase> cases;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < count; ++i) {
      if (!prepared[i]) continue;
      cases.push_back(std::move(*prepared[i]));
      places.push_back(begin + i);
    }
    const std::vector<LaneRun> results =
        run_prepared(cases, options_.integrate, plan, options_.threads);
    simulation_count_ += static_cast<long>(cases.size());
    for (std::size_t k = 0; k < results.size(); ++k) {
      const std::size_t i = places[k], run = setups[i].run;
      if (results[k].status() != RunStatus::kDone) {
        failures[i] = explain_failure(runs_[run].name, results[k]);
      } else {
        sampled[i] = get_channels(runs_[run], results[k]);
      }
    }
  }
}

/// By run: its base, then both sides of each of `varied`, some first of the unknowns; returns why
/// there are none.
std::string ReadingSimulator::sample_variants(const std::vector<double>& values,
                                              const std::vector<Unknown>& varied,
                                              std::vector<SampledRun>& sampled) {
  const std::vector<Variant> variants =
      list_variants(varied, runs_.size(), values, options_.relative_step);
  std::vector<RunSetup> setups;
  setups.reserve(variants.size());
  for (const Variant& v : variants) {
    std::vector<double> at = values;
    if (v.unknown != kNoUnknown) at[v.unknown] = v.value;
    try {
      setups.push_back({v.run, make_setup(v.run, at)});
    } catch (const ModelError& e) {
      return runs_[v.run].name + ": " + e.what();
    } catch (const InputError& e) {  // out of a parameter's range
      return runs_[v.run].name + ": " + e.what();
    }
  }
  std::vector<std::string> failures;
  sample(setups, sampled, failures);
  for (std::size_t i = 0; i < setups.size(); ++i) {
    if (!failures[i].empty()) return failures[i];
    sampled[i] = read_sensors(setups[i].setup, runs_[setups[i].run], 1.0 / options_.rate,
                              std::move(sampled[i]));
  }
  return "";
}

std::vector<Evaluation> ReadingSimulator::evaluate(const std::vector<std::vector<double>>& points) {
  const auto rows = static_cast<Eigen::Index>(reading_count() + prior_count_);
  std::vector<Evaluation> evaluations(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    evaluations[i].residual = Eigen::VectorXd::Zero(rows);
    fill_prior_residuals(points[i], evaluations[i].residual);
  }
  // The setup of a point in a run, and the number of its car without sensors among `cars`.
  struct Place {
    Case setup;
    std::size_t car = 0;
  };
  std::vector<Place> places(points.size() * runs_.size());
  std::vector<RunSetup> cars;
  for (std::size_t run = 0; run < runs_.size(); ++run) {
    const std::size_t first = cars.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      Place& place = places[run * points.size() + i];
      try {
        place.setup = make_setup(run, points[i]);
      } catch (const ModelError& e) {
        evaluations[i].failure = runs_[run].name + ": " + e.what();
      } catch (const InputError& e) {  // out of a parameter's range
        evaluations[i].failure = runs_[run].name + ": " + e.what();
      }
      if (!evaluations[i].failure.empty()) continue;
      Case car = remove_sensors(place.setup);
      place.car = first;
      while (place.car < cars.size() && !(cars[place.car].setup == car)) ++place.car;
      if (place.car == cars.size()) cars.push_back({run, std::move(car)});
    }
  }
  std::vector<SampledRun> sampled;
  std::vector<std::string> failures;
  sample(cars, sampled, failures);
  const double interval = 1.0 / options_.rate;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Evaluation& e = evaluations[i];
    for (std::size_t run = 0; run < runs_.size() && e.failure.empty(); ++run) {
      const Place& place = places[run * points.size() + i];
      e.failure = failures[place.car];
      if (!e.failure.empty()) break;
      const RunReadings readings(unknowns_, points[i], runs_[run], run, interval, readings_);
      readings.fill_residual(read_sensors(place.setup, runs_[run], interval, sampled[place.car]),
                             points[i], e.residual);
    }
  }
  return evaluations;
}

Linearization ReadingSimulator::linearize(const std::vector<double>& values) {
  Linearization out;
  std::vector<SampledRun> results;
  out.failure = sample_variants(values, unknowns_, results);
  if (!out.failure.empty()) return out;
  const auto rows = static_cast<Eigen::Index>(reading_count() + prior_count_);
  out.residual = Eigen::VectorXd::Zero(rows);
  out.jacobian = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(unknowns_.size()));
  std::size_t used = 0;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const RunReadings run(unknowns_, values, runs_[r], r, 1.0 / options_.rate, readings_);
    used += run.fill(results.data() + used, options_.relative_step, out);
  }
  fill_priors(values, out);
  return out;
}

std::vector<double> ReadingSimulator::align(const std::vector<double>& values) {
  std::vector<double> aligned = values;
  std::vector<SampledRun> bases;
  if (!sample_variants(values, {}, bases).empty()) return aligned;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const std::size_t hit = find_hit_time(unknowns_, r);
    if (hit == kNoUnknown || unknowns_[hit].run == kEveryRun) continue;
    const RunReadings run(unknowns_, values, runs_[r], r, 1.0 / options_.rate, readings_);
    aligned[hit] = run.find_best_hit_time(bases[r]);
  }
  return aligned;
}

}  // namespace strut
