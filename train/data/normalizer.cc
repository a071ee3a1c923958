#include "train/data/normalizer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace strut {

Normalizer::Normalizer(std::size_t columns)
    : low_(columns, std::numeric_limits<double>::infinity()),
      high_(columns, -std::numeric_limits<double>::infinity()) {}

Normalizer::Normalizer(std::vector<double> low, std::vector<double> high)
    : low_(std::move(low)), high_(std::move(high)) {}

void Normalizer::include(std::span<const double> rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t column = i % columns();
    low_[column] = std::min(low_[column], rows[i]);
    high_[column] = std::max(high_[column], rows[i]);
  }
}

std::size_t Normalizer::find_constant() const {
  std::size_t column = 0;
  while (column < columns() && low_[column] < high_[column]) ++column;
  return column;
}

void Normalizer::normalize(std::span<double> rows) const {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t column = i % columns();
    rows[i] = 2.0 * (rows[i] - low_[column]) / (high_[column] - low_[column]) - 1.0;
  }
}

void Normalizer::restore(std::span<double> rows) const {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t column = i % columns();
    rows[i] = low_[column] + 0.5 * (rows[i] + 1.0) * (high_[column] - low_[column]);
  }
}

double Normalizer::calc_excess(std::span<const double> x) const {
  double excess = 0.0;
  for (std::size_t column = 0; column < columns(); ++column) {
    const double width = high_[column] - low_[column];
    const double beyond = std::max(low_[column] - x[column], x[column] - high_[column]) / width;
    // A NaN enters and stays, since every comparison with it is false.
    if (std::isnan(beyond) || beyond > excess) excess = beyond;
  }
  return excess;
}

}  // namespace strut
