// Interpolation of smooth functions by polynomials at Chebyshev nodes.
#pragma once

#include <vector>

namespace strut {

inline constexpr int kChebyshevNodes = 40;

/// Node i = 0..kChebyshevNodes-1 of the first kind on [-1, 1], in descending order.
double calc_chebyshev_node(int i);

/// Coefficients of T_0, T_1, ... of the interpolant through values at the nodes.
std::vector<long double> calc_chebyshev_series(const std::vector<double>& values);

/// Coefficients of 1, x, x^2, ... of the series truncated after T_degree.
std::vector<long double> convert_to_powers(const std::vector<long double>& series, int degree);

/// Minimum degree beyond which every coefficient is below tolerance * max(largest, floor).
int find_degree(const std::vector<long double>& series, long double tolerance, long double floor);

}  // namespace strut
