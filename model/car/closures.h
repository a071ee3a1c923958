// The two sources of a corner's motion functions: Newton on the loops, or the table.
//
// A closure c offers
//   c(corner, q, motion): all motion functions; returns the residual loop error [m]
//   c.place_wheel(corner, q, motion): wheel center and axis alone, for contact events
//   c.update_center_acceleration(corner, q, motion): center_qq, for output, after c(...)
#pragma once

#include <memory>

#include "base/math/dual.h"
#include "model/car/vehicle.h"
#include "model/multibody/corner_motion.h"
#include "model/multibody/corner_table.h"

namespace strut {

/// One Newton iteration from the predictor: the layout's (C = double, the same in all lanes), or of
/// one car per lane (C = T).
template <class T, class C = double>
struct NewtonClosure {
  const VehicleLayout* layout;
  const VehicleParameters<T>* numbers;
  const VehiclePredictors<C>* predictors = &layout->predictor;

  T operator()(int corner, const T& q, CornerMotion<T>& motion) const {
    const CornerTopology& topology = layout->corner[corner];
    const auto close = topology.kind == SuspensionKind::kMacPherson
                           ? &close_corner<kMacPhersonTree, T, C>
                           : &close_corner<kMultilinkTree, T, C>;
    return close(topology, (*predictors)[static_cast<std::size_t>(corner)],
                 numbers->geometry[corner], numbers->inertia[corner], q, motion);
  }
  void place_wheel(int corner, const T& q, CornerMotion<T>& motion) const {
    (*this)(corner, q, motion);
  }
  void update_center_acceleration(int, const T&, CornerMotion<T>&) const {}
};

/// Tables of one car (C = double, the same in all lanes) or of one car per lane (C = T).
template <class C>
struct VehicleTables {
  std::array<CornerCoefficients<C>, kCorners> corner;
  std::array<CornerDegrees, kCorners> degree{};
  double half_travel = 0.0;  // m, maximum |q| of the fit
};

/// Derivatives of tables along N directions; null where they do not change.
template <class T, std::size_t N>
using TableSlopes = std::array<std::unique_ptr<VehicleTables<T>>, N>;

template <class T, class C>
struct TableClosure {
  const VehicleTables<C>* tables;
  const TableSlopes<Passive<T>, kDirectionCount<T>>* slopes = nullptr;  // of duals only

  /// The loop error of a table is zero.
  T operator()(int corner, const T& q, CornerMotion<T>& motion) const {
    evaluate(corner, q, motion, [](auto&&... arguments) { update_corner_motion(arguments...); });
    return T(0.0);
  }
  void place_wheel(int corner, const T& q, CornerMotion<T>& motion) const {
    evaluate(corner, q, motion, [](auto&&... arguments) { update_wheel_place(arguments...); });
  }
  void update_center_acceleration(int corner, const T& q, CornerMotion<T>& motion) const {
    evaluate(corner, q, motion,
             [](auto&&... arguments) { strut::update_center_acceleration(arguments...); });
  }

 private:
  /// `update(coefficients, degrees, q, motion)` with the tables, and with their derivatives.
  template <class Update>
  void evaluate(int corner, const T& q, CornerMotion<T>& motion, const Update& update) const {
    update(tables->corner[corner], tables->degree[corner], q, motion);
    if constexpr (HasDerivatives<T>) {
      for (std::size_t i = 0; slopes != nullptr && i < slopes->size(); ++i) {
        if ((*slopes)[i] == nullptr) continue;
        const VehicleTables<Passive<T>>& moved = *(*slopes)[i];
        CornerMotion<Passive<T>> slope{};
        update(moved.corner[corner], moved.degree[corner], q.v, slope);
        add_slope(slope, i, motion);
      }
    }
  }
};

}  // namespace strut
