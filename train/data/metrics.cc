#include "train/data/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace strut {

Metrics calc_metrics(std::span<const double> reference, std::span<const double> predicted) {
  if (reference.empty() || reference.size() != predicted.size()) {
    throw std::invalid_argument("metrics: as many predictions as references, and at least one");
  }
  const auto count = static_cast<double>(reference.size());
  const double mean = std::accumulate(reference.begin(), reference.end(), 0.0) / count;
  Metrics metrics;
  double squares = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double error = std::abs(reference[i] - predicted[i]);
    // A NaN enters and stays, since every comparison with it is false.
    if (std::isnan(error) || error > metrics.largest_error) metrics.largest_error = error;
    metrics.mean_absolute_error += error / count;
    metrics.mean_absolute_percentage += 100.0 * error / std::abs(reference[i]) / count;
    squares += error * error;
    spread += (reference[i] - mean) * (reference[i] - mean);
  }
  metrics.rms_error = std::sqrt(squares / count);
  metrics.r2 = spread > 0.0 ? 1.0 - squares / spread : std::numeric_limits<double>::quiet_NaN();
  return metrics;
}

}  // namespace strut
