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

/// Tables of the computed corners with the coefficients of W mechanisms.
template <Sides S, class T>
VehicleTables<T> pack_tables(const PreparedCase* const* cases) {
  VehicleTables<T> packed;
  packed.half_travel = cases[0]->mechanism->tables.half_travel;
  std::array<CornerCoefficients<double>, static_cast<std::size_t>(kLaneCount<T>)> lanes;
  for (int corner = 0; corner < kCorners; corner += kCornerStride<S>) {
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

template <Sides S, class T>
Vehicle<T> pack_vehicle(const PreparedCase* const* cases) {
  constexpr auto kWidth = static_cast<std::size_t>(kLaneCount<T>);
  std::vector<VehicleParameters<double>> numbers(kWidth);
  std::array<Pac2002<double>, kWidth> pacejka;
  std::array<const CornerForceMaps*, kWidth> maps;
  for (std::size_t lane = 0; lane < kWidth; ++lane) {
    numbers[lane] = cases[lane]->vehicle.numbers;
    pacejka[lane] = cases[lane]->vehicle.pacejka;
    maps[lane] = &cases[lane]->force_maps;
  }
  VehicleLayout layout = cases[0]->vehicle.layout;
  for (std::size_t lane = 1; lane < kWidth; ++lane) {
    add_parts(cases[lane]->vehicle.layout, layout);
  }
  Vehicle<T> vehicle{layout,
                     pack_lanes<VehicleParameters, T>(numbers.data()),
                     pack_lanes<Pac2002, T>(pacejka.data()),
                     {},
                     {}};
  fill_strut_elements<S>(vehicle, maps.data());
  return vehicle;
}

/// The roads of the cases, with the bumps where those of `places` have them.
template <class T>
Road<T> pack_road(const PreparedCase* const* cases, const PreparedCase* const* places) {
  constexpr auto kWidth = static_cast<std::size_t>(kLaneCount<T>);
  std::array<const Surface*, kWidth> surfaces;
  std::array<double, kWidth> centers;
  for (std::size_t lane = 0; lane < kWidth; ++lane) {
    surfaces[lane] = &cases[lane]->mechanism->surface;
    centers[lane] = places[lane]->bump_center;
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
template <Sides S, class T, class Use>
auto use_tables(const PreparedCase* const* cases, const Use& use) {
  if (have_equal_cars<T>(cases)) {
    return use(TableClosure<T, double>{&cases[0]->mechanism->tables});
  }
  const auto tables = std::make_unique<VehicleTables<T>>(pack_tables<S, T>(cases));
  return use(TableClosure<T, T>{tables.get()});
}

/// Finds the starts of kLaneCount<T> cases that may share lanes; bit i of the result: of case i.
template <class T>
unsigned find_starts(PreparedCase* const* cases) {
  Vehicle<T> vehicle = pack_vehicle<Sides::kBoth, T>(cases);
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
  const LaneTrim<T> trim =
      use_tables<Sides::kBoth, T>(cases, [&]<class C>(const TableClosure<T, C>& closure) {
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

/// Final states in the layout of StateIndex.
template <Sides S>
void complete_final_states(LaneResults& results) {
  if constexpr (S == Sides::kBoth) return;
  using Layout = SymmetricStateIndex;
  const auto lanes = static_cast<std::size_t>(results.lanes);
  const std::size_t size = results.final_state.size() / lanes;
  std::vector<double> all;
  std::size_t count = StateIndex::kCountWithoutRelaxation;
  if (size > Layout::kCountWithoutRelaxation) count = StateIndex::kCountWithoutStruts;
  if (size > Layout::kCountWithoutStruts) count = StateIndex::kCount;
  all.resize(count * lanes);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    State<double> x{};
    for (std::size_t i = 0; i < size; ++i) {
      x[static_cast<std::size_t>(Layout::kComponent[i])] = results.final_state[i * lanes + lane];
    }
    mirror_left_side(x.data());
    for (std::size_t i = 0; i < count; ++i) all[i * lanes + lane] = x[i];
  }
  results.final_state = std::move(all);
}

template <Sides S, class T, class Closure>
LaneResults run_system(const Vehicle<T>& vehicle, const Closure& closure, const T& trigger,
                       const PreparedCase* const* cases, const IntegrateOptions& options,
                       const SamplePlan& plan) {
  using System = CarSystem<T, S>;
  System system(vehicle, closure, options.spin, trigger);
  std::array<T, System::kCapacity> start;
  for (std::size_t i = 0; i < start.size(); ++i) {
    const auto component = static_cast<std::size_t>(System::Layout::get(static_cast<int>(i)));
    for (int lane = 0; lane < kLaneCount<T>; ++lane) {
      set_lane(start[i], lane, cases[lane]->start[component]);
    }
  }
  system.start(start.data());
  LaneResults results = Simulation<T, System>(system, options.step, plan).run(start);
  complete_final_states<S>(results);
  return results;
}

/// The plan with the durations of the cases.
template <class T>
SamplePlan make_lane_plan(const PreparedCase* const* cases, SamplePlan plan) {
  plan.duration = 0.0;
  for (int lane = 0; lane < kLaneCount<T>; ++lane) {
    plan.lane_durations.push_back(cases[lane]->duration);
    plan.duration = std::max(plan.duration, cases[lane]->duration);
  }
  plan.channel_count = CarChannel::kCount;
  return plan;
}

/// run_cases with the corners of S computed.
template <Sides S, class T>
LaneResults run_sides(const PreparedCase* const* cases, const IntegrateOptions& options,
                      const SamplePlan& plan) {
  Vehicle<T> vehicle = pack_vehicle<S, T>(cases);
  vehicle.road = pack_road<T>(cases, cases);
  T trigger(0.0);
  for (int lane = 0; lane < kLaneCount<T>; ++lane) {
    set_lane(trigger, lane, cases[lane]->trigger_x);
  }
  const SamplePlan all = make_lane_plan<T>(cases, plan);
  const auto run = [&](const auto& closure) {
    return run_system<S, T>(vehicle, closure, trigger, cases, options, all);
  };
  if (options.closure == Closure::kTable) return use_tables<S, T>(cases, run);
  if (have_equal_cars<T>(cases)) return run(NewtonClosure<T>{&vehicle.layout, &vehicle.numbers});
  const auto predictors = std::make_unique<VehiclePredictors<T>>(pack_predictors<T>(cases));
  return run(NewtonClosure<T, T>{&vehicle.layout, &vehicle.numbers, predictors.get()});
}

/// Runs kLaneCount<T> cases. Throws ModelError unless all may share lanes with the first.
template <class T>
LaneResults run_cases(const PreparedCase* const* cases, const IntegrateOptions& options,
                      const SamplePlan& plan) {
  for (int lane = 1; lane < kLaneCount<T>; ++lane) {
    if (!may_share_lanes(*cases[0], *cases[lane], options)) {
      throw ModelError("lanes: these cases may not share a batch (see may_share_lanes)");
    }
  }
  return options.symmetry && is_symmetric(*cases[0])
             ? run_sides<Sides::kLeft, T>(cases, options, plan)
             : run_sides<Sides::kBoth, T>(cases, options, plan);
}

}  // namespace strut
