// Exports a trained network as C source, for programs that link no library.
#pragma once

#include <string>

#include "train/model/model_file.h"

namespace strut {

enum class SourceKind {
  kHeader,  // static inline functions
  kSource,  // functions that the user declares
};

/// Returns source that is valid C99 and C++:
///
///   int strut_identify_NAME(const double in[N], double out[M]);
///
/// or, of a network over windows,
///
///   int strut_identify_NAME(const double *record, int samples, double out[M]);
///
/// writes `out`, allocates nothing, calls only tanh of math.h, and returns the sum of 1 if a value
/// of `in` is outside of the training range or NaN, and 2 if a value of `out` is out of range
/// (is_parameter_in_range); 0: all values are in range. Of windows also 4 if the record has its
/// best place at one of its ends, and 8 alone, without values, if it has too few samples. Further
/// functions return names, units, ranges and intervals. `name`: the last part of a C identifier.
std::string make_c_source(const TrainedModel& model, const std::string& name, SourceKind kind);

/// Converts `text` to the last part of a C identifier: replaces all but ASCII letters, digits and
/// `_` by `_`.
std::string make_c_name(const std::string& text);

}  // namespace strut
