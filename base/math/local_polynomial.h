// Smoothing and derivatives of noisy readings.
#pragma once

#include <span>
#include <vector>

namespace strut {

/// Smoothing by least-squares polynomials of `degree`, 1 to 7, through the readings within
/// +- half_width [s] of every time; half_width 0: none.
struct LocalPolynomial {
  double half_width = 0.0;
  int degree = 3;
};

/// Value and derivatives of a smoothed curve, by time; NaN where too few readings are left.
struct SmoothCurve {
  std::vector<double> value, rate, second_rate;
};

/// The readings may be uneven or missing (A. Savitzky, M. J. E. Golay, Anal. Chem. 36 (1964), where
/// they are even). Errors by an odd degree d: of the value and the second rate half_width^(d + 1)
/// and half_width^(d - 1) times derivative d + 1, of the rate half_width^(d + 1) times derivative
/// d + 2 to leading order.
/// Within half a width of the ends there is nothing; with kOneSided there is a polynomial
/// everywhere, at the ends and where a window holds too few readings by the nearest ones.
enum class CurveEnds { kNone, kOneSided };
SmoothCurve smooth(std::span<const double> times, std::span<const double> values,
                   const LocalPolynomial& by, CurveEnds ends = CurveEnds::kNone);

/// The local polynomials that leave the least noise in the rate, of those that remove at most
/// sigma / 10 (rms) of the signal itself; none where all remove more. What is removed beyond white
/// noise `sigma` is measured at the first width where it is clear, and falls with the power degree
/// + 1 of the width. Even a little of it is coherent over thousands of readings and biases what is
/// fitted to them. What is left of the noise runs through the simulation, where an effect that
/// smooths forces would seem to explain it.
LocalPolynomial choose_smoothing(std::span<const double> times, std::span<const double> values,
                                 double sigma);

/// 1 sigma of the second rate by local cubics per 1 sigma of white noise in the readings, which are
/// `interval` s apart.
double calc_second_rate_gain(double half_width, double interval);

}  // namespace strut
