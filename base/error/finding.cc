#include "base/error/finding.h"

#include <array>

namespace strut {

const char* get_name(Health health) {
  constexpr std::array<const char*, 3> kNames = {"good", "warning", "bad"};  // by Health
  return kNames[static_cast<std::size_t>(health)];
}

}  // namespace strut
