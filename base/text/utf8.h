// Text that may hold any bytes, as names of files do.
#pragma once

#include <string>
#include <string_view>

namespace strut {

/// No code point: stands for a byte that is not part of valid UTF-8.
inline constexpr char32_t kNoCharacter = 0xffffffff;

/// Removes the first character from `text`, which is not empty, and returns its code point; where
/// there is none, removes one byte and returns kNoCharacter.
char32_t take_character(std::string_view& text);

/// Whether a terminal acts on the character rather than shows it: C0 controls, DEL, C1 controls,
/// Unicode's line separators and controls of the direction of writing.
bool is_control(char32_t code);

/// `text` as a terminal may show it: the bytes of control characters, except newline and tab, and
/// those that are not part of valid UTF-8 as \x1b.
std::string escape_controls(std::string_view text);

/// `text` with each byte that is no part of valid UTF-8 (RFC 3629) replaced by U+FFFD: JSON and
/// HTML hold nothing else.
std::string make_valid_utf8(std::string_view text);

}  // namespace strut
