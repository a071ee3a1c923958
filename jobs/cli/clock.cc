#include "jobs/cli/clock.h"

#include <chrono>

namespace strut {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace strut
