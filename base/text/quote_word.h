// Quoting of texts for shell scripts and terminals.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>

#include "base/text/utf8.h"

namespace strut {

/// Quotes any text as one word of bash.
inline std::string quote_word(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// Whether the text has ASCII control characters, which end lines and steer terminals.
inline bool has_control_character(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20U || byte == 0x7fU;
  });
}

/// Quotes any text as one word of bash in visible ASCII: $'\033[31m'.
inline std::string escape_word(const std::string& word) {
  std::string escaped = "$'";
  for (const char c : word) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\'' || c == '\\') {
      escaped += {'\\', c};
    } else if (byte >= 0x20U && byte < 0x7fU) {
      escaped += c;
    } else {
      char octal[8];
      std::snprintf(octal, sizeof octal, "\\%03o", static_cast<unsigned>(byte));
      escaped += octal;
    }
  }
  return escaped + "'";
}

/// Quotes a text as one word of bash where it needs quotes, for output on one line of a terminal;
/// control characters are escaped.
inline std::string quote_if_needed(const std::string& word) {
  constexpr char kPlain[] =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:,+@%=-";
  const bool is_plain = !word.empty() && word.find_first_not_of(kPlain) == std::string::npos;
  if (is_plain) return word;
  const bool is_visible = !has_control_character(word) && escape_controls(word) == word;
  return is_visible ? quote_word(word) : escape_word(word);
}

}  // namespace strut
