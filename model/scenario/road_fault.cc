#include "model/scenario/road_fault.h"

#include <fmt/format.h>

#include "model/error/model_error.h"

namespace strut {

void require_road(bool ok, const std::string& field, double value, const std::string& allowed) {
  if (ok) return;
  throw ModelError(fmt::format("{} = {:g} is not allowed: {}", field, value, allowed),
                   ModelFault::kRoad);
}

void require_road_range(const std::string& field, double value, double min, double max,
                        const std::string& unit) {
  if (value >= min && value <= max) return;
  require_road(false, field, value, fmt::format("must lie in [{:g}, {:g}] {}", min, max, unit));
}

}  // namespace strut
