// Invariants of strut itself: a violation is a bug, not an error of the user or the machine.
#pragma once

#include <stdexcept>
#include <string>

namespace strut {

/// A violated invariant. The program ends with exit code 70 and asks for a bug report.
class CheckError : public std::logic_error {
  using std::logic_error::logic_error;
};

[[noreturn]] inline void fail_check(const char* condition, const std::string& what) {
  throw CheckError(what + " (check failed: " + condition + ")");
}

}  // namespace strut

/// Throws CheckError with `what` where `condition` is false; `what` is evaluated only then.
#define STRUT_CHECK(condition, what)                           \
  do {                                                         \
    if (!(condition)) ::strut::fail_check(#condition, (what)); \
  } while (false)
