// States of the model as states of the full-coordinate car.
#pragma once

#include "model/car/state.h"
#include "tests/reference/full_coordinate_car.h"

namespace strut::test {

inline reference::ReducedState to_reduced(const State<double>& x) {
  using I = StateIndex;
  reference::ReducedState r;
  for (int i = 0; i < 3; ++i) {
    r.position[i] = x[I::kPosition + i];
    r.velocity[i] = x[I::kVelocity + i];
    r.angular_velocity[i] = x[I::kAngularVelocity + i];
  }
  for (int i = 0; i < 4; ++i) r.quaternion[i] = x[I::kQuaternion + i];
  for (int c = 0; c < kCorners; ++c) {
    r.q[c] = x[I::kCorner + c];
    r.q_dot[c] = x[I::kCornerRate + c];
    r.spin[c] = x[I::kSpin + c];
  }
  return r;
}

}  // namespace strut::test
