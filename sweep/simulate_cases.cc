#include "sweep/simulate_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "model/error/model_error.h"
#include "model/sensor/read_out.h"
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

ReadOut make_read_out(const std::vector<const PreparedCase*>& lanes) {
  std::vector<const EffectSettings*> sensors;
  sensors.reserve(lanes.size());
  for (const PreparedCase* c : lanes) sensors.push_back(&c->sensors);
  return ReadOut(list_car_channels(), sensors);
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

bool may_retry(std::int32_t status) {
  return status == static_cast<std::int32_t>(RunStatus::kDiverged) ||
         status == static_cast<std::int32_t>(RunStatus::kOutOfTravel) ||
         status == static_cast<std::int32_t>(RunStatus::kStalled);
}

SimulationSeconds& SimulationSeconds::operator+=(const SimulationSeconds& other) {
  prepare += other.prepare;
  integrate += other.integrate;
  retry += other.retry;
  return *this;
}

CaseSimulator::CaseSimulator(const Plan& plan, const Kernel& kernel)
    : plan_(plan), kernel_(kernel), samples_(make_sample_plan(plan.request())) {}

std::size_t CaseSimulator::batch_size() const {
  const bool in_lanes = plan_.request().integrate.solver == Solver::kLanes;
  return in_lanes ? static_cast<std::size_t>(kernel_.lanes) : 1;
}

bool CaseSimulator::simulate(std::span<const std::int64_t> cases, ShardRows& rows,
                             std::size_t first_row, const std::atomic<bool>& stop) {
  std::vector<Ready> ready;
  {
    const Timer timer(seconds_.prepare);
    ready = prepare_all(cases, rows, first_row);
  }
  for (std::size_t begin = 0; begin < ready.size();) {
    if (stop) return false;
    begin += run_group(std::span(ready).subspan(begin), rows);
  }
  if (plan_.request().integrate.solver == Solver::kCvode) return true;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!may_retry(rows.status[first_row + i])) continue;
    if (stop) return false;
    retry(cases[i], 1, rows, first_row + i);
  }
  return true;
}

void CaseSimulator::retry(std::int64_t case_id, int attempt, ShardRows& rows, std::size_t row) {
  const Timer timer(seconds_.retry);
  const std::vector<Ready> ready = prepare_all({&case_id, 1}, rows, row);
  rows.attempt[row] = attempt;
  if (ready.empty()) return;
  const PreparedCase& prepared = ready.front().prepared;
  const SolverOptions& integrate = plan_.request().integrate;
  const LaneResults results =
      simulate_readings(make_read_out({&prepared}), samples_, [&](const SamplePlan& samples) {
        return integrate.solver == Solver::kCvode
                   ? run_cvode(prepared, integrate.reference, samples)
                   : kernel_.run_scalar(prepared, make_retry_options(integrate.options, attempt),
                                        samples);
      });
  record(results, 0, rows, row);
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

std::optional<PreparedCase> CaseSimulator::assemble(std::int64_t case_id, ShardRows& rows,
                                                    std::size_t row) {
  try {
    return preparer_.assemble(plan_.make_case(case_id), plan_.request().snapshot.offset);
  } catch (const ModelError& e) {
    const bool is_road = e.fault() == ModelFault::kRoad;
    fail(rows, row, is_road ? RunStatus::kImpossible : RunStatus::kNoEquilibrium, 0.0, e.what());
  }
  return std::nullopt;
}

std::vector<CaseSimulator::Ready> CaseSimulator::prepare_all(std::span<const std::int64_t> cases,
                                                             ShardRows& rows,
                                                             std::size_t first_row) {
  std::vector<Ready> ready;
  ready.reserve(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    start_row(cases[i], rows, first_row + i);
    std::optional<PreparedCase> assembled = assemble(cases[i], rows, first_row + i);
    if (assembled) ready.push_back({std::move(*assembled), first_row + i});
  }
  return keep_started(std::move(ready), rows);
}

/// Finds the starts. Returns the cases that have one; sets the failure of the others.
std::vector<CaseSimulator::Ready> CaseSimulator::keep_started(std::vector<Ready> ready,
                                                              ShardRows& rows) const {
  std::vector<PreparedCase*> cases;
  cases.reserve(ready.size());
  for (Ready& r : ready) cases.push_back(&r.prepared);
  const std::vector<std::string> reasons =
      find_starts(kernel_, cases, get_start_method(plan_.request()));
  std::vector<Ready> started;
  started.reserve(ready.size());
  for (std::size_t i = 0; i < ready.size(); ++i) {
    if (reasons[i].empty()) {
      started.push_back(std::move(ready[i]));
    } else {
      fail(rows, ready[i].row, RunStatus::kNoEquilibrium, 0.0, reasons[i]);
    }
  }
  return started;
}

/// Runs the first of `ready` together with as many of its successors as may share lanes with it;
/// returns their number.
std::size_t CaseSimulator::run_group(std::span<const Ready> ready, ShardRows& rows) {
  const Timer timer(seconds_.integrate);
  const SolverOptions& integrate = plan_.request().integrate;
  std::vector<const PreparedCase*> lanes;
  lanes.reserve(batch_size());
  for (const Ready& next : ready) {
    if (lanes.size() == batch_size() ||
        !may_share_lanes(ready[0].prepared, next.prepared, integrate.options.closure)) {
      break;
    }
    lanes.push_back(&next.prepared);
  }
  const auto count = static_cast<int>(lanes.size());
  const LaneResults results =
      simulate_readings(make_read_out(lanes), samples_, [&](const SamplePlan& samples) {
        return integrate.solver == Solver::kCvode
                   ? run_cvode(*lanes[0], integrate.reference, samples)
                   : kernel_.run_lanes(lanes.data(), count, integrate.options, samples);
      });
  for (int lane = 0; lane < count; ++lane) {
    record(results, lane, rows, ready[static_cast<std::size_t>(lane)].row);
  }
  return lanes.size();
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
