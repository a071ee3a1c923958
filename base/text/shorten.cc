#include "base/text/shorten.h"

namespace strut {
namespace {

/// Whether `text[i]` continues a character of UTF-8.
bool continues(std::string_view text, std::size_t i) {
  return (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
}

}  // namespace

std::string shorten(std::string_view text, std::size_t max_bytes) {
  constexpr std::string_view kGap = "...";
  constexpr std::size_t kMaxContinued = 3;  // continuation bytes of one character
  if (text.size() <= max_bytes) return std::string(text);
  const std::size_t kept = max_bytes - kGap.size();
  std::size_t head = kept - kept / 2, tail = text.size() - kept / 2;
  for (std::size_t i = 0; i < kMaxContinued && head > 0 && continues(text, head); ++i) --head;
  for (std::size_t i = 0; i < kMaxContinued && tail < text.size() && continues(text, tail); ++i) {
    ++tail;
  }
  return std::string(text.substr(0, head)).append(kGap).append(text.substr(tail));
}

}  // namespace strut
