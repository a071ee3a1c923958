#include "sweep/batch_simulator.h"

#include <utility>

#include "model/channel/car_channels.h"
#include "model/error/model_error.h"
#include "model/sensor/read_out.h"
#include "sweep/simulate_case.h"

namespace strut {
namespace {

ReadOut make_read_out(const std::vector<const PreparedCase*>& lanes) {
  std::vector<const EffectSettings*> sensors;
  sensors.reserve(lanes.size());
  for (const PreparedCase* c : lanes) sensors.push_back(&c->sensors);
  return ReadOut(list_car_channels(), sensors);
}

}  // namespace

BatchSimulator::BatchSimulator(BatchPlan plan, const Kernel& kernel)
    : plan_(std::move(plan)), kernel_(kernel) {}

std::size_t BatchSimulator::batch_size() const {
  const bool in_lanes = plan_.integrate.solver == Solver::kLanes;
  return in_lanes ? static_cast<std::size_t>(kernel_.lanes) : 1;
}

std::vector<ReadyCase> BatchSimulator::prepare(std::size_t count, const MakeCase& make_case,
                                               const Fail& fail) {
  std::vector<ReadyCase> assembled;
  assembled.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    try {
      assembled.push_back({preparer_.assemble(make_case(i), plan_.snapshot_offset), i});
    } catch (const ModelError& e) {
      const bool is_road = e.fault() == ModelFault::kRoad;
      fail(i, is_road ? RunStatus::kImpossible : RunStatus::kNoEquilibrium, e.what());
    }
  }
  return keep_started(std::move(assembled), fail);
}

/// Finds the starts. Returns the cases that have one; reports the others.
std::vector<ReadyCase> BatchSimulator::keep_started(std::vector<ReadyCase> assembled,
                                                    const Fail& fail) const {
  std::vector<PreparedCase*> cases;
  cases.reserve(assembled.size());
  for (ReadyCase& c : assembled) cases.push_back(&c.prepared);
  const std::vector<std::string> reasons = find_starts(kernel_, cases, plan_.start);
  std::vector<ReadyCase> started;
  started.reserve(assembled.size());
  for (std::size_t i = 0; i < assembled.size(); ++i) {
    if (reasons[i].empty()) {
      started.push_back(std::move(assembled[i]));
    } else {
      fail(assembled[i].number, RunStatus::kNoEquilibrium, reasons[i]);
    }
  }
  return started;
}

std::size_t BatchSimulator::run_group(std::span<const ReadyCase> ready,
                                      const Record& record) const {
  const SolverOptions& integrate = plan_.integrate;
  const PreparedCase& first = ready[0].prepared;
  std::vector<const PreparedCase*> lanes;
  lanes.reserve(batch_size());
  bool has_sensors = false, has_durations = false;
  for (const ReadyCase& next : ready) {
    has_sensors = has_sensors || !next.prepared.sensors.empty();
    has_durations = has_durations || next.prepared.duration != first.duration;
    // Sensors with memory read the samples of a whole run, which ends with that of its lane.
    const bool may_join =
        !(has_sensors && has_durations) && may_share_lanes(first, next.prepared, integrate.options);
    if (lanes.size() == batch_size() || !may_join) break;
    lanes.push_back(&next.prepared);
  }
  const auto count = static_cast<int>(lanes.size());
  const LaneResults results =
      simulate_readings(make_read_out(lanes), plan_.samples, [&](const SamplePlan& samples) {
        return integrate.solver == Solver::kCvode
                   ? run_cvode(*lanes[0], integrate.reference, samples)
                   : kernel_.run_lanes(lanes.data(), count, integrate.options, samples);
      });
  for (int lane = 0; lane < count; ++lane) {
    record(ready[static_cast<std::size_t>(lane)].number, results, lane);
  }
  return lanes.size();
}

LaneResults BatchSimulator::run_alone(const PreparedCase& c,
                                      const IntegrateOptions& options) const {
  SolverOptions integrate = plan_.integrate;
  integrate.options = options;
  return simulate_case(c, integrate, plan_.samples, kernel_);
}

}  // namespace strut
