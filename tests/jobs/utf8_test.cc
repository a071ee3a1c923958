// Valid UTF-8 of any bytes.
#include "base/text/utf8.h"

#include <array>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "io/format/json.h"
#include "report/html.h"

namespace strut {
namespace {

const std::string kMark = "\xef\xbf\xbd";

TEST_CASE("What is valid UTF-8 stays", "[unit]") {
  for (const std::string text :
       {"", "plain", "\xc2\xa0", "\xdf\xbf", "\xe0\xa0\x80", "\xe2\x82\xac", "\xed\x9f\xbf",
        "\xee\x80\x80", "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf",
        "a\xc3\xa9z\xf0\x9f\x9a\x97!"}) {
    CHECK(make_valid_utf8(text) == text);
  }
  CHECK(make_valid_utf8(std::string("a\0b", 3)) == std::string("a\0b", 3));
}

TEST_CASE("Bytes that are no character become U+FFFD, those about them stay", "[unit]") {
  CHECK(make_valid_utf8("caf\xe9.csv") == "caf" + kMark + ".csv");  // Latin-1
  CHECK(make_valid_utf8("\x80") == kMark);
  CHECK(make_valid_utf8("a\xc3") == "a" + kMark);                               // cut off
  CHECK(make_valid_utf8("\xe2\x82") == kMark + kMark);                          // cut off
  CHECK(make_valid_utf8("\xc0\xaf/") == kMark + kMark + "/");                   // overlong
  CHECK(make_valid_utf8("\xe0\x9f\xbf") == kMark + kMark + kMark);              // overlong
  CHECK(make_valid_utf8("\xf0\x8f\xbf\xbf") == kMark + kMark + kMark + kMark);  // overlong
  CHECK(make_valid_utf8("\xed\xa0\x80") == kMark + kMark + kMark);              // a surrogate
  CHECK(make_valid_utf8("\xf4\x90\x80\x80") == kMark + kMark + kMark + kMark);  // beyond U+10FFFF
  CHECK(make_valid_utf8("\xf5") == kMark);
  CHECK(make_valid_utf8("\xe2\x28\xa1") == kMark + "(" + kMark);
}

/// Whether the bits of `bytes` are one character by table 3-7 of the Unicode standard.
bool is_character(const std::vector<unsigned>& bytes) {
  const unsigned lead = bytes[0];
  const std::size_t length = lead < 0x80 ? 1 : lead >> 5 == 6 ? 2 : lead >> 4 == 14 ? 3 : 4;
  if (length != bytes.size() || (lead >= 0x80 && lead < 0xc0) || lead >= 0xf8) return false;
  unsigned code = length == 1 ? lead : lead & (0x7fU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if (bytes[i] >> 6 != 2) return false;
    code = code << 6 | (bytes[i] & 0x3f);
  }
  constexpr std::array<unsigned, 4> kLeast = {0, 0x80, 0x800, 0x10000};
  return code >= kLeast[length - 1] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff);
}

TEST_CASE("A character is valid where its code point is", "[unit][property]") {
  const std::array<unsigned, 10> next = {0x28, 0x7f, 0x80, 0x8f, 0x90,
                                         0x9f, 0xa0, 0xbf, 0xc0, 0xff};
  const auto check = [](const std::vector<unsigned>& bytes) {
    const std::string text(bytes.begin(), bytes.end());
    return (make_valid_utf8(text) == text) == is_character(bytes);
  };
  for (unsigned lead = 0; lead < 256; ++lead) {
    CAPTURE(lead);
    CHECK(check({lead}));
    if (lead < 0x80) continue;  // another character follows
    for (const unsigned b : next) {
      CHECK(check({lead, b}));
      for (const unsigned c : next) {
        // A shorter character and what is a whole one again are two.
        if (lead >= 0xe0) CHECK(check({lead, b, c}));
        if (lead >= 0xf0) {
          for (const unsigned d : next) CHECK(check({lead, b, c, d}));
        }
      }
    }
  }
}

TEST_CASE("JSON and HTML hold names of files in any encoding as valid text", "[unit]") {
  CHECK(format_json("caf\xe9") == "\"caf\\ufffd\"");
  CHECK(escape_html("<caf\xe9>") == "&lt;caf" + kMark + "&gt;");
}

}  // namespace
}  // namespace strut
