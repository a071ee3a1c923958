// Simulation of one batch of cases, for any lane type. Only the kernels of the instruction sets
// include this.
#pragma once

#include <algorithm>

#include "model/car/trim_lanes.h"
#include "model/kernel/simulation.h"

namespace strut {

inline CornerDegrees calc_larger(const CornerDegrees& a, const CornerDegrees& b) {
  return {std::max(a.moment, b.moment), std::max(a.inertia, b.inertia), std::max(a.place, b.place),
          std::max(a.rate, b.rate)};
}

/// Tables with the coefficients of W mechanisms.
template <class T>
VehicleTables<T> pack_tables(const PreparedCase* const* cases) {
  VehicleTables<T> packed;
  packed.half_travel = cases[0]->mechanism->tables.half_travel;
  std::array<CornerCoefficients<double>, static_cast<std::size_t>(kLaneCount<T>)> lanes;
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int lane = 0; lane < kLaneCount<T>; ++lane) {
      const VehicleTables<double>& tables = cases[lane]->mechanism->tables;
      lanes[static_cast<std::size_t>(lane)] = tables.corner[corner];
      packed.degree[corner] = calc_larger(packed.degree[corner], tables.degree[corner]);
    }
    packed.corner[corner] = pack_lanes<CornerCoefficients, T>(lanes.data());
  }
  return packed;
}

/// Predictors of W cars.
template <class T>
VehiclePredictors<T> pack_predictors(const PreparedCase* const* cases) {
  VehiclePredictors<T> packed;
  for (std::size_t corner = 0; corner < packed.size(); ++corner) {
    packed[corner].half_travel = cases[0]->vehicle.layout.predictor[corner].half_travel;
    for (int lane = 0; lane < kLaneCount<T>; ++lane) {
      const auto& own = cases[lane]->vehicle.layout.predictor[corner].coefficient;
      for (std::size_t i = 0; i < own.size(); ++i) {
        for (std::size_t d = 0; d < own[i].size(); ++d) {
          set_lane(packed[corner].coefficient[i][d], lane, own[i][d]);
        }
      }
    }
  }
  return packed;
}

/// Adds the parts that a lane needs to the layout of the batch; they are neutral in other lanes.
inline void add_parts(const VehicleLayout& lane, VehicleLayout& batch) {
  batch.tire_parts = batch.tire_parts | lane.tire_parts;
  for (int c = 0; c < kCorners; ++c) batch.strut_effects[c] |= lane.strut_effects[c];
  for (int axle = 0; axle < kAxles; ++axle) {
    batch.has_anti_roll_bar[axle] = batch.has_anti_roll_bar[axle] || lane.has_anti_roll_bar[axle];
  }
  batch.progressive_tire = batch.progressive_tire || lane.progressive_tire;
  batch.has_runout = batch.has_runout || lane.has_runout;
  batch.has_lift = batch.has_lift || lane.has_lift;
}

template <class T>
Vehicle<T> pack_vehicle(const PreparedCase* const* cases) {
  constexpr auto kWidth = static_cast<std::size_t>(kLaneCount<T>);
  std::vector<VehicleParameters<double>> numbers(kWidth);
  std::array<const CornerForceMaps*, kWidth> maps;
  for (std::size_t lane = 0; lane < kWidth; ++lane) {
    numbers[lane] = cases[lane]->vehicle.numbers;
    maps[lane] = &cases[lane]->force_maps;
  }
  VehicleLayout layout = cases[0]->vehicle.layout;
  for (std::size_t lane = 1; lane < kWidth; ++lane) {
    add_parts(cases[lane]->vehicle.layout, layout);
  }
  Vehicle<T> vehicle{layout, pack_lanes<VehicleParameters, T>(numbers.data()), {}, {}};
  fill_strut_elements(vehicle, maps.data());
  return vehicle;
}

template <class T>
Road<T> pack_road(const PreparedCase* const* cases) {
  constexpr auto kWidth = static_cast<std::size_t>(kLaneCount<T>);
  std::array<const Surface*, kWidth> surfaces;
  std::array<double, kWidth> centers;
  for (std::size_t lane = 0; lane < kWidth; ++lane) {
    surfaces[lane] = &cases[lane]->mechanism->surface;
    centers[lane] = cases[lane]->bump_center;
  }
  Road<T> road = make_road<T>(surfaces.data(), centers.data());
  for (std::size_t side = 0; side < 2; ++side) {
    std::array<const RoughTrack*, kWidth> tracks;
    for (std::size_t lane = 0; lane < kWidth; ++lane) tracks[lane] = &cases[lane]->rough[side];
    road.rough[side] = make_rough_tracks<T>(tracks.data());
  }
  return road;
}

/// Whether all lanes have the same linkages: tables and predictors.
template <class T>
bool have_equal_cars(const PreparedCase* const* cases) {
  return std::all_of(cases, cases + kLaneCount<T>, [&](const PreparedCase* c) {
    return have_equal_tables(*cases[0]->mechanism, *c->mechanism);
  });
}

/// `use(closure)` with the tables of these cases.
template <class T, class Use>
auto use_tables(const PreparedCase* const* cases, const Use& use) {
  if (have_equal_cars<T>(cases)) {
    return use(TableClosure<T, double>{&cases[0]->mechanism->tables});
  }
  const auto tables = std::make_unique<VehicleTables<T>>(pack_tables<T>(cases));
  return use(TableClosure<T, T>{tables.get()});
}

/// Finds the starts of kLaneCount<T> cases that may share lanes; bit i of the result: of case i.
template <class T>
unsigned find_starts(PreparedCase* const* cases) {
  Vehicle<T> vehicle = pack_vehicle<T>(cases);
  vehicle.layout.on_bump.fill(false);
  T height(0.0), speed(0.0);
  for (int lane = 0; lane < kLaneCount<T>; ++lane) {
    const PreparedCase& c = *cases[lane];
    set_lane(height, lane, c.mechanism->car.center_height);
    set_lane(speed, lane, c.start_speed);
    for (T& torque : vehicle.numbers.drive_torque) {
      if (!c.starts_driven) set_lane(torque, lane, 0.0);
    }
  }
  const LaneTrim<T> trim = use_tables<T>(cases, [&]<class C>(const TableClosure<T, C>& closure) {
    return LaneTrimmer<T, C>({&vehicle, closure, height, speed}).solve();
  });
  unsigned found = 0;
  for (int lane = 0; lane < kLaneCount<T>; ++lane) {
    if (!get_mask_lane(trim.is_found(), lane)) continue;
    found |= 1U << static_cast<unsigned>(lane);
    for (std::size_t i = 0; i < trim.state.size(); ++i) {
      cases[lane]->start[i] = get_lane(trim.state[i], lane);
    }
  }
  return found;
}

template <class T, class Closure>
LaneResults run_system(const Vehicle<T>& vehicle, const Closure& closure, const T& trigger,
                       const std::array<T, StateIndex::kCount>& start,
                       const IntegrateOptions& options, const SamplePlan& plan) {
  CarSystem<T> system(vehicle, closure, options.spin, trigger);
  system.start(start.data());
  return Simulation<T, CarSystem<T>>(system, options.step, plan).run(start);
}

/// Runs kLaneCount<T> cases. Throws ModelError unless all may share lanes with the first.
template <class T>
LaneResults run_cases(const PreparedCase* const* cases, const IntegrateOptions& options,
                      const SamplePlan& plan) {
  for (int lane = 1; lane < kLaneCount<T>; ++lane) {
    if (!may_share_lanes(*cases[0], *cases[lane], options.closure)) {
      throw ModelError("lanes: these cases may not share a batch (see may_share_lanes)");
    }
  }
  Vehicle<T> vehicle = pack_vehicle<T>(cases);
  vehicle.road = pack_road<T>(cases);
  State<T> start;
  T trigger(0.0);
  for (int lane = 0; lane < kLaneCount<T>; ++lane) {
    for (std::size_t i = 0; i < start.size(); ++i) set_lane(start[i], lane, cases[lane]->start[i]);
    set_lane(trigger, lane, cases[lane]->trigger_x);
  }
  SamplePlan all = plan;
  all.duration = cases[0]->duration;
  all.channel_count = CarChannel::kCount;
  if (options.closure == Closure::kNewton && have_equal_cars<T>(cases)) {
    return run_system<T>(vehicle, NewtonClosure<T>{&vehicle.layout, &vehicle.numbers}, trigger,
                         start, options, all);
  }
  if (options.closure == Closure::kNewton) {
    const auto predictors = std::make_unique<VehiclePredictors<T>>(pack_predictors<T>(cases));
    return run_system<T>(vehicle,
                         NewtonClosure<T, T>{&vehicle.layout, &vehicle.numbers, predictors.get()},
                         trigger, start, options, all);
  }
  return use_tables<T>(cases, [&](const auto& closure) {
    return run_system<T>(vehicle, closure, trigger, start, options, all);
  });
}

}  // namespace strut
