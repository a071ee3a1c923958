#include "jobs/case/plan_estimate.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <atomic>
#include <ctime>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "jobs/case/load_case.h"
#include "model/error/model_error.h"
#include "sweep/choices.h"
#include "sweep/simulate_cases.h"
#include "sweep/step_stability.h"

namespace strut {
namespace {

/// case_id, layer, status, attempt, event_time, failure_time
constexpr double kFixedRowBytes = 8.0 + 3.0 * 4.0 + 2.0 * 8.0;
/// A batch that takes less time is measured again [s].
constexpr double kMinMeasured = 0.2;

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

double calc_row_bytes(const ShardSchema& schema) {
  const std::size_t numbers = schema.parameters.size() + schema.snapshot.size() +
                              schema.history.size() * schema.history_samples;
  return kFixedRowBytes + 8.0 * static_cast<double>(numbers);
}

SweepEstimate estimate_sweep(const Plan& plan, const Kernel& kernel) {
  SweepEstimate estimate;
  estimate.cores = omp_get_num_procs();
  const ShardSchema schema = plan.make_schema();
  const auto total = static_cast<double>(plan.case_count());
  estimate.bytes = total * calc_row_bytes(schema);

  CaseSimulator simulator(plan, kernel);
  const auto batch = static_cast<std::int64_t>(simulator.batch_size());
  std::vector<std::int64_t> cases;
  for (std::int64_t i = 0; i < std::min(batch, plan.case_count()); ++i) {
    cases.push_back(plan.calc_case_id(i));
  }
  ShardRows rows = ShardRows::make(schema, cases.size());
  const std::atomic<bool> never{false};
  const auto measure = [&] {
    const std::clock_t start = std::clock();  // processor time: other programs may be running
    simulator.simulate(cases, rows, 0, never);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  double seconds = measure();
  // The first batch also prepares the mechanism, which later batches share.
  if (seconds < kMinMeasured) seconds = measure();
  estimate.measured = static_cast<int>(cases.size());
  for (const std::int32_t status : rows.status) {
    const bool no_event = status == static_cast<std::int32_t>(RunStatus::kNoEvent);
    estimate.without_event += no_event ? 1 : 0;
    estimate.failed += !no_event && status != 0 ? 1 : 0;
  }
  estimate.seconds = seconds / static_cast<double>(cases.size()) * total / estimate.cores;
  return estimate;
}

}  // namespace strut
