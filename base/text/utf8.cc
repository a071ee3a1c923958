#include "base/text/utf8.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace strut {
namespace {

/// Range of lead bytes of one length, and the range of the byte that follows them, which excludes
/// overlong forms, surrogates and code points beyond U+10FFFF.
struct Lead {
  unsigned char first, last, next_low, next_high;
  std::size_t length;
};

constexpr std::array<Lead, 9> kLeads = {{{0x00, 0x7f, 0x80, 0xbf, 1},
                                         {0xc2, 0xdf, 0x80, 0xbf, 2},
                                         {0xe0, 0xe0, 0xa0, 0xbf, 3},
                                         {0xe1, 0xec, 0x80, 0xbf, 3},
                                         {0xed, 0xed, 0x80, 0x9f, 3},
                                         {0xee, 0xef, 0x80, 0xbf, 3},
                                         {0xf0, 0xf0, 0x90, 0xbf, 4},
                                         {0xf1, 0xf3, 0x80, 0xbf, 4},
                                         {0xf4, 0xf4, 0x80, 0x8f, 4}}};

/// Number of bytes of the character that the text starts with; 0 where it is not valid.
std::size_t measure_character(std::string_view text) {
  const auto get = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const auto* lead = std::find_if(kLeads.begin(), kLeads.end(), [&](const Lead& l) {
    return l.first <= get(0) && get(0) <= l.last;
  });
  if (lead == kLeads.end() || text.size() < lead->length) return 0;
  if (lead->length > 1 && (get(1) < lead->next_low || get(1) > lead->next_high)) return 0;
  for (std::size_t i = 2; i < lead->length; ++i) {
    if (get(i) < 0x80 || get(i) > 0xbf) return 0;
  }
  return lead->length;
}

char32_t decode(std::string_view character) {
  constexpr unsigned char kLeadBits[] = {0x00, 0x7f, 0x1f, 0x0f, 0x07};  // by length
  char32_t code = static_cast<unsigned char>(character[0]) & kLeadBits[character.size()];
  for (const char c : character.substr(1)) code = code << 6U | (static_cast<unsigned>(c) & 0x3fU);
  return code;
}

void append_escaped(std::string& text, std::string_view bytes) {
  static constexpr char kHex[] = "0123456789abcdef";
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text.append("\\x").append({kHex[byte / 16], kHex[byte % 16]});
  }
}

}  // namespace

char32_t take_character(std::string_view& text) {
  const std::size_t length = measure_character(text);
  const char32_t code = length > 0 ? decode(text.substr(0, length)) : kNoCharacter;
  text.remove_prefix(std::max<std::size_t>(length, 1));
  return code;
}

bool is_control(char32_t code) {
  const auto lies_in = [code](char32_t first, char32_t last) {
    return first <= code && code <= last;
  };
  return code < 0x20 || lies_in(0x7f, 0x9f) || lies_in(0x2028, 0x202e) || lies_in(0x2066, 0x2069);
}

std::string escape_controls(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    std::string_view rest = text;
    const char32_t code = take_character(rest);
    const std::string_view bytes = text.substr(0, text.size() - rest.size());
    const bool is_shown =
        code == '\n' || code == '\t' || (code != kNoCharacter && !is_control(code));
    is_shown ? void(shown += bytes) : append_escaped(shown, bytes);
    text = rest;
  }
  return shown;
}

std::string make_valid_utf8(std::string_view text) {
  std::string valid;
  valid.reserve(text.size());
  while (!text.empty()) {
    std::string_view rest = text;
    const bool is_valid = take_character(rest) != kNoCharacter;
    valid += is_valid ? text.substr(0, text.size() - rest.size()) : "\xef\xbf\xbd";
    text = rest;
  }
  return valid;
}

}  // namespace strut
