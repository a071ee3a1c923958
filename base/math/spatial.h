// Vectors, rotations and symmetric matrices of three dimensions over any scalar.
#pragma once

#include "base/math/lanes.h"

namespace strut {

template <class T>
struct Vec3 {
  T x, y, z;

  friend Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend Vec3 operator*(const T& s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Vec3 operator*(const Vec3& a, const T& s) { return s * a; }
  Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
  Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
  bool operator==(const Vec3&) const = default;
};

template <class T>
T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
T norm(const Vec3<T>& a) {
  return sqrt(dot(a, a));
}

template <class T>
Vec3<T> normalized(const Vec3<T>& a) {
  return (T(1.0) / norm(a)) * a;
}

/// The same vector in every lane.
template <class T>
Vec3<T> broadcast(const Vec3<double>& a) {
  return {T(a.x), T(a.y), T(a.z)};
}

/// 3 x 3 matrix by columns; as a rotation R_AB its columns are the axes of frame B in A.
template <class T>
struct Mat3 {
  Vec3<T> x, y, z;

  static Mat3 identity() {
    return {{T(1.0), T(0.0), T(0.0)}, {T(0.0), T(1.0), T(0.0)}, {T(0.0), T(0.0), T(1.0)}};
  }
  friend Vec3<T> operator*(const Mat3& m, const Vec3<T>& a) {
    return a.x * m.x + a.y * m.y + a.z * m.z;
  }
  friend Mat3 operator*(const Mat3& m, const Mat3& n) { return {m * n.x, m * n.y, m * n.z}; }
};

/// M^T a.
template <class T>
Vec3<T> transpose_times(const Mat3<T>& m, const Vec3<T>& a) {
  return {dot(m.x, a), dot(m.y, a), dot(m.z, a)};
}

/// Rotation by `angle` [rad] about the unit vector `axis` (Rodrigues).
template <class T>
Mat3<T> rotation_about(const Vec3<T>& axis, const T& angle) {
  T s, c;
  sin_cos(angle, s, c);
  const T k = T(1.0) - c;
  const T kxy = k * axis.x * axis.y, kxz = k * axis.x * axis.z, kyz = k * axis.y * axis.z;
  const T sx = s * axis.x, sy = s * axis.y, sz = s * axis.z;
  return {{k * axis.x * axis.x + c, kxy + sz, kxz - sy},
          {kxy - sz, k * axis.y * axis.y + c, kyz + sx},
          {kxz + sy, kyz - sx, k * axis.z * axis.z + c}};
}

/// Unit quaternion [w, x, y, z].
template <class T>
struct Quaternion {
  T w, x, y, z;
};

/// R_WB of a quaternion of any length > 0; a factor on the quaternion does not change the rotation.
template <class T>
Mat3<T> rotation_of(const Quaternion<T>& q) {
  const T s = T(2.0) / (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  const T xx = s * q.x * q.x, yy = s * q.y * q.y, zz = s * q.z * q.z;
  const T xy = s * q.x * q.y, xz = s * q.x * q.z, yz = s * q.y * q.z;
  const T wx = s * q.w * q.x, wy = s * q.w * q.y, wz = s * q.w * q.z;
  return {{T(1.0) - yy - zz, xy + wz, xz - wy},
          {xy - wz, T(1.0) - xx - zz, yz + wx},
          {xz + wy, yz - wx, T(1.0) - xx - yy}};
}

/// Symmetric 3 x 3 matrix.
template <class T>
struct Sym3 {
  T xx, yy, zz, xy, xz, yz;

  friend Sym3 operator+(const Sym3& a, const Sym3& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
  }
  friend Sym3 operator-(const Sym3& a, const Sym3& b) {
    return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz};
  }
  friend Sym3 operator*(const T& s, const Sym3& a) {
    return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.xz, s * a.yz};
  }
  friend Vec3<T> operator*(const Sym3& m, const Vec3<T>& a) {
    return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
            m.xz * a.x + m.yz * a.y + m.zz * a.z};
  }
  Sym3& operator+=(const Sym3& b) { return *this = *this + b; }
  bool operator==(const Sym3&) const = default;
};

/// a b^T + b a^T.
template <class T>
Sym3<T> symmetric_outer(const Vec3<T>& a, const Vec3<T>& b) {
  return {T(2.0) * a.x * b.x,    T(2.0) * a.y * b.y,    T(2.0) * a.z * b.z,
          a.x * b.y + a.y * b.x, a.x * b.z + a.z * b.x, a.y * b.z + a.z * b.y};
}

/// s I.
template <class T>
Sym3<T> isotropic(const T& s) {
  return {s, s, s, T(0.0), T(0.0), T(0.0)};
}

/// -(a~ b~ + b~ a~) = 2 (a.b) I - (a b^T + b a^T): twice the inertia form of a point, polarized.
template <class T>
Sym3<T> inertia_form(const Vec3<T>& a, const Vec3<T>& b) {
  return isotropic<T>(T(2.0) * dot(a, b)) - symmetric_outer(a, b);
}

/// R S R^T.
template <class T>
Sym3<T> rotate(const Mat3<T>& r, const Sym3<T>& s) {
  const Vec3<T> a = s * Vec3<T>{r.x.x, r.y.x, r.z.x};
  const Vec3<T> b = s * Vec3<T>{r.x.y, r.y.y, r.z.y};
  const Vec3<T> c = s * Vec3<T>{r.x.z, r.y.z, r.z.z};
  const Vec3<T> ra = r * a, rb = r * b, rc = r * c;
  return {ra.x, rb.y, rc.z, ra.y, ra.z, rb.z};
}

/// d/dphi (R S R^T) when R turns with angular rate w per unit phi: w~ S - S w~.
template <class T>
Sym3<T> rotation_rate(const Vec3<T>& w, const Sym3<T>& s) {
  const Vec3<T> cx = cross(w, Vec3<T>{s.xx, s.xy, s.xz});
  const Vec3<T> cy = cross(w, Vec3<T>{s.xy, s.yy, s.yz});
  const Vec3<T> cz = cross(w, Vec3<T>{s.xz, s.yz, s.zz});
  return {T(2.0) * cx.x, T(2.0) * cy.y, T(2.0) * cz.z, cy.x + cx.y, cz.x + cx.z, cz.y + cy.z};
}

/// Rigid-body velocity: v of the point at the frame origin, w angular velocity (or their rates per
/// unit of a generalized coordinate).
template <class T>
struct Twist {
  Vec3<T> v, w;

  friend Twist operator+(const Twist& a, const Twist& b) { return {a.v + b.v, a.w + b.w}; }
  friend Twist operator*(const T& s, const Twist& a) { return {s * a.v, s * a.w}; }
  Twist& operator+=(const Twist& b) { return *this = *this + b; }
  /// Velocity of the body-fixed point now at r.
  Vec3<T> at(const Vec3<T>& r) const { return v + cross(w, r); }
};

/// Motion cross product Z x_m b = [w x b_v + v x b_w ; w x b_w] (docs/theory.md, section 2).
template <class T>
Twist<T> motion_cross(const Twist<T>& z, const Twist<T>& b) {
  return {cross(z.w, b.v) + cross(z.v, b.w), cross(z.w, b.w)};
}

}  // namespace strut
