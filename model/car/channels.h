// Computes the channels of car_channels.h from a state and the workspace of the right-hand side.
#pragma once

#include "model/car/dynamics.h"
#include "model/channel/car_channels.h"

namespace strut {

/// Acceleration of the chassis-fixed point r [m/s^2], chassis axes, gravity not included.
template <class T>
Vec3<T> calc_point_acceleration(const T* x, const Workspace<T>& ws, const Vec3<T>& r) {
  const Vec3<T> v = get_vec3(x, StateIndex::kVelocity);
  const Vec3<T> w = get_vec3(x, StateIndex::kAngularVelocity);
  return ws.acceleration + cross(w, v) + cross(ws.angular_acceleration, r) + cross(w, cross(w, r));
}

template <class T>
void observe_body(const Vehicle<T>& vehicle, const T& t, const T* x, const Workspace<T>& ws,
                  T* out) {
  using I = StateIndex;
  using C = CarChannel;
  const Vec3<T> w = get_vec3(x, I::kAngularVelocity);
  const Vec3<T> velocity = ws.rotation * get_vec3(x, I::kVelocity);
  const Vec3<T> origin{T(0.0), T(0.0), T(0.0)};
  const Vec3<T> acceleration = ws.rotation * calc_point_acceleration(x, ws, origin);
  const T sin_pitch = -ws.rotation.x.z;
  const T cos_pitch = sqrt(T(1.0) - sin_pitch * sin_pitch);
  const T sin_roll = ws.rotation.y.z / cos_pitch, cos_roll = ws.rotation.z.z / cos_pitch;
  out[C::kTime] = t;
  out[C::kBodyPositionZ] = x[I::kPosition + 2];
  out[C::kBodyVelocityZ] = velocity.z;
  out[C::kBodyAccelerationZ] = acceleration.z;
  out[C::kPitchAngle] = atan(sin_pitch / cos_pitch);
  out[C::kPitchRate] = cos_roll * w.y - sin_roll * w.z;
  out[C::kRollAngle] = atan(sin_roll / cos_roll);
  out[C::kRollRate] = w.x + (sin_pitch / cos_pitch) * (sin_roll * w.y + cos_roll * w.z);
  out[C::kForwardPosition] = x[I::kPosition];
  out[C::kForwardSpeed] = velocity.x;
  const Vec3<T> gravity =
      transpose_times(ws.rotation, Vec3<T>{T(0.0), T(0.0), -vehicle.numbers.gravity});
  const Vec3<T> imu = calc_point_acceleration(x, ws, vehicle.numbers.imu) - gravity;
  out[C::kImuAccelerationX] = imu.x;
  out[C::kImuAccelerationY] = imu.y;
  out[C::kImuAccelerationZ] = imu.z;
  out[C::kImuRateX] = w.x;
  out[C::kImuRateY] = w.y;
  out[C::kImuRateZ] = w.z;
}

/// Needs motion.center_qq of the corner.
template <class T>
void observe_corner(const Vehicle<T>& vehicle, const T* x, const Workspace<T>& ws, int corner,
                    T* out) {
  using I = StateIndex;
  using C = CarChannel;
  const CornerMotion<T>& m = ws.motion[corner];
  const Vec3<T> w = get_vec3(x, I::kAngularVelocity);
  const T& rate = x[I::kCornerRate + corner];
  const Vec3<T> wheel = calc_point_acceleration(x, ws, m.center) +
                        T(2.0) * rate * cross(w, m.center_q) +
                        ws.corner_acceleration[corner] * m.center_q + rate * rate * m.center_qq;
  out[C::kWheelPositionZ] = x[I::kPosition + 2] + (ws.rotation * m.center).z;
  out[C::kWheelAccelerationZ] = (ws.rotation * wheel).z;
  out[C::kSuspensionDeflection] =
      vehicle.numbers.nominal_length[corner * kLines + kSpringLine] - m.length[kSpringLine];
  out[C::kSuspensionVelocity] = -rate * m.length_q[kSpringLine];
  out[C::kSpringForce] = ws.strut[corner].spring_force;
  out[C::kDamperForce] = ws.strut[corner].damper_force;
  out[C::kTireForceX] = ws.wrench[corner].fx;
  out[C::kTireForceY] = ws.wrench[corner].fy;
  out[C::kTireForceZ] = ws.contact[corner].load;
  out[C::kTireDeflection] = ws.contact[corner].deflection;
  out[C::kWheelSpeed] = x[I::kSpin + corner] - dot(m.axis, m.upright_rate) * rate - dot(m.axis, w);
}

/// Channels of a right corner that moves as the mirror image of the left one.
template <class T>
void mirror_corner(const T* left, T* right) {
  for (int i = 0; i < CarChannel::kCornerChannels; ++i) right[i] = left[i];
  right[CarChannel::kTireForceY] = -left[CarChannel::kTireForceY];
}

}  // namespace strut
