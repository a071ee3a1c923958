// The two sources of a corner's motion functions: Newton on the loops, or the table.
//
// A closure c offers
//   c(corner, q, motion): all motion functions; returns the residual loop error [m]
//   c.place_wheel(corner, q, motion): wheel center and axis alone, for contact events
//   c.update_center_acceleration(corner, q, motion): center_qq, for output, after c(...)
#pragma once

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

template <class T, class C>
struct TableClosure {
  const VehicleTables<C>* tables;

  /// The loop error of a table is zero.
  T operator()(int corner, const T& q, CornerMotion<T>& motion) const {
    update_corner_motion(tables->corner[corner], tables->degree[corner], q, motion);
    return T(0.0);
  }
  void place_wheel(int corner, const T& q, CornerMotion<T>& motion) const {
    update_wheel_place(tables->corner[corner], tables->degree[corner], q, motion);
  }
  void update_center_acceleration(int corner, const T& q, CornerMotion<T>& motion) const {
    strut::update_center_acceleration(tables->corner[corner], tables->degree[corner], q, motion);
  }
};

}  // namespace strut
