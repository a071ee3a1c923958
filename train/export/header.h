// A trained network as C source, for users who link nothing.
#pragma once

#include <string>

#include "train/model/model_file.h"

namespace strut {

enum class SourceKind {
  kHeader,  // static inline functions
  kSource,  // functions to be declared elsewhere
};

/// Source in C99, which C++ takes too:
///
///   int strut_identify_NAME(const double in[N], double out[M]);
///
/// fills `out`, allocates nothing, calls nothing but tanh of math.h, and returns a bit mask: 1
/// where a value of `in` lies outside of the range trained on or is NaN, 2 where one of `out` is
/// outside as is_parameter_in_range says; 0: all is in range. Beside it functions that return
/// names, units, ranges and intervals. `name`: the end of a C identifier.
std::string make_c_source(const TrainedModel& model, const std::string& name, SourceKind kind);

/// `text` as the end of a C identifier: ASCII letters, digits and `_` stay, else `_`.
std::string make_c_name(const std::string& text);

}  // namespace strut
