// The two ways in which a file can fail its reader or writer.
#pragma once

#include <stdexcept>

namespace strut {

/// The user's input is wrong: the message names file and line or key, the value, and what is
/// allowed. The program ends with exit code 2.
class InputError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The machine refuses: disk full, directory not writable, file unreadable. Nothing that was
/// complete before is lost. The program ends with exit code 3.
class EnvironmentError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace strut
