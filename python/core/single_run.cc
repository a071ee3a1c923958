#include "python/core/single_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "base/error/input_error.h"
#include "model/kernel/derivatives.h"
#include "model_files/parameters.h"
#include "sweep/simulate_case.h"

namespace strut {
namespace {

/// Prepared cases beside a case, kept in place.
class NeighborStore {
 public:
  explicit NeighborStore(const Case& setup) : setup_(setup) {
    cases_.push_back(preparer_.prepare(setup));
  }
  const PreparedCase& at() const { return cases_.front(); }

  /// The neighbors along a parameter. Throws InputError where the case is not differentiable by it.
  Neighbors add(const std::string& name) {
    const ParameterInfo& parameter = find_parameter(name);
    const double base = parameter.get(setup_);
    Case same = setup_;
    parameter.set(same, base);
    if (!(same.vehicle == setup_.vehicle) || !(same.maneuver == setup_.maneuver)) {
      throw InputError(fmt::format(
          "derivatives = {}: its two corners differ; allowed: the parameters of the corners",
          name));
    }
    // Two steps beside the case, or one where the other is not allowed: by the parameter's range,
    // or by what it must fit to.
    constexpr double kStep = 1e-4, kOneSidedStep = 1e-5, kFloor = 1e-2;
    const double size = std::max(std::fabs(base), 0.1 * parameter.typical);
    const double step = kStep * (size > 0.0 ? size : kFloor);
    const PreparedCase* above = try_to_prepare(parameter, base + step);
    const PreparedCase* below = try_to_prepare(parameter, base - step);
    Neighbors along{above, below, 2.0 * step};
    if (above == nullptr || below == nullptr) {
      const double side = (above == nullptr ? -1.0 : 1.0) * kOneSidedStep / kStep * step;
      const PreparedCase* near = try_to_prepare(parameter, base + side);
      along = side > 0.0 ? Neighbors{near, &at(), side} : Neighbors{&at(), near, -side};
      if (near == nullptr) along.above = nullptr;
    }
    if (along.above == nullptr || !is_differentiable(at(), along)) {
      throw InputError(fmt::format(
          "derivatives = {}: does not act smoothly on this car; allowed: parameters of both sides "
          "of a symmetric car that neither switch an effect on nor change a curve, a sensor or the "
          "formula of the tire",
          name));
    }
    return along;
  }

 private:
  /// Null where the value is not allowed, or the car is none with it.
  const PreparedCase* try_to_prepare(const ParameterInfo& parameter, double value) {
    if (!(value >= parameter.allowed.low) || !(value <= parameter.allowed.high)) return nullptr;
    Case moved = setup_;
    parameter.set(moved, value);
    CasePreparer own = preparer_;
    try {
      cases_.push_back(own.prepare(moved));
    } catch (const ModelError&) {
      return nullptr;
    }
    return &cases_.back();
  }

  const Case setup_;
  CasePreparer preparer_;
  std::deque<PreparedCase> cases_;
};

/// One lane of results, without slopes.
LaneResults take_lane(const LaneResults& all, int lane) {
  LaneResults one;
  one.status = {all.status[static_cast<std::size_t>(lane)]};
  one.failure_time = {all.get_failure_time(lane)};
  one.event_time = {all.get_event_time(lane)};
  one.sample_count = all.sample_count;
  one.recorded = all.recorded;
  const auto every = static_cast<std::size_t>(all.lanes);
  for (auto i = static_cast<std::size_t>(lane); i < all.snapshot.size(); i += every) {
    one.snapshot.push_back(all.snapshot[i]);
  }
  one.history.reserve(all.history.size() / every);
  for (auto i = static_cast<std::size_t>(lane); i < all.history.size(); i += every) {
    one.history.push_back(all.history[i]);
  }
  return one;
}

/// Runs the case in lanes that each have kDirections of the parameters.
LaneResults differentiate(const SingleRequest& request, const SamplePlan& plan) {
  if (request.integrate.solver == Solver::kCvode) {
    throw InputError("derivatives: not by cvode; allowed: rk4, abm4");
  }
  NeighborStore store(request.setup);
  if (!store.at().sensors.empty()) {
    throw InputError("derivatives: not through effects of sensors; remove them from the vehicle");
  }
  const std::size_t count = request.derivatives.size();
  std::vector<DifferentiatedCase> lanes((count + kDirections - 1) / kDirections,
                                        DifferentiatedCase{&store.at(), {}});
  for (std::size_t i = 0; i < count; ++i) {
    lanes[i / kDirections].along[i % kDirections] = store.add(request.derivatives[i]);
  }
  const DerivativeKernel& kernel = list_derivative_kernels().front();
  const auto width = static_cast<std::size_t>(kernel.lanes);
  LaneResults one;
  for (std::size_t first = 0; first < lanes.size(); first += width) {
    const std::size_t used = std::min(width, lanes.size() - first);
    const LaneResults all =
        kernel.run(lanes.data() + first, static_cast<int>(used), request.integrate.options, plan);
    if (first == 0) one = take_lane(all, 0);
    for (std::size_t i = first * kDirections; i < std::min(count, (first + used) * kDirections);
         ++i) {
      const auto lane = static_cast<int>(i / kDirections - first);
      one.slopes.push_back(take_lane(all.slopes[i % kDirections], lane));
    }
  }
  return one;
}

}  // namespace

LaneResults simulate_single(const SingleRequest& request) {
  SamplePlan plan;
  plan.interval = request.interval;
  plan.recorded = request.channels;
  if (!request.derivatives.empty()) return differentiate(request, plan);
  CasePreparer preparer;
  const PreparedCase c = preparer.prepare(request.setup);
  if (!c.sensors.empty()) plan.recorded = {};  // a sensor needs the history of all channels
  return simulate_case(c, request.integrate, plan);
}

}  // namespace strut
