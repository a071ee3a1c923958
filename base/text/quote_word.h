// Texts in scripts.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>

#include "base/text/utf8.h"

namespace strut {

/// One word of bash, whatever is in it.
inline std::string quote_word(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// ASCII control characters: they end lines and steer terminals.
inline bool has_control_character(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20U || byte == 0x7fU;
  });
}

/// One word of bash in visible ASCII: $'\033[31m'.
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

/// One word of bash for people, in one line that leaves a terminal as it is: unquoted where bash
/// takes it so.
inline std::string quote_if_needed(const std::string& word) {
  constexpr char kPlain[] =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:,+@%=-";
  const bool is_plain = !word.empty() && word.find_first_not_of(kPlain) == std::string::npos;
  if (is_plain) return word;
  const bool is_visible = !has_control_character(word) && escape_controls(word) == word;
  return is_visible ? quote_word(word) : escape_word(word);
}

}  // namespace strut
