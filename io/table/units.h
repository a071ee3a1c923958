// Units of measured files and their conversion to SI: no other part of strut computes with
// quantities that are not SI.
#pragma once

#include <string>
#include <string_view>

namespace strut {

/// SI value = factor * value + offset.
struct UnitScale {
  double factor = 1.0, offset = 0.0;
};

/// Converts the cells of a column to SI.
struct ColumnConversion {
  UnitScale unit;
  double factor = 1.0, offset = 0.0;

  double convert(double value) const {
    return factor * (unit.factor * value + unit.offset) + offset;
  }
};

/// Returns the spelling of `unit` that the table of units has: "m/s²", "m/s2" and "m/s/s" as
/// "m/s^2", "°" as "deg", "sec" as "s". Other texts are returned without blanks at both ends.
std::string normalize_unit(std::string_view unit);

/// Whether a unit converts to one of the SI units of channels, in any of its spellings.
bool is_known_unit(std::string_view unit);

/// Longer texts are no known unit, in whatever spelling [bytes].
inline constexpr std::size_t kMaxUnitLength = 64;

/// The conversion from a file's `unit` to `si`, the unit of a channel ("m", "m/s^2", "N", "K",
/// ...). An empty unit is SI. Throws InputError with the allowed units and the nearest.
UnitScale find_unit_scale(std::string_view unit, const std::string& si);

/// The unit of this SI value: "mm" for m and 1e-3; "0.5 m" where none is.
std::string name_unit(const std::string& si, double factor);

/// The unit whose numbers are `ratio` times those in SI, within a third: "mm" for m and 1000, "m"
/// for m and 1; "" if there is none.
std::string guess_unit(const std::string& si, double ratio);

}  // namespace strut
