#include "diagnose/linearize.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/sampled_curve.h"
#include "io/input_error.h"
#include "model/vehicle/model_error.h"
#include "sweep/parameters.h"
#include "sweep/simulate_cases.h"

namespace strut {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

bool belongs(const Unknown& u, std::size_t run) {
  return u.run == kEveryRun || static_cast<std::size_t>(u.run) == run;
}

bool is_parameter_of(const Unknown& u, std::size_t run) {
  return u.kind == UnknownKind::kParameter && belongs(u, run);
}

std::size_t find_hit_time(const std::vector<Unknown>& unknowns, std::size_t run) {
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (unknowns[i].kind == UnknownKind::kHitTime && belongs(unknowns[i], run)) return i;
  }
  return kNone;
}

/// One simulation of a run: the base point, or a parameter beside it.
struct Variant {
  std::size_t run = 0;
  std::size_t unknown = kNone;
  double value = 0.0;  // of that unknown
};

/// Both sides of an unknown, moved inwards at the bounds.
std::pair<double, double> calc_sides(const Unknown& u, double value, double relative_step) {
  const double h = relative_step * u.scale;
  const double center = std::max(u.low + h, std::min(u.high - h, value));
  return {center + h, center - h};
}

/// By run: the base, then of each of its parameters the upper and the lower side.
std::vector<Variant> list_variants(const std::vector<Unknown>& unknowns, std::size_t run_count,
                                   const std::vector<double>& values, double relative_step) {
  std::vector<Variant> variants;
  variants.reserve(run_count * (1 + 2 * unknowns.size()));
  for (std::size_t run = 0; run < run_count; ++run) {
    variants.push_back({run, kNone, 0.0});
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

/// Residuals and derivatives of one run. Sums over its readings tell a reaction from rounding.
class RunFiller {
 public:
  RunFiller(const std::vector<Unknown>& unknowns, const std::vector<double>& values,
            const MeasuredRun& run, std::size_t run_index, double step)
      : unknowns_(unknowns), values_(values), run_(run), index_(run_index), step_(step) {
    const std::size_t hit = find_hit_time(unknowns, run_index);
    hit_time_ = hit == kNone ? 0.0 : values[hit];
  }

  /// `results` begins with this run's base. Returns how many simulations were this run's.
  std::size_t fill(const LaneRun* results, double relative_step,
                   const std::vector<ReadingPlace>& places, Linearization& out) {
    std::size_t used = 1;
    fill_base(results[0], places, out);
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
      if (!is_parameter_of(unknowns_[i], index_)) continue;
      const auto [upper, lower] = calc_sides(unknowns_[i], values_[i], relative_step);
      const bool centered = std::abs(0.5 * (upper + lower) - values_[i]) < 1e-3 * (upper - lower);
      fill_parameter(results, used, upper - lower, centered, places, i, out);
      used += 2;
    }
    return used;
  }

 private:
  CurvePoint read(const LaneRun& simulated, const ReadingPlace& place) const {
    const double at = (run_.times[place.time] + hit_time_) / step_;
    const double index = std::floor(at);
    const auto channel = static_cast<std::size_t>(run_.channels[place.channel].channel);
    return interpolate_curve([&](std::size_t sample) { return simulated.get(sample, channel); },
                             static_cast<std::size_t>(index), at - index, step_);
  }

  void fill_base(const LaneRun& base, const std::vector<ReadingPlace>& places,
                 Linearization& out) const {
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (places[k].run != index_) continue;
      const auto row = static_cast<Eigen::Index>(k);
      const MeasuredChannel& c = run_.channels[places[k].channel];
      const CurvePoint point = read(base, places[k]);
      double difference = point.value - c.values[places[k].time];
      for (std::size_t i = 0; i < unknowns_.size(); ++i) {
        const Unknown& u = unknowns_[i];
        if (!belongs(u, index_)) continue;
        const double scale = u.scale / c.sigma;
        if (u.kind == UnknownKind::kHitTime) {
          out.jacobian(row, static_cast<Eigen::Index>(i)) = point.slope * scale;
        } else if (u.kind == UnknownKind::kBias && u.channel == c.channel) {
          difference += values_[i];
          out.jacobian(row, static_cast<Eigen::Index>(i)) = scale;
        }
      }
      out.residual(row) = difference / c.sigma;
    }
  }

  /// Differences of two runs; a column in which the second difference is as large as the first
  /// holds nothing but rounding, as its step is short, and becomes zero.
  void fill_parameter(const LaneRun* results, std::size_t upper, double width, bool centered,
                      const std::vector<ReadingPlace>& places, std::size_t unknown,
                      Linearization& out) const {
    constexpr double kRounding = 0.5;
    double slopes = 0.0, bends = 0.0;
    const auto column = static_cast<Eigen::Index>(unknown);
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (places[k].run != index_) continue;
      const double sigma = run_.channels[places[k].channel].sigma;
      const double above = read(results[upper], places[k]).value;
      const double below = read(results[upper + 1], places[k]).value;
      const double here = read(results[0], places[k]).value;
      const double slope = (above - below) / sigma, bend = (above - 2.0 * here + below) / sigma;
      slopes += slope * slope;
      bends += bend * bend;
      out.jacobian(static_cast<Eigen::Index>(k), column) = slope / width * unknowns_[unknown].scale;
    }
    if (!centered || std::sqrt(bends) <= kRounding * std::sqrt(slopes)) return;
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (places[k].run == index_) out.jacobian(static_cast<Eigen::Index>(k), column) = 0.0;
    }
  }

  const std::vector<Unknown>& unknowns_;
  const std::vector<double>& values_;
  const MeasuredRun& run_;
  std::size_t index_;
  double step_, hit_time_ = 0.0;
};

void fill_priors(const std::vector<Unknown>& unknowns, const std::vector<double>& values,
                 std::size_t first, Linearization& out) {
  auto row = static_cast<Eigen::Index>(first);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Prior& prior = unknowns[i].prior;
    if (!prior.informs()) continue;
    out.residual(row) = (values[i] - prior.mean) / prior.sigma;
    out.jacobian(row, static_cast<Eigen::Index>(i)) = unknowns[i].scale / prior.sigma;
    ++row;
  }
}

std::string explain_failure(const std::string& run, const LaneRun& result) {
  return run + ": the simulation ends at t = " +
         format_number(result.results->failure_time[static_cast<std::size_t>(result.lane)]) +
         " s: " + get_case_status_name(static_cast<std::int32_t>(result.status()));
}

}  // namespace

ReadingSimulator::ReadingSimulator(std::vector<MeasuredRun> runs, std::vector<Unknown> unknowns,
                                   const LinearizeOptions& options)
    : runs_(std::move(runs)),
      unknowns_(std::move(unknowns)),
      options_(options),
      preparers_(runs_.size()) {
  if (runs_.empty()) throw InputError("fit: no measurement");
  check_unknowns(unknowns_, runs_.size());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    check_measured_run(runs_[r]);
    choose_readings(r);
  }
  prior_count_ = static_cast<std::size_t>(std::count_if(
      unknowns_.begin(), unknowns_.end(), [](const Unknown& u) { return u.prior.informs(); }));
  if (reading_count() + prior_count_ < unknowns_.size()) {
    throw InputError(runs_.front().name + ": " + std::to_string(reading_count()) +
                     " readings within the simulated time, too few for " +
                     std::to_string(unknowns_.size()) + " unknowns");
  }
}

/// Simulates as long as the readings need, and drops those before its start.
void ReadingSimulator::choose_readings(std::size_t r) {
  MeasuredRun& run = runs_[r];
  if (run.times.empty()) throw InputError(run.name + ": no samples");
  const double step = 1.0 / options_.rate;
  const std::size_t hit = find_hit_time(unknowns_, r);
  const double earliest = hit == kNone ? 0.0 : unknowns_[hit].low;
  const double latest = hit == kNone ? 0.0 : unknowns_[hit].high;
  const double margin = static_cast<double>(kCurveMargin) * step;
  const Range& allowed = find_parameter("duration").allowed;
  const double needed = run.times.back() + latest + margin + 2.0 * step;
  run.setup.maneuver.duration = std::max(allowed.low, std::min(allowed.high, needed));
  const double end = run.setup.maneuver.duration - margin - step;
  for (std::size_t t = 0; t < run.times.size(); ++t) {
    const bool inside = run.times[t] + earliest >= margin && run.times[t] + latest <= end;
    if (!inside) outside_count_ += run.channels.size();
    for (std::size_t c = 0; inside && c < run.channels.size(); ++c) readings_.push_back({r, t, c});
  }
}

/// Fills the results of all variants; returns why there are none.
std::string ReadingSimulator::simulate(const std::vector<double>& values,
                                       std::vector<LaneRun>& results) {
  const std::vector<Variant> variants =
      list_variants(unknowns_, runs_.size(), values, options_.relative_step);
  std::vector<PreparedCase> cases;
  cases.reserve(variants.size());
  for (const Variant& v : variants) {
    try {
      const Case setup = make_setup(runs_[v.run].setup, unknowns_, values, v);
      // A copy: what changes the mechanism must not drive the base point's out of the preparer.
      CasePreparer own = preparers_[v.run];
      CasePreparer& preparer = v.unknown == kNone ? preparers_[v.run] : own;
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
  out.failure = simulate(values, results);
  if (!out.failure.empty()) return out;
  const auto rows = static_cast<Eigen::Index>(reading_count() + prior_count_);
  out.residual = Eigen::VectorXd::Zero(rows);
  out.jacobian = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(unknowns_.size()));
  std::size_t used = 0;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    RunFiller filler(unknowns_, values, runs_[r], r, 1.0 / options_.rate);
    used += filler.fill(results.data() + used, options_.relative_step, readings_, out);
  }
  fill_priors(unknowns_, values, reading_count(), out);
  return out;
}

}  // namespace strut
