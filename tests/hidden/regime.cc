#include "tests/hidden/regime.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace strut::hidden {

Regime make_regime(const std::string& name) {
  constexpr std::array<const char*, 3> kNames = {"exact", "sensors", "machine"};
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw std::invalid_argument("regime '" + name + "': must be exact, sensors or machine");
  }
  return static_cast<Regime>(found - kNames.begin());
}

}  // namespace strut::hidden
