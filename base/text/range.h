// Allowed ranges of numbers and their wording in messages.
#pragma once

#include <limits>
#include <string>

namespace strut {

/// Allowed interval of a number; the bounds are included, except that `open_low` excludes `low`.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open_low = false;
  std::string unit;

  bool contains(double value) const;
  /// "must be > 0 kg", "must lie in [0, 1]".
  std::string describe() const;
};

Range between(double low, double high, const std::string& unit = "");
Range at_least(double low, const std::string& unit = "");
Range above(double low, const std::string& unit = "");
Range any_number(const std::string& unit = "");

}  // namespace strut
