// Smoothing and derivatives of noisy readings.
#pragma once

#include <span>
#include <vector>

namespace strut {

/// Least-squares polynomials of `degree`, 1 to 7, through the readings within +- half_width [s] of
/// every time; half_width 0: no smoothing.
struct LocalPolynomial {
  double half_width = 0.0;
  int degree = 3;
};

/// Value and derivatives of a smoothed curve, by time; NaN where too few readings are left.
struct SmoothCurve {
  std::vector<double> value, rate, second_rate;
};

/// Whether there is nothing within half a width of the ends, or a polynomial everywhere: at the
/// ends that of the nearest whole window, and where a window holds too few readings one through the
/// nearest ones.
enum class CurveEnds { kNone, kOneSided };

/// Returns the local polynomials' values and derivatives at every time. The readings may be uneven
/// or missing (A. Savitzky, M. J. E. Golay, Anal. Chem. 36 (1964), where they are even). Errors in
/// the middle of a window, for an odd degree d: of the value and the second rate half_width^(d + 1)
/// and half_width^(d - 1) times derivative d + 1, of the rate half_width^(d + 1) times derivative
/// d + 2 to leading order. A half_width above half the record counts as that.
SmoothCurve calc_local_polynomial(std::span<const double> times, std::span<const double> values,
                                  const LocalPolynomial& by, CurveEnds ends = CurveEnds::kNone);

/// Returns the local polynomials that leave the least noise in the rate, over the whole record, of
/// those that remove at most sigma / 10 (rms) of the signal itself; none where all remove more.
/// The removed signal is measured at the first width where the residual clearly exceeds the white
/// noise `sigma`, or bounded at the widest; it falls with the power degree + 1 of the width. Even a
/// little of it is coherent over thousands of readings and biases a fit to them. Remaining noise
/// runs through the simulation, where an effect that smooths forces would seem to explain it.
LocalPolynomial choose_smoothing(std::span<const double> times, std::span<const double> values,
                                 double sigma);

/// 1 sigma of the second rate by local cubics per 1 sigma of white noise in the readings, which are
/// `interval` s apart.
double calc_second_rate_gain(double half_width, double interval);

}  // namespace strut
