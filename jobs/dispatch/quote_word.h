// Texts in scripts.
#pragma once

#include <string>

namespace strut {

/// One word of bash, whatever is in it.
inline std::string quote_word(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace strut
