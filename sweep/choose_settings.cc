#include "sweep/choose_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/parse_number.h"
#include "model/error/model_error.h"
#include "model/kernel/count_flops.h"
#include "model/longest_step.h"
#include "sweep/choices.h"
#include "sweep/simulate_cases.h"
#include "sweep/step_count.h"
#include "sweep/step_stability.h"

namespace strut {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Maximum number of cases on which errors are measured, and of right-hand sides of their
/// references (ten seconds of motion each); at least one case is measured.
constexpr std::int64_t kTrialCases = 8;
constexpr double kTrialRightHandSides = 2e6;
/// Right-hand sides of CVODE at its tolerance of 1e-12 [1/s].
constexpr double kCvodeRate = 2.5e4;
/// A channel that moves less does not move but for rounding [m, rad, N, ...].
constexpr double kStill = 1e-9;

/// At most `limit` cases of a trial, spread over the order in which they run.
std::vector<std::int64_t> list_trial_cases(const Plan& plan, std::int64_t limit) {
  const double seconds =
      ends_at_snapshot(plan.request()) ? 0.0 : find_longest_duration(plan.request());
  const double affordable = kTrialRightHandSides / std::max(1.0, kCvodeRate * seconds);
  const std::int64_t most =
      std::clamp<std::int64_t>(std::llround(std::min(affordable, 1e3)), 1, limit);
  const std::int64_t count = std::min(most, plan.case_count());
  std::vector<std::int64_t> cases;
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t last = plan.case_count() - 1;
    cases.push_back(plan.calc_case_id(count == 1 ? 0 : i * last / (count - 1)));
  }
  return cases;
}

/// Results of the trial's cases with one integrator.
ShardRows run_trial(SweepRequest request, const SolverOptions& integrate,
                    const std::vector<std::int64_t>& cases) {
  request.integrate = integrate;
  const Plan plan(request);
  CaseSimulator simulator(plan, list_kernels().back());  // the same bits on every processor
  ShardRows rows = ShardRows::make(plan.make_schema(), cases.size());
  const std::atomic<bool> never{false};
  simulator.simulate(cases, rows, 0, never);
  return rows;
}

/// Largest minus smallest value of each channel over a case's run; no channels if it fails.
std::vector<double> calc_ranges(const PreparedCase& c) {
  constexpr double kRate = 200.0;  // 1/s
  SamplePlan plan;
  plan.interval = 1.0 / kRate;
  IntegrateOptions options;
  options.closure = Closure::kTable;
  options.symmetry = true;
  options.step.step = shorten_step(options.step.step, c.longest_step);
  LaneResults run = list_kernels().back().run_scalar(c, options, plan);
  if (!run.is_done()) run = run_cvode(c, {}, plan);
  std::vector<double> ranges;
  if (!run.is_done()) return ranges;
  for (int channel = 0; channel < CarChannel::kCount; ++channel) {
    const std::vector<double> values = run.get_history(channel);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    ranges.push_back(*high - *low);
  }
  return ranges;
}

/// Error of a trial's row against the reference's; 0 where the reference has no result.
double calc_error(const SweepRequest& request, const ShardRows& rows, const ShardRows& reference,
                  std::size_t row, const std::vector<double>& ranges) {
  if (reference.status[row] != 0) return 0.0;
  if (rows.status[row] != 0 || rows.attempt[row] != 0) return kInfinite;
  double worst = 0.0;
  const auto add = [&](int channel, double difference) {
    const double range = ranges[static_cast<std::size_t>(channel)];
    if (!std::isfinite(difference) || !std::isfinite(range)) worst = kInfinite;
    if (range > kStill) worst = std::max(worst, difference / range);
  };
  const auto& snapshot = request.snapshot.channels;
  for (std::size_t i = 0; request.snapshot.on && i < snapshot.size(); ++i) {
    const std::size_t at = row * snapshot.size() + i;
    add(snapshot[i], std::fabs(rows.snapshot[at] - reference.snapshot[at]));
  }
  for (std::size_t h = 0; h < rows.history.size(); ++h) {
    const std::size_t samples = rows.history[h].size() / rows.size();
    double sum = 0.0;
    for (std::size_t at = row * samples; at < (row + 1) * samples; ++at) {
      sum += square(rows.history[h][at] - reference.history[h][at]);
    }
    add(request.history.channels[h], std::sqrt(sum / static_cast<double>(samples)));
  }
  return worst;
}

/// The integrators among which a sweep's is chosen: tables, whose error is 1e-10 (docs/theory.md),
/// and located events. Steps are at most as long as the effects of all cases allow.
std::vector<SolverOptions> list_candidates(const SweepRequest& request) {
  const SolverOptions& given = request.integrate;
  const double longest_step = find_longest_step(request);
  const bool is_rough = request.base.maneuver.profile.data != nullptr;
  std::vector<SolverOptions> candidates;
  for (const double step : {2e-3, 1.5e-3, 1e-3, 0.75e-3, 0.5e-3, 0.25e-3, 0.125e-3, 0.0625e-3}) {
    const bool too_many = !find_step_count_fault(find_longest_duration(request), step).empty();
    if (step > longest_step || too_many) continue;
    for (const double coarse : {0.0, 4e-3, 6e-3, 10e-3}) {
      // A rough road takes short steps everywhere.
      if (coarse > longest_step || (coarse > 0.0 && is_rough)) continue;
      for (const Stepper stepper : {Stepper::kRk4, Stepper::kAbm4}) {
        SolverOptions candidate = given;
        candidate.options.closure = candidate.reference.closure = Closure::kTable;
        candidate.options.step.stepper = stepper;
        candidate.options.step.step = step;
        candidate.options.step.coarse_step = coarse;
        candidates.push_back(candidate);
      }
    }
  }
  return candidates;
}

bool is_stable(const std::vector<PreparedCase>& cases, const IntegrateOptions& options) {
  return std::none_of(cases.begin(), cases.end(), [&](const PreparedCase& c) {
    const double longest = std::max(options.step.step, options.step.coarse_step);
    return find_step_fault(c, options, longest).has_value();
  });
}

/// The cases that can be prepared and run, with the ranges of their channels.
struct TrialCases {
  std::vector<std::int64_t> ids;
  std::vector<PreparedCase> prepared;
  std::vector<std::vector<double>> ranges;
};

TrialCases prepare_trial(const Plan& plan, std::int64_t limit) {
  TrialCases trial;
  CasePreparer preparer;
  for (const std::int64_t id : list_trial_cases(plan, limit)) {
    try {
      PreparedCase prepared = preparer.prepare(plan.make_case(id), plan.request().snapshot.offset);
      std::vector<double> ranges = calc_ranges(prepared);
      if (ranges.empty()) continue;
      trial.ids.push_back(id);
      trial.prepared.push_back(std::move(prepared));
      trial.ranges.push_back(std::move(ranges));
    } catch (const ModelError&) {  // a result of the sweep
    }
  }
  return trial;
}

double calc_largest_error(const SweepRequest& request, const ShardRows& rows,
                          const ShardRows& reference, const TrialCases& trial) {
  double error = 0.0;
  for (std::size_t row = 0; row < trial.ids.size(); ++row) {
    error = std::max(error, calc_error(request, rows, reference, row, trial.ranges[row]));
  }
  return error;
}

/// Right-hand sides of one run of a case, but for its events.
double count_right_hand_sides(const SweepRequest& request, const PreparedCase& c,
                              const SolverOptions& integrate) {
  const auto& geometry = c.vehicle.numbers.geometry;
  const double front = geometry[kFrontLeft].wheel_center.x;
  const double rear = geometry[kRearLeft].wheel_center.x;
  double end = c.duration;
  if (ends_at_snapshot(request)) end = std::min(end, (c.trigger_x - rear) / c.start_speed);
  end = std::max(end, 0.0);
  if (integrate.solver == Solver::kCvode) return kCvodeRate * end;
  const StepOptions& step = integrate.options.step;
  const double stages = step.stepper == Stepper::kRk4 ? 4.0 : 2.0;
  if (!(step.coarse_step > 0.0) || c.vehicle.road.is_rough()) return stages * end / step.step;
  const Road<double>& road = c.vehicle.road;
  const double begin_fine = (c.bump_center + road.reach_begin - front) / c.start_speed;
  const double end_fine = (c.bump_center + road.reach_end - rear) / c.start_speed + kSettlingTime;
  const double fine = std::clamp(end_fine, 0.0, end) - std::clamp(begin_fine, 0.0, end);
  return stages * (fine / step.step + (end - fine) / step.coarse_step);
}

IntegratorChoice choose_integrator(SweepRequest& request) {
  const TrialCases trial = prepare_trial(Plan(request), kTrialCases);
  SolverOptions reference = request.integrate;
  reference.solver = Solver::kCvode;
  reference.options.closure = reference.reference.closure = Closure::kNewton;
  const ShardRows truth = run_trial(request, reference, trial.ids);
  IntegratorChoice choice;
  choice.cases = static_cast<int>(std::count(truth.status.begin(), truth.status.end(), 0));
  if (choice.cases == 0) return choice;

  // All have tables, so that the order of their right-hand sides is that of their operations.
  std::vector<std::pair<double, SolverOptions>> candidates;
  for (const SolverOptions& candidate : list_candidates(request)) {
    double count = 0.0;
    for (const PreparedCase& c : trial.prepared) {
      count += count_right_hand_sides(request, c, candidate);
    }
    candidates.emplace_back(count, candidate);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [count, candidate] : candidates) {
    if (choice.error <= request.accuracy) break;
    if (!is_stable(trial.prepared, candidate.options)) continue;
    const ShardRows rows = run_trial(request, candidate, trial.ids);
    const double error = calc_largest_error(request, rows, truth, trial);
    if (!(error < choice.error)) continue;
    choice.error = error;
    request.integrate = candidate;
  }
  return choice;
}

/// Cases of a shard that takes some seconds of one core.
int calc_shard_cases(const SweepRequest& request) {
  // Three seconds of a core that does 10 Gflop/s in lanes (AVX2; AVX-512 twice that) and 3 alone.
  constexpr double kInLanes = 30e9, kAlone = 9e9;
  constexpr int kWidest = 8;  // lanes, so that no batch is left half empty
  PreparedCase c;
  try {
    c = CasePreparer().prepare(request.base, request.snapshot.offset);
  } catch (const ModelError&) {
    return request.shard_cases;
  }
  const bool alone = request.integrate.solver == Solver::kCvode;
  IntegrateOptions options = request.integrate.options;
  if (alone) options.symmetry = false;  // CVODE computes the whole car
  const FlopCount flops = count_flops(c, options);
  const double of_case =
      static_cast<double>(flops.arithmetic) * count_right_hand_sides(request, c, request.integrate);
  const double cases = (alone ? kAlone : kInLanes) / std::max(of_case, 1.0);
  if (cases >= request.shard_cases) return request.shard_cases;
  const int whole = static_cast<int>(cases);
  if (alone) return std::max(1, whole);
  return std::min(request.shard_cases, std::max(kWidest, whole / kWidest * kWidest));
}

/// The value of a fact of the plan, `parse`d from its text. Throws InputError unless it is one that
/// `is_allowed`: a folder from elsewhere is not trusted.
template <class Parse, class IsAllowed>
auto take_fact(const Facts& plan, const std::string& name, const Parse& parse,
               const IsAllowed& is_allowed) {
  const std::string text = find_text(plan, name).value_or("");
  const auto value = parse(text);
  if (value && is_allowed(*value)) return *value;
  throw InputError(fmt::format(
      "plan.h5: {} = '{}': is none that `strut plan` chooses for this sweep", name, text));
}

}  // namespace

std::optional<IntegratorChoice> choose_settings(SweepRequest& request) {
  std::optional<IntegratorChoice> choice;
  if (request.accuracy > 0.0) choice = choose_integrator(request);
  if (request.chooses_shards) request.shard_cases = calc_shard_cases(request);
  return choice;
}

std::optional<double> measure_step_error(const SweepRequest& request) {
  constexpr std::int64_t kCases = 3;
  constexpr double kFraction = 0.25;
  if (request.integrate.solver == Solver::kCvode) return std::nullopt;
  const TrialCases trial = prepare_trial(Plan(request), kCases);
  if (trial.ids.empty()) return std::nullopt;
  SolverOptions shorter = request.integrate;
  shorter.options.step.step *= kFraction;
  shorter.options.step.coarse_step = 0.0;
  shorter.options.step.locate_events = true;
  const ShardRows reference = run_trial(request, shorter, trial.ids);
  const ShardRows rows = run_trial(request, request.integrate, trial.ids);
  return calc_largest_error(request, rows, reference, trial);
}

Plan make_plan(const std::filesystem::path& sweep) {
  SweepRequest request = read_request(sweep);
  choose_settings(request);
  return Plan(request);
}

void adopt_settings(const Facts& plan, SweepRequest& request) {
  if (request.chooses_shards) {
    request.shard_cases = take_fact(
        plan, "shards.cases", [](const std::string& text) { return parse_number<int>(text); },
        [&](int cases) { return cases >= 1 && cases <= request.shard_cases; });
  }
  if (!(request.accuracy > 0.0)) return;
  const auto parse = [](const std::string& text) { return parse_number<double>(text); };
  StepOptions& step = request.integrate.options.step;
  step.stepper = to_stepper(take_fact(
      plan, "integrate.method",
      [](const std::string& text) { return find_value(kIntegrators, text); },
      [](Integrator method) { return method != Integrator::kCvode; }));
  step.step = take_fact(plan, "integrate.step", parse, [&](double value) {
    return value > 0.0 && value <= kMaxStep &&
           find_step_count_fault(find_longest_duration(request), value).empty();
  });
  step.coarse_step = take_fact(plan, "integrate.coarse_step", parse, [&](double value) {
    return value == 0.0 || (value >= step.step && value <= kMaxStep);
  });
  request.integrate.options.closure = request.integrate.reference.closure = take_fact(
      plan, "integrate.closure",
      [](const std::string& text) { return find_value(kClosures, text); },
      [](Closure) { return true; });
}

std::string describe_integrator(const SolverOptions& integrate) {
  const char* const closure = find_name(kClosures, integrate.options.closure);
  if (integrate.solver == Solver::kCvode) return fmt::format("cvode, {}", closure);
  const StepOptions& step = integrate.options.step;
  const std::string coarse =
      step.coarse_step > 0.0
          ? fmt::format(" ({} ms off the bump)", format_number(1e3 * step.coarse_step))
          : "";
  return fmt::format("{} {} ms{}, {}", get_name(step.stepper), format_number(1e3 * step.step),
                     coarse, closure);
}

}  // namespace strut
