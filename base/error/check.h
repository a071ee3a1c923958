// Invariants of strut itself: a broken one is a bug, not the user's fault nor the machine's.
#pragma once

#include <stdexcept>
#include <string>

namespace strut {

/// The program ends with exit code 70 and asks for a report.
class CheckError : public std::logic_error {
  using std::logic_error::logic_error;
};

[[noreturn]] inline void fail_check(const char* condition, const std::string& what) {
  throw CheckError(what + " (check failed: " + condition + ")");
}

}  // namespace strut

/// Throws CheckError with `what` where `condition` does not hold; `what` is only made then.
#define STRUT_CHECK(condition, what)                           \
  do {                                                         \
    if (!(condition)) ::strut::fail_check(#condition, (what)); \
  } while (false)
