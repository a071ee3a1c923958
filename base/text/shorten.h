// Shortening of texts from files for messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace strut {

/// Maximum number of bytes of a value that a message quotes.
inline constexpr std::size_t kMaxQuoted = 80;

/// Replaces the middle of a `text` of more than `max_bytes` >= 3 by "..."; no UTF-8 character is
/// cut in two.
std::string shorten(std::string_view text, std::size_t max_bytes = kMaxQuoted);

}  // namespace strut
