#include "estimate/crossing_readings.h"

#include <fmt/format.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <utility>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "base/text/format_number.h"
#include "estimate/crossing_batch.h"
#include "estimate/hit_time.h"
#include "estimate/jump_difference.h"
#include "estimate/road_response.h"
#include "model/error/model_error.h"
#include "model/longest_step.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

class CrossingReadings final : public ReadingModel {
 public:
  CrossingReadings(std::vector<MeasuredRun> runs, std::vector<Unknown> unknowns,
                   const LinearizeOptions& options);

  Linearization linearize(const std::vector<double>& values) override;
  /// Points whose cars differ only in their sensors share a simulation.
  using ReadingModel::evaluate;
  std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) override;
  std::vector<double> align(const std::vector<double>& values) override;
  std::string linearize_road(const std::vector<double>& values, std::size_t run,
                             const TakeColumns& take) override;

 private:
  // Choice of the compared readings and the simulated duration.
  void choose_readings(std::size_t run);
  void align_durations();

  // Simulations.
  Case make_setup(std::size_t run, const std::vector<double>& values) const;
  std::string try_setup(std::size_t run, const std::vector<double>& values, Case& setup) const;
  std::vector<CrossingResult> simulate(const std::vector<CrossingTask>& tasks);
  std::string sample_variants(const std::vector<double>& values,
                              const std::vector<RunVariant>& variants,
                              std::vector<SampledRun>& sampled);

  // Readings of a simulated run.
  CurvePoint read(const SampledRun& sampled, const ReadingPlace& place, double hit_time) const {
    return read_curve(runs_[place.run], sampled, place, hit_time, interval());
  }
  std::vector<double> read_run(std::size_t run, const SampledRun& sampled, double hit_time) const;
  void fill_hit_time(std::size_t run, const SampledRun& base, const std::vector<double>& values,
                     Linearization& out) const;
  void fill_column(const RunVariant& upper, const RunVariant& lower, const SampledRun& base,
                   const SampledRun& above_run, const SampledRun& below_run,
                   const std::vector<double>& values, Linearization& out) const;

  /// Linear map from a run's samples, channel by channel, to its readings.
  using ReadingMap = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  ReadingMap make_reading_map(std::size_t run, const RoadResponse& response, double hit_time) const;

  double interval() const { return 1.0 / options_.rate; }

  LinearizeOptions options_;
  std::vector<const ParameterInfo*> parameters_;  // by unknown; null where it is not a parameter
  std::vector<CasePreparer> preparers_;           // by run, at the base point's mechanism
};

CrossingReadings::CrossingReadings(std::vector<MeasuredRun> runs, std::vector<Unknown> unknowns,
                                   const LinearizeOptions& options)
    : ReadingModel(std::move(runs), std::move(unknowns)),
      options_(options),
      preparers_(runs_.size()) {
  for (const Unknown& u : unknowns_) {
    const bool is_parameter = u.kind == UnknownKind::kParameter;
    parameters_.push_back(is_parameter ? &find_parameter(u.name) : nullptr);
  }
  for (std::size_t r = 0; r < runs_.size(); ++r) choose_readings(r);
  align_durations();
  finish();
}

void CrossingReadings::choose_readings(std::size_t r) {
  MeasuredRun& run = runs_[r];
  const double step = interval();
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
  add_readings(r, [&](double time) { return time + earliest >= margin && time + latest <= end; });
  if (begin_row(r + 1) > begin_row(r)) return;
  throw InputError(fmt::format(
      "{}: time runs from {} to {} s, the maneuver from 0 to {} s: no reading can be compared",
      run.name, format_number(run.times.front()), format_number(run.times.back()),
      format_number(driven)));
}

/// Extends runs nearly as long as the longest to its duration, since only cases of equal duration
/// share lanes.
void CrossingReadings::align_durations() {
  constexpr double kNearly = 0.7;
  double longest = 0.0;
  for (const MeasuredRun& run : runs_) {
    longest = std::max(longest, run.setup.car().maneuver.duration);
  }
  for (MeasuredRun& run : runs_) {
    double& duration = run.setup.car().maneuver.duration;
    if (duration > kNearly * longest) duration = longest;
  }
}

/// The car and maneuver of a run at these values. Throws as the parameters do.
Case CrossingReadings::make_setup(std::size_t run, const std::vector<double>& values) const {
  const Case& known = runs_[run].setup.car();
  Case c = known;
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const Unknown& u = unknowns_[i];
    if (!is_simulated(u) || !belongs(u, run)) continue;
    if (u.kind == UnknownKind::kForceMap) {
      add_map_part(c.vehicle.force_maps, *u.part, values[i]);
      continue;
    }
    // Skips unchanged values: setting a corner's neutral effect would replace the axle's.
    if (values[i] != parameters_[i]->get(known)) parameters_[i]->set(c, values[i]);
  }
  return c;
}

/// Calls make_setup and returns why it failed; empty if it did not.
std::string CrossingReadings::try_setup(std::size_t run, const std::vector<double>& values,
                                        Case& setup) const {
  try {
    setup = make_setup(run, values);
    return "";
  } catch (const ModelError& e) {
    return fmt::format("{}: {}", runs_[run].name, e.what());
  } catch (const InputError& e) {  // out of a parameter's range
    return fmt::format("{}: {}", runs_[run].name, e.what());
  }
}

std::vector<CrossingResult> CrossingReadings::simulate(const std::vector<CrossingTask>& tasks) {
  std::vector<CrossingResult> results = simulate_crossings(runs_, tasks, options_, preparers_);
  simulation_count_ += std::count_if(results.begin(), results.end(),
                                     [](const CrossingResult& r) { return r.was_simulated; });
  return results;
}

/// Lets both sides of each difference take equal steps, or the difference would include that of the
/// steps.
void match_steps(const std::vector<RunVariant>& variants, std::vector<CrossingTask>& tasks) {
  for (std::size_t k = 0; k + 1 < tasks.size(); ++k) {
    if (variants[k].unknown == kNoUnknown) continue;
    tasks[k].longest_step = tasks[k + 1].longest_step =
        std::min(calc_longest_step(tasks[k].setup), calc_longest_step(tasks[k + 1].setup));
    ++k;
  }
}

/// Simulates the variants and their sensors; returns why one failed, empty if none did.
std::string CrossingReadings::sample_variants(const std::vector<double>& values,
                                              const std::vector<RunVariant>& variants,
                                              std::vector<SampledRun>& sampled) {
  std::vector<CrossingTask> tasks;
  tasks.reserve(variants.size());
  for (const RunVariant& v : variants) {
    tasks.push_back({.run = v.run, .setup = {}});
    std::string failure = try_setup(v.run, set_variant(values, v), tasks.back().setup);
    if (!failure.empty()) return failure;
  }
  match_steps(variants, tasks);
  std::vector<CrossingResult> results = simulate(tasks);
  sampled.reserve(tasks.size());
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (!results[i].failure.empty()) return results[i].failure;
    sampled.push_back(read_sensors(tasks[i].setup, runs_[tasks[i].run], interval(),
                                   std::move(results[i].sampled)));
  }
  return "";
}

std::vector<double> CrossingReadings::read_run(std::size_t run, const SampledRun& sampled,
                                               double hit_time) const {
  std::vector<double> readings;
  readings.reserve(begin_row(run + 1) - begin_row(run));
  for (std::size_t k = begin_row(run); k < begin_row(run + 1); ++k) {
    readings.push_back(read(sampled, readings_[k], hit_time).value);
  }
  return readings;
}

void CrossingReadings::fill_hit_time(std::size_t run, const SampledRun& base,
                                     const std::vector<double>& values, Linearization& out) const {
  const std::size_t hit = find_hit_time(unknowns_, run);
  if (hit == kNoUnknown) return;
  for (std::size_t k = begin_row(run); k < begin_row(run + 1); ++k) {
    const double slope = read(base, readings_[k], values[hit]).slope;
    out.jacobian(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(hit)) =
        slope * unknowns_[hit].scale / get_channel(readings_[k]).sigma;
  }
}

/// Fills in a column by central differences. The step is short, so a column whose second difference
/// is as large as its first is rounding error and becomes zero; jumps do not count.
void CrossingReadings::fill_column(const RunVariant& upper, const RunVariant& lower,
                                   const SampledRun& base, const SampledRun& above_run,
                                   const SampledRun& below_run, const std::vector<double>& values,
                                   Linearization& out) const {
  constexpr double kRounding = 0.5;
  const double hit_time = get_hit_time(unknowns_, values, upper.run);
  const double width = upper.value - lower.value;
  const double middle = 0.5 * (upper.value + lower.value);
  const bool centered = std::abs(middle - values[upper.unknown]) < 1e-3 * width;
  const std::size_t begin = begin_row(upper.run), end = begin_row(upper.run + 1);
  const auto column = static_cast<Eigen::Index>(upper.unknown);
  double slopes = 0.0, bends = 0.0;
  for (std::size_t k = begin; k < end; ++k) {
    const double sigma = get_channel(readings_[k]).sigma;
    const double above = read(above_run, readings_[k], hit_time).value;
    const double below = read(below_run, readings_[k], hit_time).value;
    const double here = read(base, readings_[k], hit_time).value;
    const double rise = (here - below) / sigma, next = (above - here) / sigma;
    const double slope = centered ? calc_jump_free_difference(rise, next) : rise + next;
    const double bend = slope == rise + next ? next - rise : 0.0;
    slopes += slope * slope;
    bends += bend * bend;
    out.jacobian(static_cast<Eigen::Index>(k), column) =
        slope / width * unknowns_[upper.unknown].scale;
  }
  if (!centered || std::sqrt(bends) <= kRounding * std::sqrt(slopes)) return;
  for (std::size_t k = begin; k < end; ++k) {
    out.jacobian(static_cast<Eigen::Index>(k), column) = 0.0;
  }
}

Linearization CrossingReadings::linearize(const std::vector<double>& values) {
  const std::vector<RunVariant> variants =
      list_variants(unknowns_, runs_.size(), values, options_.relative_step);
  std::vector<SampledRun> sampled;
  Linearization out = make_linearization(sample_variants(values, variants, sampled));
  if (!out.failure.empty()) return out;
  // A run as it is, or the upper of the two sides of an unknown; each fills places of its own.
  struct Part {
    std::size_t variant, base;
  };
  std::vector<Part> parts;
  for (std::size_t k = 0; k < variants.size(); ++k) {
    const bool is_base = variants[k].unknown == kNoUnknown;
    parts.push_back({k, is_base ? k : parts.back().base});
    if (!is_base) ++k;  // the lower side
  }
  share_items(options_.threads, parts.size(), [&](std::size_t i, int) {
    const auto [k, base] = parts[i];
    const std::size_t run = variants[k].run;
    if (k != base) {
      fill_column(variants[k], variants[k + 1], sampled[base], sampled[k], sampled[k + 1], values,
                  out);
      return;
    }
    const std::vector<double> readings =
        read_run(run, sampled[k], get_hit_time(unknowns_, values, run));
    fill_residual(run, values, readings, out.residual);
    fill_sensor_columns(run, readings, out);
    fill_hit_time(run, sampled[k], values, out);
  });
  fill_priors(values, out);
  return out;
}

std::vector<Evaluation> CrossingReadings::evaluate(const std::vector<std::vector<double>>& points) {
  std::vector<Evaluation> evaluations(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    evaluations[i].residual = Eigen::VectorXd::Zero(row_count());
    fill_prior_residuals(points[i], evaluations[i].residual);
  }
  // The setup of a point in a run, and the index in `cars` of its car without sensors.
  struct PointSetup {
    Case setup;
    std::size_t car = 0;
  };
  std::vector<PointSetup> setups(points.size() * runs_.size());
  std::vector<CrossingTask> cars;
  for (std::size_t run = 0; run < runs_.size(); ++run) {
    const std::size_t first = cars.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      PointSetup& point = setups[run * points.size() + i];
      std::string failure = try_setup(run, points[i], point.setup);
      if (!failure.empty()) evaluations[i].failure = std::move(failure);
      if (!evaluations[i].failure.empty()) continue;
      Case car = remove_sensors(point.setup);
      point.car = first;
      while (point.car < cars.size() && !(cars[point.car].setup == car)) ++point.car;
      if (point.car == cars.size()) cars.push_back({.run = run, .setup = std::move(car)});
    }
  }
  const std::vector<CrossingResult> results = simulate(cars);
  share_items(options_.threads, points.size(), [&](std::size_t i, int) {
    Evaluation& e = evaluations[i];
    for (std::size_t run = 0; run < runs_.size() && e.failure.empty(); ++run) {
      const PointSetup& point = setups[run * points.size() + i];
      e.failure = results[point.car].failure;
      if (!e.failure.empty()) break;
      const SampledRun sampled =
          read_sensors(point.setup, runs_[run], interval(), results[point.car].sampled);
      fill_residual(run, points[i], read_run(run, sampled, get_hit_time(unknowns_, points[i], run)),
                    e.residual);
    }
  });
  return evaluations;
}

CrossingReadings::ReadingMap CrossingReadings::make_reading_map(std::size_t run,
                                                                const RoadResponse& response,
                                                                double hit_time) const {
  const std::size_t rows = begin_row(run + 1) - begin_row(run);
  const auto samples = static_cast<std::size_t>(response.samples);
  ReadingMap map(static_cast<Eigen::Index>(rows), response.derivatives.rows());
  map.reserve(Eigen::VectorXi::Constant(map.rows(), kCurveSamples));
  for (std::size_t row = 0; row < rows; ++row) {
    const ReadingPlace& place = readings_[begin_row(run) + row];
    const double at = (runs_[run].times[place.time] + hit_time) / response.interval;
    const std::size_t index = static_cast<std::size_t>(at);
    const std::size_t first =
        std::min(index - std::min(index, kCurveMargin), samples - kCurveSamples);
    for (std::size_t i = first; i < first + kCurveSamples; ++i) {
      const auto get = [&](std::size_t sample) { return sample == i ? 1.0 : 0.0; };
      const double weight = interpolate_samples(get, samples, at);
      const auto sample = static_cast<Eigen::Index>(place.channel) * response.samples +
                          static_cast<Eigen::Index>(i);
      map.insert(static_cast<Eigen::Index>(row), sample) = weight / get_channel(place).sigma;
    }
  }
  return map;
}

std::string CrossingReadings::linearize_road(const std::vector<double>& values, std::size_t run,
                                             const TakeColumns& take) {
  Case setup;
  std::string failure = try_setup(run, values, setup);
  if (!failure.empty()) return failure;
  RoadResponse response;
  failure = simulate_road_response(runs_[run], setup, options_, preparers_[run], response);
  if (!failure.empty()) return failure;
  std::atomic_ref(simulation_count_) += response.simulation_count;
  const ReadingMap map = make_reading_map(run, response, get_hit_time(unknowns_, values, run));
  constexpr Eigen::Index kAtOnce = 64;
  const Eigen::Index count = response.derivatives.cols();
  for (Eigen::Index begin = 0; begin < count; begin += kAtOnce) {
    take(begin, map * response.derivatives.middleCols(begin, std::min(kAtOnce, count - begin)));
  }
  return "";
}

/// Returns `values` unchanged if they cannot be simulated.
std::vector<double> CrossingReadings::align(const std::vector<double>& values) {
  std::vector<SampledRun> bases;
  const std::vector<RunVariant> variants =
      list_variants({}, runs_.size(), values, options_.relative_step);
  if (!sample_variants(values, variants, bases).empty()) return values;
  std::vector<double> aligned = values;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const std::size_t hit = find_hit_time(unknowns_, r);
    if (hit == kNoUnknown || unknowns_[hit].run == kEveryRun) continue;
    const std::span readings(readings_.begin() + static_cast<std::ptrdiff_t>(begin_row(r)),
                             readings_.begin() + static_cast<std::ptrdiff_t>(begin_row(r + 1)));
    aligned[hit] =
        find_best_hit_time(unknowns_, runs_[r], readings, bases[r], values[hit], interval());
  }
  return aligned;
}

}  // namespace

std::unique_ptr<ReadingModel> make_crossing_readings(std::vector<MeasuredRun> runs,
                                                     std::vector<Unknown> unknowns,
                                                     const LinearizeOptions& options) {
  return std::make_unique<CrossingReadings>(std::move(runs), std::move(unknowns), options);
}

}  // namespace strut
