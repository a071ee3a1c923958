// The one form of errors about a road's numbers.
#pragma once

#include <string>

namespace strut {

/// Throws ModelError "FIELD = VALUE is not allowed: ALLOWED" unless `ok`.
void require_road(bool ok, const std::string& field, double value, const std::string& allowed);

/// Throws likewise unless the value lies in [min, max], in `unit`.
void require_road_range(const std::string& field, double value, double min, double max,
                        const std::string& unit = "m");

}  // namespace strut
