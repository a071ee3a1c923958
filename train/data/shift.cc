#include "train/data/shift.h"

#include <cmath>

#include "base/error/check.h"

namespace strut {

std::array<double, ShiftStencil::kSamples> calc_shift_weights(double u) {
  std::array<double, ShiftStencil::kSamples> weights{};
  for (std::size_t a = 0; a < weights.size(); ++a) {
    const double at = static_cast<double>(a) - 2.0;
    double weight = 1.0;
    for (double other = -2.0; other <= 3.0; other += 1.0) {
      if (other != at) weight *= (u - other) / (at - other);
    }
    weights[a] = weight;
  }
  return weights;
}

double calc_shift_gain(double u) {
  double gain = 0.0;
  for (const double weight : calc_shift_weights(u)) gain += weight * weight;
  return gain;
}

void read_shifted(std::span<const double> from, double begin, std::span<double> to) {
  const double whole = std::floor(begin);
  const double last = whole + static_cast<double>(to.size()) + 2.0;
  STRUT_CHECK(whole >= 2.0 && last < static_cast<double>(from.size()),
              "a shifted window reaches outside of its signal");
  const auto weights = calc_shift_weights(begin - whole);
  const double* first = from.data() + static_cast<std::size_t>(whole) - 2;
  for (std::size_t i = 0; i < to.size(); ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * first[i + k];
    to[i] = sum;
  }
}

}  // namespace strut
