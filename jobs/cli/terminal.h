// Capabilities of a terminal: lines rewritten in place, and colors unless the user declines them.
#pragma once

#include <string>

namespace strut {

/// Whether the file descriptor is a terminal on which a line can be rewritten in place. False if
/// TERM is "dumb" or not set.
bool is_live_terminal(int descriptor);

/// The same, and NO_COLOR is unset or empty (https://no-color.org).
bool shows_colors(int descriptor);

enum class Style { kRed, kBold, kDim };

/// The escape sequence that starts a style, and the one that ends every style.
const char* get_sequence(Style style);
inline constexpr const char* kPlainSequence = "\033[0m";

}  // namespace strut
