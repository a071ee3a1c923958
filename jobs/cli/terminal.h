// What a terminal can show: colors where the user has one and has not declined them.
#pragma once

#include <string>

namespace strut {

/// Whether the file descriptor is a terminal on which a line can be erased and written anew;
/// TERM=dumb and no TERM at all name one where it cannot.
bool is_live_terminal(int descriptor);

/// The same, and NO_COLOR is not set, or is empty (https://no-color.org).
bool shows_colors(int descriptor);

enum class Style { kRed, kBold, kDim };

/// The sequence with which a style begins, and the one that ends any.
const char* get_sequence(Style style);
inline constexpr const char* kPlainSequence = "\033[0m";

}  // namespace strut
