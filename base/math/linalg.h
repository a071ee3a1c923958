// Small dense algebra over lanes: the 6 x 6 spatial system of a floating body, and the 3 x 3 system
// of one that moves in a plane.
#pragma once

#include <array>

#include "base/math/spatial.h"

namespace strut {

/// Symmetric N x N matrix, lower triangle by rows.
template <class T, std::size_t N>
struct SymmetricMatrix {
  std::array<T, N*(N + 1) / 2> lower;
  static constexpr std::size_t at(std::size_t row, std::size_t column) {
    return row * (row + 1) / 2 + column;
  }
};

/// [m I, -S~; S~, J]: inertia of a body of mass m, first moment S, inertia J about the origin.
template <class T>
SymmetricMatrix<T, 6> make_spatial_inertia(const T& mass, const Vec3<T>& moment,
                                           const Sym3<T>& inertia) {
  const T zero(0.0);
  const Vec3<T>& s = moment;
  const Sym3<T>& j = inertia;
  return {{mass,                          //
           zero, mass,                    //
           zero, zero, mass,              //
           zero, -s.z, s.y,  j.xx,        //
           s.z,  zero, -s.x, j.xy, j.yy,  //
           -s.y, s.x,  zero, j.xz, j.yz, j.zz}};
}

/// make_spatial_inertia for motion along x and z and rotation about y alone.
template <class T>
SymmetricMatrix<T, 3> make_planar_inertia(const T& mass, const Vec3<T>& moment,
                                          const Sym3<T>& inertia) {
  return {{mass,          //
           T(0.0), mass,  //
           moment.z, -moment.x, inertia.yy}};
}

/// a += scale c c^T.
template <class T, std::size_t N>
void add_rank_one(SymmetricMatrix<T, N>& a, const std::array<T, N>& c, const T& scale) {
  for (std::size_t row = 0; row < N; ++row) {
    const T scaled = scale * c[row];
    for (std::size_t column = 0; column <= row; ++column) {
      a.lower[a.at(row, column)] += scaled * c[column];
    }
  }
}

/// Solves a x = b for symmetric positive definite a by L D L^T; x replaces b, factors replace a.
template <class T, std::size_t N>
void solve_ldlt(SymmetricMatrix<T, N>& a, std::array<T, N>& b) {
  std::array<T, N> inverse_pivot;
  for (std::size_t k = 0; k < N; ++k) {
    inverse_pivot[k] = T(1.0) / a.lower[a.at(k, k)];
    for (std::size_t row = k + 1; row < N; ++row) {
      const T factor = a.lower[a.at(row, k)] * inverse_pivot[k];
      for (std::size_t column = k + 1; column <= row; ++column) {
        a.lower[a.at(row, column)] -= factor * a.lower[a.at(column, k)];
      }
      b[row] -= factor * b[k];
    }
  }
  for (std::size_t k = N; k-- > 0;) {
    b[k] *= inverse_pivot[k];
    for (std::size_t row = k + 1; row < N; ++row) {
      b[k] -= a.lower[a.at(row, k)] * inverse_pivot[k] * b[row];
    }
  }
}

/// Rows of an N x N matrix.
template <class T, int N>
using SquareMatrix = std::array<std::array<T, N>, N>;

/// Solves a x = b by elimination with the largest pivot of each column, chosen lane by lane; x
/// replaces b, factors replace a. Not finite where a is singular.
template <class T, std::size_t N>
void solve_pivoted(std::array<std::array<T, N>, N>& a, std::array<T, N>& b) {
  for (std::size_t k = 0; k < N; ++k) {
    for (std::size_t row = k + 1; row < N; ++row) {
      const auto larger = abs(a[row][k]) > abs(a[k][k]);
      if (!any(larger)) continue;
      const auto swap_where = [&](T& x, T& y) {
        const T kept = x;
        x = select(larger, y, x);
        y = select(larger, kept, y);
      };
      for (std::size_t column = k; column < N; ++column) swap_where(a[k][column], a[row][column]);
      swap_where(b[k], b[row]);
    }
    const T inverse = T(1.0) / a[k][k];
    for (std::size_t row = k + 1; row < N; ++row) {
      const T factor = a[row][k] * inverse;
      for (std::size_t column = k + 1; column < N; ++column) {
        a[row][column] -= factor * a[k][column];
      }
      b[row] -= factor * b[k];
    }
  }
  for (std::size_t k = N; k-- > 0;) {
    for (std::size_t column = k + 1; column < N; ++column) b[k] -= a[k][column] * b[column];
    b[k] = b[k] / a[k][k];
  }
}

}  // namespace strut
