// A sampled signal between its samples.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace strut {

/// Samples that an interpolation takes around its place: kBefore up to it, the rest behind.
struct ShiftStencil {
  static constexpr std::size_t kSamples = 6, kBefore = 3;
};

/// Lagrange's polynomial through samples at -2, ..., 3, at `u` of [0, 1): exact for polynomials of
/// degree 5, the error of sin(w t) at most 225/46080 (w dt)^6 at u = 1/2 (its remainder term).
std::array<double, ShiftStencil::kSamples> calc_shift_weights(double u);

/// Sum of their squares: the variance of white noise of variance 1 when read there, from 1 at u = 0
/// down to 0.71 at u = 1/2.
double calc_shift_gain(double u);

/// to[i] = the signal at place `begin` + i, counted in samples of `from`; begin >= 2. Throws
/// CheckError where a sample that it takes is not there.
void read_shifted(std::span<const double> from, double begin, std::span<double> to);

}  // namespace strut
