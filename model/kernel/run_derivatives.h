// Differentiated simulation of one batch of cases, for any lane type. Only the kernels of the
// instruction sets include this.
#pragma once

#include <algorithm>
#include <memory>

#include "base/math/dual.h"
#include "model/car/trim_derivatives.h"
#include "model/kernel/derivatives.h"
#include "model/kernel/run_cases.h"

namespace strut {

template <class T>
using DualLanes = Dual<T, kDirections>;

/// Throws ModelError as DerivativeKernel::run does.
void check_differentiated(const DifferentiatedCase* cases, int count,
                          const IntegrateOptions& options);

/// Whether two cases run on the same road.
bool have_equal_roads(const PreparedCase& a, const PreparedCase& b);

/// Derivative of a number of a prepared case by the direction of its neighbors.
template <class Get>
double calc_slope(const Neighbors& along, const Get& get) {
  if (along.above == nullptr) return 0.0;
  return (get(*along.above) - get(*along.below)) / along.distance;
}

/// The same for all fields of a struct of doubles.
template <template <class> class X, class Get>
X<double> calc_slopes(const Neighbors& along, const Get& get) {
  constexpr std::size_t kFields = sizeof(X<double>) / sizeof(double);
  X<double> slopes{};
  if (along.above == nullptr) return slopes;
  std::array<double, kFields> above, below;
  __builtin_memcpy(above.data(), &get(*along.above), sizeof(slopes));
  __builtin_memcpy(below.data(), &get(*along.below), sizeof(slopes));
  for (std::size_t i = 0; i < kFields; ++i) above[i] = (above[i] - below[i]) / along.distance;
  __builtin_memcpy(reinterpret_cast<unsigned char*>(&slopes), above.data(), sizeof(slopes));
  return slopes;
}

/// A batch of differentiated cases of kLaneCount<T> lanes.
template <class T>
class DerivativeBatch {
 public:
  using D = DualLanes<T>;

  explicit DerivativeBatch(const DifferentiatedCase* cases) : cases_(cases) {
    for (int lane = 0; lane < kLaneCount<T>; ++lane) at_[lane] = cases[lane].at;
  }
  const PreparedCase* const* at() const { return at_.data(); }

  /// A number of the cases.
  template <class Get>
  D pack(const Get& get) const {
    D packed(0.0);
    for (int lane = 0; lane < kLaneCount<T>; ++lane) {
      set_lane(packed.v, lane, get(*at_[lane]));
      for (std::size_t i = 0; i < kDirections; ++i) {
        set_lane(packed.d[i], lane, calc_slope(cases_[lane].along[i], get));
      }
    }
    return packed;
  }

  /// The vehicles, on a road without a bump.
  template <Sides S>
  Vehicle<D> pack_vehicle() const {
    const Vehicle<T> value = strut::pack_vehicle<S, T>(at());
    std::array<VehicleParameters<T>, kDirections> slopes;
    std::vector<VehicleParameters<double>> lanes(kWidth);
    const auto get = [](const PreparedCase& c) -> const VehicleParameters<double>& {
      return c.vehicle.numbers;
    };
    for (std::size_t i = 0; i < kDirections; ++i) {
      for (std::size_t lane = 0; lane < kWidth; ++lane) {
        lanes[lane] = calc_slopes<VehicleParameters>(cases_[lane].along[i], get);
      }
      slopes[i] = pack_lanes<VehicleParameters, T>(lanes.data());
    }
    Vehicle<D> vehicle{value.layout, join_dual(value.numbers, slopes), value.pacejka, {}, {}};
    std::array<const CornerForceMaps*, kWidth> maps;
    for (std::size_t lane = 0; lane < kWidth; ++lane) maps[lane] = &at_[lane]->force_maps;
    fill_strut_elements<S>(vehicle, maps.data());
    return vehicle;
  }

  std::shared_ptr<const RoadSlopes<T, kDirections>> make_road_slopes() const {
    auto slopes = std::make_shared<RoadSlopes<T, kDirections>>();
    for (std::size_t i = 0; i < kDirections; ++i) add_road_slope(i, *slopes);
    return slopes;
  }

  /// `use(closure)` with the tables of the cases and their derivatives.
  template <Sides S, class Use>
  auto use_tables(const Use& use) const {
    const auto slopes = std::make_unique<TableSlopes<T, kDirections>>();
    for (std::size_t i = 0; i < kDirections; ++i) add_table_slope<S>(i, *slopes);
    return strut::use_tables<S, T>(at(), [&]<class C>(const TableClosure<T, C>& closure) {
      return use(TableClosure<D, C>{closure.tables, slopes.get()});
    });
  }

 private:
  static constexpr auto kWidth = static_cast<std::size_t>(kLaneCount<T>);

  void add_road_slope(std::size_t direction, RoadSlopes<T, kDirections>& slopes) const {
    std::array<const PreparedCase*, kWidth> above, below;
    T inverse_distance(0.0);
    bool moves = false;
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      const Neighbors& along = cases_[lane].along[direction];
      const bool is_given = along.above != nullptr;
      above[lane] = is_given ? along.above : at_[lane];
      below[lane] = is_given ? along.below : at_[lane];
      set_lane(inverse_distance, static_cast<int>(lane), is_given ? 1.0 / along.distance : 0.0);
      moves = moves || !have_equal_roads(*above[lane], *below[lane]);
    }
    if (!moves) return;
    slopes[direction] = std::make_unique<RoadNeighbors<T>>(RoadNeighbors<T>{
        pack_road<T>(above.data(), at()), pack_road<T>(below.data(), at()), inverse_distance});
  }

  template <Sides S>
  void add_table_slope(std::size_t direction, TableSlopes<T, kDirections>& slopes) const {
    const bool moves = std::any_of(cases_, cases_ + kWidth, [&](const DifferentiatedCase& c) {
      const Neighbors& along = c.along[direction];
      return along.above != nullptr &&
             !have_equal_tables(*along.above->mechanism, *along.below->mechanism);
    });
    if (!moves) return;
    slopes[direction] = std::make_unique<VehicleTables<T>>();
    VehicleTables<T>& packed = *slopes[direction];
    std::array<CornerCoefficients<double>, kWidth> lanes;
    for (int corner = 0; corner < kCorners; corner += kCornerStride<S>) {
      const auto get = [&](const PreparedCase& c) -> const CornerCoefficients<double>& {
        return c.mechanism->tables.corner[corner];
      };
      for (std::size_t lane = 0; lane < kWidth; ++lane) {
        const Neighbors& along = cases_[lane].along[direction];
        lanes[lane] = calc_slopes<CornerCoefficients>(along, get);
        if (along.above == nullptr) continue;
        for (const PreparedCase* c : {along.above, along.below}) {
          packed.degree[corner] =
              calc_larger(packed.degree[corner], c->mechanism->tables.degree[corner]);
        }
      }
      packed.corner[corner] = pack_lanes<CornerCoefficients, T>(lanes.data());
    }
  }

  const DifferentiatedCase* cases_;
  std::array<const PreparedCase*, kWidth> at_;
};

/// Starts of the cases with their derivatives.
template <class T>
State<DualLanes<T>> differentiate_starts(const DerivativeBatch<T>& batch) {
  using D = DualLanes<T>;
  Vehicle<D> vehicle = batch.template pack_vehicle<Sides::kBoth>();
  vehicle.layout.on_bump.fill(false);
  for (std::size_t c = 0; c < kCorners; ++c) {
    vehicle.numbers.drive_torque[c] = batch.pack([&](const PreparedCase& p) {
      return p.starts_driven ? p.vehicle.numbers.drive_torque[c] : 0.0;
    });
  }
  const D height = batch.pack([](const PreparedCase& c) { return c.mechanism->car.center_height; });
  const D speed = batch.pack([](const PreparedCase& c) { return c.start_speed; });
  State<D> start;
  for (std::size_t i = 0; i < start.size(); ++i) {
    start[i] = batch.pack([&](const PreparedCase& c) { return c.start[i]; });
  }
  batch.template use_tables<Sides::kBoth>([&]<class C>(const TableClosure<D, C>& closure) {
    differentiate_trim(TrimProblem<D, C>{&vehicle, closure, height, speed}, start);
    return 0;
  });
  return start;
}

/// run_derivatives with the corners of S computed.
template <Sides S, class T>
LaneResults run_derivative_sides(const DerivativeBatch<T>& batch, const IntegrateOptions& options,
                                 const SamplePlan& plan) {
  using D = DualLanes<T>;
  const State<D> all = differentiate_starts(batch);
  Vehicle<D> vehicle = batch.template pack_vehicle<S>();
  vehicle.road = pack_road<D>(batch.at(), batch.at());
  vehicle.road_slopes = batch.make_road_slopes();
  vehicle.road.center = batch.pack([](const PreparedCase& c) { return c.bump_center; });
  const D trigger = batch.pack([](const PreparedCase& c) { return c.trigger_x; });
  return batch.template use_tables<S>([&](const auto& closure) {
    using System = CarSystem<D, S>;
    System system(vehicle, closure, options.spin, trigger);
    std::array<D, System::kCapacity> start;
    for (std::size_t i = 0; i < start.size(); ++i) {
      start[i] = all[static_cast<std::size_t>(System::Layout::get(static_cast<int>(i)))];
    }
    system.start(start.data());
    LaneResults results = Simulation<D, System>(system, options.step, plan).run(start);
    complete_final_states<S>(results);
    return results;
  });
}

/// Runs and differentiates kLaneCount<T> cases.
template <class T>
LaneResults run_derivatives(const DifferentiatedCase* cases, const IntegrateOptions& options,
                            const SamplePlan& plan) {
  check_differentiated(cases, kLaneCount<T>, options);
  const DerivativeBatch<T> batch(cases);
  const SamplePlan all = make_lane_plan<T>(batch.at(), plan);
  return options.symmetry && is_symmetric(*cases[0].at)
             ? run_derivative_sides<Sides::kLeft>(batch, options, all)
             : run_derivative_sides<Sides::kBoth>(batch, options, all);
}

}  // namespace strut
