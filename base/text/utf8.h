// Text of arbitrary bytes, such as file names.
#pragma once

#include <string>
#include <string_view>

namespace strut {

/// Not a code point; stands for a byte that is not part of valid UTF-8.
inline constexpr char32_t kNoCharacter = 0xffffffff;

/// Removes the first character from a non-empty `text` and returns its code point; where the text
/// does not start with a valid character, removes one byte and returns kNoCharacter.
char32_t take_character(std::string_view& text);

/// Whether a terminal acts on the character instead of showing it: C0 controls, DEL, C1 controls,
/// Unicode's line separators and bidirectional controls.
bool is_control(char32_t code);

/// Makes `text` safe to print on a terminal: writes control characters, except newline and tab, and
/// bytes that are not part of valid UTF-8 in the form \x1b.
std::string escape_controls(std::string_view text);

/// Replaces each byte that is not part of valid UTF-8 (RFC 3629) by U+FFFD, as JSON and HTML
/// require.
std::string make_valid_utf8(std::string_view text);

}  // namespace strut
