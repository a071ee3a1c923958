#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/math/chebyshev.h"
#include "model/car/assemble.h"

namespace strut {
namespace {

constexpr std::size_t kFunctions = kTwiceFunctions + kOnceFunctions + kPlainFunctions;
/// Functions smaller than this (m, kg m, ...) are resolved to an absolute error instead.
constexpr long double kSmallFunction = 1e-3L;

using Series = std::vector<long double>;

/// Chebyshev series of all functions of a corner, in table order.
std::vector<Series> sample_corner(const AssembledVehicle& car, int corner) {
  const NewtonClosure<double> closure{&car.layout, &car.numbers};
  std::vector<std::vector<double>> values(kFunctions, std::vector<double>(kChebyshevNodes));
  for (int i = 0; i < kChebyshevNodes; ++i) {
    CornerMotion<double> motion;
    closure(corner, kHalfTravel * calc_chebyshev_node(i), motion);
    std::array<double, kTwiceFunctions> twice;
    std::array<double, kOnceFunctions> once;
    std::array<double, kPlainFunctions> plain;
    collect_functions(motion, twice, once, plain);
    std::size_t f = 0;
    const auto node = static_cast<std::size_t>(i);
    for (double v : twice) values[f++][node] = v;
    for (double v : once) values[f++][node] = v;
    for (double v : plain) values[f++][node] = v;
  }
  std::vector<Series> series;
  series.reserve(kFunctions);
  for (const auto& v : values) series.push_back(calc_chebyshev_series(v));
  return series;
}

int find_group_degree(const std::vector<Series>& series, std::size_t first, std::size_t count) {
  int degree = 0;
  for (std::size_t f = first; f < first + count; ++f) {
    degree = std::max(degree, find_degree(series[f], kTableTolerance, kSmallFunction));
  }
  if (degree < kTableTerms) return degree;
  throw ModelError(
      fmt::format("hardpoints: a corner's kinematics need a polynomial of degree {} over the "
                  "travel; allowed: at most {}",
                  degree, kTableTerms - 1));
}

/// Writes the power series in q of functions [first, first + N) into a group's coefficients.
template <std::size_t N>
void fill_group(const std::vector<Series>& series, std::size_t first, int degree, std::size_t begin,
                std::size_t count, std::array<std::array<double, N>, kTableTerms>& group) {
  for (std::size_t f = 0; f < count; ++f) {
    const Series power = convert_to_powers(series[first + f], degree);
    long double unit = 1.0L;
    for (std::size_t i = 0; i < power.size(); ++i, unit /= kHalfTravel) {
      group[i][begin + f] = static_cast<double>(power[i] * unit);
    }
  }
}

}  // namespace

VehicleTables<double> tabulate_corners(const AssembledVehicle& car) {
  VehicleTables<double> tables{};
  tables.half_travel = kHalfTravel;
  constexpr std::size_t kOnceBegin = kTwiceFunctions;
  constexpr std::size_t kPlainBegin = kTwiceFunctions + kOnceFunctions;
  constexpr std::size_t kInertia = kInertiaFunctions, kPlace = kOnceFunctions - kInertia;
  for (int c = 0; c < kCorners; ++c) {
    const std::vector<Series> series = sample_corner(car, c);
    CornerDegrees& degree = tables.degree[c];
    degree.moment = find_group_degree(series, 0, kTwiceFunctions);
    degree.inertia = find_group_degree(series, kOnceBegin, kInertia);
    degree.place = find_group_degree(series, kOnceBegin + kInertia, kPlace);
    degree.rate = find_group_degree(series, kPlainBegin, kPlainFunctions);
    CornerCoefficients<double>& table = tables.corner[c];
    fill_group(series, 0, degree.moment, 0, kTwiceFunctions, table.twice);
    fill_group(series, kOnceBegin, degree.inertia, 0, kInertia, table.once);
    fill_group(series, kOnceBegin + kInertia, degree.place, kInertia, kPlace, table.once);
    fill_group(series, kPlainBegin, degree.rate, 0, kPlainFunctions, table.plain);
  }
  return tables;
}

}  // namespace strut
