// Interpolates a sampled signal between its samples.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace strut {

/// Number of samples that an interpolation uses, and of those at or before the interpolated time.
struct ShiftStencil {
  static constexpr std::size_t kSamples = 6, kBefore = 3;
};

/// Weights of the samples at -2, ..., 3 in the Lagrange polynomial at `u` in [0, 1): exact for
/// polynomials of degree 5; the error of sin(w t) is at most 225/46080 (w dt)^6, at u = 1/2 (the
/// remainder term).
std::array<double, ShiftStencil::kSamples> calc_shift_weights(double u);

/// Sum of the squared weights: the variance of interpolated white noise of variance 1, from 1 at
/// u = 0 down to 0.71 at u = 1/2.
double calc_shift_gain(double u);

/// to[i] = the signal `from` at `begin` + i, in samples; begin >= 2. Throws CheckError if this
/// needs a sample outside of the signal.
void read_shifted(std::span<const double> from, double begin, std::span<double> to);

}  // namespace strut
