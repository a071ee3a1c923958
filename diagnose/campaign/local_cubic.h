// Derivatives of noisy readings.
#pragma once

#include <span>
#include <vector>

namespace strut {

/// Value and derivatives of a smoothed curve, by time; NaN where too few readings are left.
struct SmoothCurve {
  std::vector<double> value, rate, second_rate;
};

/// At every time t the least-squares cubic through the readings within +- half_width of t, which
/// may be uneven or missing (A. Savitzky, M. J. E. Golay, Anal. Chem. 36 (1964), where they are
/// even). Errors: of the value and the second rate half_width^4 and half_width^2 times the fourth
/// derivative, of the rate half_width^4 times the fifth to leading order.
/// Within half a width of the ends there is nothing; with kOneSided there is a cubic everywhere, at
/// the ends and where a window holds too few readings by the nearest ones.
enum class CurveEnds { kNone, kOneSided };
SmoothCurve calc_local_cubic(std::span<const double> times, std::span<const double> values,
                             double half_width, CurveEnds ends = CurveEnds::kNone);

/// The widest half width [s] of local cubics that remove at most sigma / 10 (rms) of the signal
/// itself; 0 where even the narrowest remove more. What is removed beyond white noise `sigma` is
/// measured at the first width where it is clear, and falls with the fourth power of the width.
/// Even a little of it is coherent over thousands of readings and biases what is fitted to them. Of
/// an input whose rate drives forces, the noise of the rate falls as width^-1.5.
double choose_half_width(std::span<const double> times, std::span<const double> values,
                         double sigma);

/// 1 sigma of the second rate per 1 sigma of white noise in the readings, `count` of them every
/// `interval` s.
double calc_second_rate_gain(double half_width, double interval);

}  // namespace strut
