// Errors of the user's input and of the environment.
#pragma once

#include <stdexcept>

namespace strut {

/// Invalid input: the message names file and line or key, the value, and what is allowed. The
/// program ends with exit code 2.
class InputError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A failure of the environment: disk full, directory not writable, file unreadable. Nothing that
/// was complete before is lost. The program ends with exit code 3.
class EnvironmentError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace strut
