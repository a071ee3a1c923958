#include "diagnose/linearize.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/run_readings.h"
#include "io/input_error.h"
#include "model/vehicle/model_error.h"
#include "sweep/parameters.h"
#include "sweep/simulate_cases.h"

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

Case make_setup(const Case& setup, const std::vector<Unknown>& unknowns,
                const std::vector<double>& values, const Variant& variant) {
  Case c = setup;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (!is_parameter_of(unknowns[i], variant.run)) continue;
    set_parameter(c, unknowns[i].name, i == variant.unknown ? variant.value : values[i]);
  }
  return c;
}

std::string explain_failure(const std::string& run, const LaneRun& result) {
  return run + ": the simulation ends at t = " +
         format_number(result.results->failure_time[static_cast<std::size_t>(result.lane)]) +
         " s: " + get_case_status_name(static_cast<std::int32_t>(result.status()));
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
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    check_measured_run(runs_[r]);
    channels_.emplace_back();
    for (const MeasuredChannel& c : runs_[r].channels) channels_[r].push_back(c.channel);
    choose_readings(r);
  }
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
  const double driven = run.setup.maneuver.duration;
  const double last = std::min(run.times.back() + shift, driven) + latest - shift;
  const Range& allowed = find_parameter("duration").allowed;
  run.setup.maneuver.duration = std::clamp(last + margin + 2.0 * step, allowed.low, allowed.high);
  const double end = run.setup.maneuver.duration - margin - step;
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

/// Fills the results of each run's base and of both sides of `varied`, some first of the unknowns;
/// returns why there are none.
std::string ReadingSimulator::simulate(const std::vector<double>& values,
                                       const std::vector<Unknown>& varied,
                                       std::vector<LaneRun>& results) {
  const std::vector<Variant> variants =
      list_variants(varied, runs_.size(), values, options_.relative_step);
  std::vector<PreparedCase> cases;
  cases.reserve(variants.size());
  for (const Variant& v : variants) {
    try {
      const Case setup = make_setup(runs_[v.run].setup, unknowns_, values, v);
      // A copy: what changes the mechanism must not drive the base point's out of the preparer.
      CasePreparer own = preparers_[v.run];
      CasePreparer& preparer = v.unknown == kNoUnknown ? preparers_[v.run] : own;
      cases.push_back(preparer.prepare(setup));
    } catch (const ModelError& e) {
      return runs_[v.run].name + ": " + e.what();
    } catch (const std::invalid_argument& e) {  // the road's
      return runs_[v.run].name + ": " + e.what();
    } catch (const InputError& e) {  // out of a parameter's range
      return runs_[v.run].name + ": " + e.what();
    }
  }
  SamplePlan plan;
  plan.interval = 1.0 / options_.rate;
  plan.snapshot = false;
  results = run_prepared(cases, options_.integrate, plan, options_.threads);
  simulation_count_ += static_cast<long>(cases.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].status() != RunStatus::kDone) {
      return explain_failure(runs_[variants[i].run].name, results[i]);
    }
  }
  return "";
}

Linearization ReadingSimulator::linearize(const std::vector<double>& values) {
  Linearization out;
  std::vector<LaneRun> results;
  out.failure = simulate(values, unknowns_, results);
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
  std::vector<LaneRun> bases;
  if (!simulate(values, {}, bases).empty()) return aligned;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const std::size_t hit = find_hit_time(unknowns_, r);
    if (hit == kNoUnknown || unknowns_[hit].run == kEveryRun) continue;
    const RunReadings run(unknowns_, values, runs_[r], r, 1.0 / options_.rate, readings_);
    aligned[hit] = run.find_best_hit_time(bases[r]);
  }
  return aligned;
}

}  // namespace strut
