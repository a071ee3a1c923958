// Counts the floating-point operations of one right-hand side by evaluating it.
#pragma once

#include "model/kernel/simulation.h"

namespace strut {

struct FlopCount {
  long arithmetic = 0;      // flops: + - * / sqrt, one each
  long transcendental = 0;  // calls of sin, cos, atan, exp
  long comparison = 0;      // < min max abs select floor; not flops
};

/// Counts one evaluation of the right-hand side of `c` at its start state, of one side where these
/// options integrate one.
FlopCount count_flops(const PreparedCase& c, const IntegrateOptions& options);

}  // namespace strut
