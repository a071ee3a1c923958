#include "model/force/force_curve.h"

#include <fmt/format.h>

#include <algorithm>

#include "model/error/model_error.h"

namespace strut {
namespace {

/// Slopes at the points: the harmonic mean of the neighboring secants, weighted by the intervals,
/// keeps the cubic monotone.
std::vector<double> calc_slopes(const ForceCurveSpec& spec) {
  const std::size_t n = spec.x.size();
  const auto width = [&](std::size_t i) { return spec.x[i + 1] - spec.x[i]; };
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

/// Throws ModelError unless x increases; `what` and `unit` are those of the message.
void check_increasing(const ForceCurveSpec& spec, const char* what, const char* unit) {
  for (std::size_t i = 1; i < spec.x.size(); ++i) {
    if (spec.x[i] > spec.x[i - 1]) continue;
    throw ModelError(fmt::format("{} {:g} {} after {:g} {}: must increase", what, spec.x[i], unit,
                                 spec.x[i - 1], unit));
  }
}

}  // namespace

void validate_damper_curve(const ForceCurveSpec& spec) {
  if (spec.empty()) return;
  check_increasing(spec, "damper curve: speed", "m/s");
  bool has_rest = false;
  for (std::size_t i = 0; i < spec.x.size(); ++i) {
    has_rest = has_rest || (spec.x[i] == 0.0 && spec.force[i] == 0.0);
    if (i > 0 && !(spec.force[i] >= spec.force[i - 1])) {
      throw ModelError(
          fmt::format("damper curve: {:g} N at {:g} m/s after {:g} N: must not decrease",
                      spec.force[i], spec.x[i], spec.force[i - 1]));
    }
  }
  if (!has_rest || !(spec.force.front() < 0.0) || !(spec.force.back() > 0.0)) {
    throw ModelError(
        "damper curve: must have points of rebound (both numbers < 0), [0, 0], and compression "
        "(> 0); a force at rest is dry friction or gas_force");
  }
}

void validate_tire_curve(const ForceCurveSpec& spec) {
  if (spec.empty()) return;
  check_increasing(spec, "tire curve: deflection", "m");
  for (std::size_t i = 1; i < spec.x.size(); ++i) {
    if (spec.force[i] > spec.force[i - 1]) continue;
    throw ModelError(fmt::format("tire curve: {:g} N at {:g} m after {:g} N: must increase",
                                 spec.force[i], spec.x[i], spec.force[i - 1]));
  }
  if (spec.x.size() < 2 || spec.x.front() != 0.0 || spec.force.front() != 0.0) {
    throw ModelError("tire curve: must begin with [0, 0] and have two points or more");
  }
}

double calc_curve_rate(const ForceCurveSpec& spec) {
  double products = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < spec.x.size(); ++i) {
    products += spec.x[i] * spec.force[i];
    squares += spec.x[i] * spec.x[i];
  }
  return products / squares;
}

double calc_peak_slope_ratio(const ForceCurveSpec& spec) {
  if (spec.empty()) return 1.0;
  double steepest = 0.0;
  for (std::size_t i = 1; i < spec.x.size(); ++i) {
    steepest =
        std::max(steepest, (spec.force[i] - spec.force[i - 1]) / (spec.x[i] - spec.x[i - 1]));
  }
  constexpr double kCubicOverLine = 1.5;
  return kCubicOverLine * steepest / calc_curve_rate(spec);
}

std::shared_ptr<const ForceCurve> make_force_curve(const ForceCurveSpec& spec) {
  if (spec.empty()) return nullptr;
  const std::vector<double> slopes = calc_slopes(spec);
  const auto rest = std::find(spec.x.begin(), spec.x.end(), 0.0) - spec.x.begin();
  ForceCurve curve{make_signal("force curve", spec.x, spec.force, slopes), calc_curve_rate(spec),
                   slopes.front(), slopes.back(), slopes[static_cast<std::size_t>(rest)]};
  return std::make_shared<const ForceCurve>(std::move(curve));
}

}  // namespace strut
