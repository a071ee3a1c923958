#include "io/table/text_encoding.h"

#include "base/error/input_error.h"
#include "base/text/utf8.h"

namespace strut {
namespace {

constexpr std::string_view kLittleEndianMark = "\xFF\xFE", kBigEndianMark = "\xFE\xFF";

bool is_valid_utf8(std::string_view text) {
  while (!text.empty()) {
    if (take_character(text) == kNoCharacter) return false;
  }
  return true;
}

void append_utf8(std::string& text, char32_t code) {
  const auto add = [&](char32_t bits) { text += static_cast<char>(bits); };
  const auto add_rest = [&](unsigned shift) { add(0x80U | ((code >> shift) & 0x3fU)); };
  if (code < 0x80U) {
    add(code);
  } else if (code < 0x800U) {
    add(0xc0U | (code >> 6U));
    add_rest(0);
  } else if (code < 0x10000U) {
    add(0xe0U | (code >> 12U));
    add_rest(6);
    add_rest(0);
  } else {
    add(0xf0U | (code >> 18U));
    add_rest(12);
    add_rest(6);
    add_rest(0);
  }
}

}  // namespace

bool starts_as_utf16(std::istream& stream) {
  std::string mark(2, '\0');
  stream.read(mark.data(), 2);
  stream.clear();
  stream.seekg(0);
  return mark == kLittleEndianMark || mark == kBigEndianMark;
}

std::string convert_utf16(const std::filesystem::path& path, std::string_view bytes) {
  const auto fault = [&] { return InputError(path.string() + ": damaged UTF-16 text"); };
  if (bytes.size() % 2 != 0) throw fault();
  const std::size_t high = bytes.starts_with(kBigEndianMark) ? 0 : 1;
  const auto get = [&](std::size_t at) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(bytes[k]); };
    return static_cast<char32_t>((byte(at + high) << 8U) | byte(at + 1 - high));
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t at = 2; at < bytes.size(); at += 2) {
    char32_t code = get(at);
    const bool is_first_half = code >= 0xd800U && code < 0xdc00U;
    if (is_first_half) {
      at += 2;
      const char32_t second = at < bytes.size() ? get(at) : 0;
      if (second < 0xdc00U || second >= 0xe000U) throw fault();
      code = 0x10000U + ((code - 0xd800U) << 10U) + (second - 0xdc00U);
    } else if (code >= 0xdc00U && code < 0xe000U) {
      throw fault();
    }
    append_utf8(text, code);
  }
  return text;
}

std::string convert_latin1(std::string_view text) {
  if (is_valid_utf8(text)) return std::string(text);
  std::string converted;
  for (const char c : text) append_utf8(converted, static_cast<unsigned char>(c));
  return converted;
}

}  // namespace strut
