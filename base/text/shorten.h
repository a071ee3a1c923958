// Texts from files in messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace strut {

/// Bytes of a value that a message quotes.
inline constexpr std::size_t kMaxQuoted = 80;

/// `text`, where it has more than `max_bytes`, with its middle replaced by "..."; no UTF-8
/// character is cut in two. max_bytes >= 3.
std::string shorten(std::string_view text, std::size_t max_bytes = kMaxQuoted);

}  // namespace strut
