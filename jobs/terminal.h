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

/// `text` in that style where `descriptor` shows colors, as it is elsewhere.
std::string paint(const std::string& text, Style style, int descriptor);

}  // namespace strut
