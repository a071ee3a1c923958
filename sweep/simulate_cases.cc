#include "sweep/simulate_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sweep/timer.h"

namespace strut {
namespace {

IntegrateOptions make_retry_options(const IntegrateOptions& options, int attempt) {
  IntegrateOptions finer = options;
  finer.step.step = std::ldexp(options.step.step, -2 * attempt);
  finer.step.coarse_step = 0.0;
  finer.step.locate_events = true;
  return finer;
}

BatchPlan make_batch_plan(const SweepRequest& request) {
  return {request.integrate, make_sample_plan(request), request.snapshot.offset,
          get_start_method(request)};
}

void fail(ShardRows& rows, std::size_t row, RunStatus status, double time, std::string reason) {
  rows.status[row] = static_cast<std::int32_t>(status);
  rows.failure_time[row] = time;
  rows.reason[row] = std::move(reason);
}

}  // namespace

std::string describe_case_status() {
  std::vector<std::string> texts;
  texts.reserve(kRunStatuses.size());
  for (const RunStatusInfo& info : kRunStatuses) {
    texts.push_back(fmt::format("{} {}", static_cast<int>(info.status), info.name));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

int get_last_attempt(std::int32_t status) {
  switch (static_cast<RunStatus>(status)) {
    case RunStatus::kDiverged:
    case RunStatus::kStalled:
      return 4;
    case RunStatus::kOutOfTravel:
      return 2;  // a car that leaves its travel with a sixteenth of the step, too, does leave it
    default:
      return 0;
  }
}

SimulationSeconds& SimulationSeconds::operator+=(const SimulationSeconds& other) {
  prepare += other.prepare;
  integrate += other.integrate;
  retry += other.retry;
  return *this;
}

CaseSimulator::CaseSimulator(const Plan& plan, const Kernel& kernel)
    : plan_(plan), batches_(make_batch_plan(plan.request()), kernel) {}

bool CaseSimulator::simulate(std::span<const std::int64_t> cases, ShardRows& rows,
                             std::size_t first_row, const std::atomic<bool>& stop) {
  std::vector<ReadyCase> ready;
  {
    const Timer timer(seconds_.prepare);
    ready = prepare(cases, rows, first_row);
  }
  const auto record_row = [&](std::size_t i, const LaneResults& results, int lane) {
    record(results, lane, rows, first_row + i);
  };
  for (std::size_t begin = 0; begin < ready.size();) {
    if (stop) return false;
    const Timer timer(seconds_.integrate);
    begin += batches_.run_group(std::span(ready).subspan(begin), record_row);
  }
  if (plan_.request().integrate.solver == Solver::kCvode) return true;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (get_last_attempt(rows.status[first_row + i]) == 0) continue;
    if (stop) return false;
    retry(cases[i], 1, rows, first_row + i);
  }
  return true;
}

void CaseSimulator::retry(std::int64_t case_id, int attempt, ShardRows& rows, std::size_t row) {
  const Timer timer(seconds_.retry);
  const std::vector<ReadyCase> ready = prepare({&case_id, 1}, rows, row);
  rows.attempt[row] = attempt;
  if (ready.empty()) return;
  const IntegrateOptions options = make_retry_options(plan_.request().integrate.options, attempt);
  record(batches_.run_alone(ready.front().prepared, options), 0, rows, row);
}

/// Writes parameters and stratum of a row; resets everything else.
void CaseSimulator::start_row(std::int64_t case_id, ShardRows& rows, std::size_t row) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const SweepRequest& request = plan_.request();
  const std::size_t axes = request.grid.axes().size();
  const std::size_t channels = request.snapshot.on ? request.snapshot.channels.size() : 0;
  rows.case_id[row] = case_id;
  plan_.calc_parameters(case_id, std::span(rows.parameters).subspan(row * axes, axes));
  rows.layer[row] = plan_.calc_stratum(case_id);
  rows.status[row] = rows.attempt[row] = 0;
  rows.event_time[row] = rows.failure_time[row] = kNone;
  rows.reason[row].clear();
  std::fill_n(rows.snapshot.data() + row * channels, channels, kNone);
  for (std::vector<double>& channel : rows.history) {
    const std::size_t samples = channel.size() / rows.size();
    std::fill_n(channel.data() + row * samples, samples, kNone);
  }
}

std::vector<ReadyCase> CaseSimulator::prepare(std::span<const std::int64_t> cases, ShardRows& rows,
                                              std::size_t first_row) {
  for (std::size_t i = 0; i < cases.size(); ++i) start_row(cases[i], rows, first_row + i);
  return batches_.prepare(
      cases.size(), [&](std::size_t i) { return plan_.make_case(cases[i]); },
      [&](std::size_t i, RunStatus status, const std::string& reason) {
        fail(rows, first_row + i, status, 0.0, reason);
      });
}

void CaseSimulator::record(const LaneResults& results, int lane, ShardRows& rows,
                           std::size_t row) const {
  const SweepRequest& request = plan_.request();
  if (!results.is_done(lane)) {
    const RunStatus status = results.get_status(lane);
    fail(rows, row, status, results.get_failure_time(lane),
         kRunStatuses[static_cast<std::size_t>(status)].reason);
    return;
  }
  const std::vector<int>& kept = request.history.channels;
  for (std::size_t h = 0; h < rows.history.size(); ++h) {
    const std::vector<double> samples = results.get_history(kept[h], lane);
    std::copy(samples.begin(), samples.end(),
              rows.history[h].begin() + static_cast<std::ptrdiff_t>(row * samples.size()));
  }
  if (!request.snapshot.on) return;
  rows.event_time[row] = results.get_event_time(lane);
  if (!results.has_snapshot(lane)) {
    fail(rows, row, RunStatus::kNoEvent, plan_.make_case(rows.case_id[row]).maneuver.duration,
         kRunStatuses[static_cast<std::size_t>(RunStatus::kNoEvent)].reason);
    return;
  }
  const std::vector<int>& channels = request.snapshot.channels;
  for (std::size_t s = 0; s < channels.size(); ++s) {
    rows.snapshot[row * channels.size() + s] = results.get_snapshot(channels[s], lane);
  }
}

}  // namespace strut
