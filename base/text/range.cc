#include "base/text/range.h"

#include <fmt/format.h>

#include <cmath>

#include "base/text/format_number.h"

namespace strut {

bool Range::contains(double value) const {
  return std::isfinite(value) && value <= high && (open_low ? value > low : value >= low);
}

std::string Range::describe() const {
  const std::string suffix = unit.empty() ? "" : " " + unit;
  if (std::isfinite(low) && std::isfinite(high)) {
    return fmt::format("must lie in {}{}, {}]{}", open_low ? "(" : "[", format_number(low),
                       format_number(high), suffix);
  }
  if (std::isfinite(low)) {
    return fmt::format("must be {} {}{}", open_low ? ">" : ">=", format_number(low), suffix);
  }
  if (std::isfinite(high)) return fmt::format("must be <= {}{}", format_number(high), suffix);
  return "must be a finite number" + (unit.empty() ? "" : " of " + unit);
}

Range between(double low, double high, const std::string& unit) { return {low, high, false, unit}; }

Range at_least(double low, const std::string& unit) { return {.low = low, .unit = unit}; }

Range above(double low, const std::string& unit) {
  return {.low = low, .open_low = true, .unit = unit};
}

Range any_number(const std::string& unit) { return {.unit = unit}; }

}  // namespace strut
