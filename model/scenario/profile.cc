// The bump shapes in closed form, and the natural cubic spline of a table.
#include "model/scenario/profile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace strut {
namespace {

constexpr double kPi = std::numbers::pi;

Jet calc_arc(double height, double length, double x) {
  const double radius = (0.25 * length * length + height * height) / (2.0 * height);
  // The slope of a semicircle is infinite at its ends; the bound makes it finite.
  const double rise = std::max(std::sqrt(std::max(radius * radius - x * x, 0.0)), 1e-9 * radius);
  return {height - x * x / (radius + rise), -x / rise, -radius * radius / (rise * rise * rise)};
}

Jet calc_half_sine(double height, double length, double x) {
  const double k = kPi / length;
  const double c = std::cos(k * x), s = std::sin(k * x);
  return {height * c, -height * k * s, -height * k * k * c};
}

Jet calc_cosine(double height, double length, double x) {
  const double k = kPi / length;  // H/2 (1 + cos 2kx) = H cos^2 kx, without cancellation
  const double c = std::cos(k * x), s = std::sin(k * x);
  return {height * c * c, -2.0 * height * k * s * c, 2.0 * height * k * k * (s * s - c * c)};
}

Profile make_smooth_profile(const RoadSpec& spec, Jet (*shape)(double, double, double)) {
  const double height = spec.height, length = spec.length;
  return {{-0.5 * length, 0.5 * length},
          [=](std::size_t, double x) { return shape(height, length, x); }};
}

Profile make_trapezoid(const RoadSpec& spec) {
  const double height = spec.height, half = 0.5 * spec.length, ramp = spec.ramp;
  const double slope = height / ramp;
  std::vector<double> ends{-half, -half + ramp, half - ramp, half};
  if (half - ramp < 1e-9) ends = {-half, 0.0, half};
  const std::size_t last = ends.size() - 2;
  return {ends, [=](std::size_t piece, double x) -> Jet {
            if (piece == 0) return {slope * (x + half), slope, 0.0};
            if (piece == last) return {slope * (half - x), -slope, 0.0};
            return {height, 0.0, 0.0};
          }};
}

/// Second derivatives at the points of the natural cubic spline (Thomas algorithm).
std::vector<double> solve_spline(const std::vector<double>& x, const std::vector<double>& z) {
  const std::size_t n = x.size();
  std::vector<double> moment(n, 0.0), ratio(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = x[i] - x[i - 1], after = x[i + 1] - x[i];
    const double bend = (z[i + 1] - z[i]) / after - (z[i] - z[i - 1]) / before;
    const double pivot = 2.0 * (before + after) - before * ratio[i - 1];
    ratio[i] = after / pivot;
    moment[i] = (6.0 * bend - before * moment[i - 1]) / pivot;
  }
  for (std::size_t i = n - 2; i > 0; --i) moment[i] -= ratio[i] * moment[i + 1];
  return moment;
}

Profile make_table_profile(const RoadSpec& spec) {
  std::vector<double> x = spec.table_x, z = spec.table_z;
  z.front() = z.back() = 0.0;
  const std::vector<double> moment = solve_spline(x, z);
  return {x, [x, z, moment](std::size_t i, double at) -> Jet {
            const double h = x[i + 1] - x[i], b = (at - x[i]) / h, a = 1.0 - b;
            const double left = moment[i] * h * h / 6.0, right = moment[i + 1] * h * h / 6.0;
            const double bend = (a * a * a - a) * left + (b * b * b - b) * right;
            const double tilt = (1.0 - 3.0 * a * a) * left + (3.0 * b * b - 1.0) * right;
            return {a * z[i] + b * z[i + 1] + bend, (z[i + 1] - z[i] + tilt) / h,
                    a * moment[i] + b * moment[i + 1]};
          }};
}

}  // namespace

Profile make_profile(const RoadSpec& spec) {
  if (spec.shape == BumpShape::kTable) return make_table_profile(spec);
  if (spec.shape == BumpShape::kNone || spec.height == 0.0) return {};
  if (spec.shape == BumpShape::kArc) return make_smooth_profile(spec, calc_arc);
  if (spec.shape == BumpShape::kHalfSine) return make_smooth_profile(spec, calc_half_sine);
  if (spec.shape == BumpShape::kCosine) return make_smooth_profile(spec, calc_cosine);
  return make_trapezoid(spec);
}

}  // namespace strut
