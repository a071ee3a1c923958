#include "jobs/case/plan_estimate.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <atomic>
#include <ctime>
#include <mutex>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "base/text/format_number.h"
#include "jobs/case/load_case.h"
#include "jobs/cli/provenance.h"
#include "model/error/model_error.h"
#include "sweep/choices.h"
#include "sweep/simulate_cases.h"
#include "sweep/step_stability.h"

namespace strut {
namespace {

/// case_id, layer, status, attempt, event_time, failure_time
constexpr double kFixedRowBytes = 8.0 + 3.0 * 4.0 + 2.0 * 8.0;
/// Least time of a core's measurement [s]; the most rows that are compressed [bytes].
constexpr double kMinMeasured = 0.2, kMaxBytes = 4e6;

/// Processor time of this thread [s], which other programs do not change much.
double read_thread_time() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The plan's first cases with their rows, and the processor time of each.
struct Sample {
  ShardRows rows;
  double seconds_per_case = 0.0;
};

/// Most cases of a sample: a shard, as far as compressing it takes no time.
std::int64_t find_largest_sample(const Plan& plan, std::int64_t batch) {
  const double affordable = kMaxBytes / calc_row_bytes(plan.make_schema());
  const auto rows = static_cast<std::int64_t>(
      std::min(affordable, static_cast<double>(plan.request().shard_cases)));
  return std::min(std::max(rows, batch), plan.case_count());
}

ShardRows take_rows(const ShardSchema& schema, const ShardRows& rows, std::int64_t count) {
  ShardRows taken = ShardRows::make(schema, static_cast<std::size_t>(count));
  for (std::size_t row = 0; row < taken.size(); ++row) taken.set_row(row, rows, row);
  return taken;
}

/// Simulates batches on all cores until each has measured for kMinMeasured or no case is left.
Sample draw_sample(const Plan& plan, const Kernel& kernel, int cores) {
  const auto batch = static_cast<std::int64_t>(CaseSimulator(plan, kernel).batch_size());
  const std::int64_t count = find_largest_sample(plan, batch);
  Sample sample{ShardRows::make(plan.make_schema(), static_cast<std::size_t>(count))};
  std::atomic<std::int64_t> next{0};
  std::atomic<bool> halt{false};
  std::mutex mutex;
  double seconds = 0.0;
  std::int64_t measured = 0;
  const auto work = [&] {
    CaseSimulator simulator(plan, kernel);
    double own_seconds = 0.0, first_seconds = 0.0;
    std::int64_t own_cases = 0, first_cases = 0;
    // The first batch also prepares the mechanism, which later batches share.
    while (first_seconds + own_seconds < kMinMeasured) {
      const std::int64_t begin = next.fetch_add(batch);
      if (begin >= count) break;
      std::vector<std::int64_t> cases;
      for (std::int64_t i = begin; i < std::min(begin + batch, count); ++i) {
        cases.push_back(plan.calc_case_id(i));
      }
      const double start = read_thread_time();
      simulator.simulate(cases, sample.rows, static_cast<std::size_t>(begin), halt);
      const bool is_first = first_cases == 0;
      (is_first ? first_seconds : own_seconds) += read_thread_time() - start;
      (is_first ? first_cases : own_cases) += static_cast<std::int64_t>(cases.size());
    }
    const std::lock_guard lock(mutex);
    seconds += own_cases > 0 ? own_seconds : first_seconds;
    measured += own_cases > 0 ? own_cases : first_cases;
  };
  run_team(cores, halt, work);
  sample.rows = take_rows(plan.make_schema(), sample.rows, std::min(next.load(), count));
  sample.seconds_per_case = seconds / static_cast<double>(std::max<std::int64_t>(measured, 1));
  return sample;
}

/// Size of the files of all shards, by those of a sample and of its half.
double estimate_bytes(const Plan& plan, const ShardRows& rows) {
  const ShardSchema schema = plan.make_schema();
  const ShardProvenance provenance{plan.hash(), 0, make_run_provenance()};
  const auto measure = [&](const ShardRows& some) {
    return static_cast<double>(make_shard_image(compress_shard(schema, some), provenance).size());
  };
  const auto count = static_cast<std::int64_t>(rows.size()), half = count / 2;
  const double whole = measure(rows);
  double per_row = whole / static_cast<double>(count), fixed = 0.0;
  if (half > 0) {
    const double less = measure(take_rows(schema, rows, half));
    per_row = (whole - less) / static_cast<double>(count - half);
    fixed = whole - per_row * static_cast<double>(count);
  }
  return fixed * static_cast<double>(plan.shard_count()) +
         per_row * static_cast<double>(plan.case_count());
}

void check_step(const Plan& plan, const PreparedCase& c, const std::string& which, const char* key,
                double step) {
  const IntegrateOptions& options = plan.request().integrate.options;
  const auto fault = find_step_fault(c, options, step);
  if (!fault) return;
  throw InputError(fmt::format("{}: integrate.{} = {} s: unstable ({}) with {} for {}; {}",
                               plan.request().path.string(), key, format_number(step),
                               fault->reason, get_name(options.step.stepper), which,
                               fault->allowed));
}

void check_steps(const Plan& plan, const PreparedCase& c, const std::string& which) {
  if (plan.request().integrate.solver == Solver::kCvode) return;
  const StepOptions& step = plan.request().integrate.options.step;
  check_step(plan, c, which, "step", step.step);
  if (step.coarse_step > 0.0) check_step(plan, c, which, "coarse_step", step.coarse_step);
}

/// The same for a point of the grid; a case that the model rejects is a result of the sweep.
void check_point(const Plan& plan, CasePreparer& preparer, std::int64_t id) {
  try {
    check_steps(plan, preparer.prepare(plan.make_case(id)), "case " + std::to_string(id));
  } catch (const ModelError&) {
  }
}

}  // namespace

void check_plan(const Plan& plan) {
  const SweepRequest& request = plan.request();
  CasePreparer preparer;
  const CaseSource source{request.vehicle, request.maneuver, {}};
  check_steps(plan, prepare_case(source, request.base, preparer), "the base car and maneuver");
  check_point(plan, preparer, 0);
  check_point(plan, preparer, plan.point_count() - 1);
}

std::vector<ImpossibleCase> find_impossible_ends(const Plan& plan) {
  if (plan.request().sample.method != SampleMethod::kGrid) return {};
  std::vector<ImpossibleCase> found;
  CasePreparer preparer;
  std::int64_t stride = plan.point_count();
  for (const Axis& axis : plan.request().grid.axes()) {
    stride /= axis.count;  // the first axis is slowest
    const std::int64_t id = (axis.count - 1) * stride;
    try {
      preparer.prepare(plan.make_case(id));
    } catch (const ModelError& e) {
      found.push_back({id, axis.name, e.what()});
    }
  }
  return found;
}

double calc_row_bytes(const ShardSchema& schema) {
  const std::size_t numbers = schema.parameters.size() + schema.snapshot.size() +
                              schema.history.size() * schema.history_samples;
  return kFixedRowBytes + 8.0 * static_cast<double>(numbers);
}

SweepEstimate estimate_sweep(const Plan& plan, const Kernel& kernel) {
  SweepEstimate estimate;
  estimate.cores = omp_get_num_procs();
  const Sample sample = draw_sample(plan, kernel, estimate.cores);
  estimate.measured = static_cast<int>(sample.rows.size());
  for (std::size_t row = 0; row < sample.rows.size(); ++row) {
    const std::int32_t status = sample.rows.status[row];
    const bool no_event = status == static_cast<std::int32_t>(RunStatus::kNoEvent);
    estimate.without_event += no_event ? 1 : 0;
    if (no_event || status == 0) continue;
    if (estimate.failed++ > 0) continue;
    estimate.first_failed = sample.rows.case_id[row];
    estimate.first_reason = sample.rows.reason[row];
  }
  const double start = read_thread_time();
  estimate.bytes = estimate_bytes(plan, sample.rows);
  // A file of the sample and one of its half.
  const double seconds_per_row =
      (read_thread_time() - start) / (1.5 * static_cast<double>(estimate.measured));
  estimate.core_seconds =
      (sample.seconds_per_case + seconds_per_row) * static_cast<double>(plan.case_count());
  return estimate;
}

std::string describe_core_seconds(double core_seconds) {
  constexpr double kHour = 3600.0;
  return core_seconds < 0.1 * kHour ? fmt::format("{:.3g} core-seconds", core_seconds)
                                    : fmt::format("{:.3g} core-hours", core_seconds / kHour);
}

}  // namespace strut
