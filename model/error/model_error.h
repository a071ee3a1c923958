// The one error the model room throws: at its door, never inside a step.
#pragma once

#include <stdexcept>

namespace strut {

/// A vehicle that cannot be: the message names the field, its value and what is allowed.
class ModelError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace strut
