#include "diagnose/baseline/sensor_findings.h"

#include <fmt/format.h>

#include <cmath>

#include "base/math/normal.h"
#include "base/text/format_number.h"

namespace strut {

std::vector<SensorFinding> list_sensor_findings(const FitResult& fit) {
  std::vector<SensorFinding> findings;
  for (std::size_t i = 0; i < fit.unknowns.size(); ++i) {
    const Unknown& u = fit.unknowns[i];
    if (!is_sensor_tolerance(u) || u.run != kEveryRun) continue;
    const double value = fit.values[i], spread = kNormal95 * fit.widened.sigma[i];
    findings.push_back({u.name, u.unit, value, value - spread, value + spread, u.prior.sigma});
  }
  return findings;
}

std::string describe_sensor_findings(const FitResult& fit) {
  constexpr double kLarge = 2.0;
  std::string large;
  for (const SensorFinding& f : list_sensor_findings(fit)) {
    if (std::abs(f.value) < kLarge * f.tolerance) continue;
    large += fmt::format("{}{} {}{}", large.empty() ? "" : ", ", f.name,
                         format_significant(f.value, 2), f.unit == "1" ? "" : " " + f.unit);
  }
  return large.empty() ? "" : "errors of sensors of two tolerances or more: " + large;
}

}  // namespace strut
