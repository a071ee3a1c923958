#include "jobs/utf8.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace strut {
namespace {

/// Lead bytes of one length, and what the byte after them may be: neither longer than need be, nor
/// surrogates, nor beyond U+10FFFF.
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

/// Bytes of the character that the text begins with; 0: it begins with none.
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

}  // namespace

std::string make_valid_utf8(std::string_view text) {
  std::string valid;
  valid.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = measure_character(text);
    valid += length > 0 ? text.substr(0, length) : std::string_view("\xef\xbf\xbd");
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return valid;
}

}  // namespace strut
