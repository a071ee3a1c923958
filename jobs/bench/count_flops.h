// How many floating-point operations one right-hand side takes, counted by running it.
#pragma once

#include "model/kernel/simulation.h"

namespace strut {

struct FlopCount {
  long arithmetic = 0;      // + - * / sqrt, one each
  long transcendental = 0;  // calls of sin, cos, atan, exp
  long comparison = 0;      // < min max abs select floor: not counted as operations
};

/// Counts one evaluation of the right-hand side of `c` at its start.
FlopCount count_flops(const PreparedCase& c, Closure closure);

}  // namespace strut
