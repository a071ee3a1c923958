#include "model/force/damper_curve.h"

#include <fmt/format.h>

#include <algorithm>

#include "model/error/model_error.h"

namespace strut {
namespace {

/// Slopes at the points: the harmonic mean of the neighboring secants, weighted by the intervals,
/// keeps the cubic monotone.
std::vector<double> calc_slopes(const DamperCurveSpec& spec) {
  const std::size_t n = spec.speed.size();
  const auto width = [&](std::size_t i) { return spec.speed[i + 1] - spec.speed[i]; };
  const auto secant = [&](std::size_t i) { return (spec.force[i + 1] - spec.force[i]) / width(i); };
  std::vector<double> slopes(n, 0.0);
  slopes.front() = secant(0);
  slopes.back() = secant(n - 2);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = secant(i - 1), after = secant(i);
    if (!(before * after > 0.0)) continue;
    const double a = 2.0 * width(i) + width(i - 1), b = width(i) + 2.0 * width(i - 1);
    slopes[i] = (a + b) / (a / before + b / after);
  }
  return slopes;
}

}  // namespace

void validate(const DamperCurveSpec& spec) {
  bool has_rest = false;
  for (std::size_t i = 0; i < spec.speed.size(); ++i) {
    has_rest = has_rest || (spec.speed[i] == 0.0 && spec.force[i] == 0.0);
    if (i == 0) continue;
    if (!(spec.speed[i] > spec.speed[i - 1])) {
      throw ModelError(fmt::format("damper curve: speed {:g} m/s after {:g} m/s: must increase",
                                   spec.speed[i], spec.speed[i - 1]));
    }
    if (!(spec.force[i] >= spec.force[i - 1])) {
      throw ModelError(
          fmt::format("damper curve: {:g} N at {:g} m/s after {:g} N: must not decrease",
                      spec.force[i], spec.speed[i], spec.force[i - 1]));
    }
  }
  if (spec.empty()) return;
  if (!has_rest || !(spec.force.front() < 0.0) || !(spec.force.back() > 0.0)) {
    throw ModelError(
        "damper curve: must have points of rebound (both numbers < 0), [0, 0], and compression "
        "(> 0); a force at rest is dry friction or gas_force");
  }
}

double calc_curve_rate(const DamperCurveSpec& spec) {
  double products = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < spec.speed.size(); ++i) {
    products += spec.speed[i] * spec.force[i];
    squares += spec.speed[i] * spec.speed[i];
  }
  return products / squares;
}

std::shared_ptr<const DamperCurve> make_damper_curve(const DamperCurveSpec& spec) {
  if (spec.empty()) return nullptr;
  validate(spec);
  const std::vector<double> slopes = calc_slopes(spec);
  const auto rest = std::find(spec.speed.begin(), spec.speed.end(), 0.0) - spec.speed.begin();
  DamperCurve curve{make_signal("damper curve", spec.speed, spec.force, slopes),
                    calc_curve_rate(spec), slopes.front(), slopes.back(),
                    slopes[static_cast<std::size_t>(rest)]};
  return std::make_shared<const DamperCurve>(std::move(curve));
}

}  // namespace strut
