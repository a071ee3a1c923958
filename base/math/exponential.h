// The phi functions of exponential integrators: phi_0 = exp z, phi_{k+1} = (phi_k - 1/k!) / z.
#pragma once

#include "base/math/lanes.h"

namespace strut {

/// phi_0..phi_4 at z <= 0.
template <class T>
struct PhiFunctions {
  T exponential, phi1, phi2, phi3, phi4;
};

/// For |z| < 1, Taylor series of phi_4 and downward recurrence; for larger |z|, the definition,
/// which loses only a few units in the last place there.
template <class T>
PhiFunctions<T> calc_phi(const T& z) {
  constexpr int kTerms = 17;
  double coefficient[kTerms];  // 1 / (k + 4)!
  double factorial = 24.0;
  for (int k = 0; k < kTerms; ++k) {
    coefficient[k] = 1.0 / factorial;
    factorial *= k + 5;
  }
  T series = T(coefficient[kTerms - 1]);
  for (int k = kTerms - 2; k >= 0; --k) series = series * z + T(coefficient[k]);

  const auto small = z > T(-1.0);
  const T inverse = T(1.0) / min(z, T(-1.0));
  const T large1 = (exp(z) - T(1.0)) * inverse;
  const T large2 = (large1 - T(1.0)) * inverse;
  const T large3 = (large2 - T(0.5)) * inverse;
  PhiFunctions<T> phi;
  phi.phi4 = select(small, series, (large3 - T(1.0 / 6.0)) * inverse);
  phi.phi3 = select(small, z * phi.phi4 + T(1.0 / 6.0), large3);
  phi.phi2 = select(small, z * phi.phi3 + T(0.5), large2);
  phi.phi1 = select(small, z * phi.phi2 + T(1.0), large1);
  phi.exponential = z * phi.phi1 + T(1.0);
  return phi;
}

}  // namespace strut
