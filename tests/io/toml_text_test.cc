// Flattening TOML files, and replacing texts in them.
#include "io/format/toml_text.h"

#include <catch2/catch.hpp>

#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using test::TemporaryFolder;

TEST_CASE("Flattening depends on the values, not on their notation", "[unit][io]") {
  const TemporaryFolder folder;
  const auto one = folder.write("a.toml",
                                "# a comment\nmass = 1155.0\n[tire]\nfile = \"x.tir\"\n"
                                "[[rod]]\nname = 'a'\nplace = [1, 2.50]\n[[rod]]\nopen = true\n");
  const auto two = folder.write("b.toml",
                                "rod = [{ place = [1e0, 2.5], name = \"a\" }, { open = true }]\n"
                                "tire.file = 'x.tir'   # elsewhere\nmass = 1155\n");
  CHECK(flatten_toml(one) == TomlValues{{"mass", "1155"},
                                        {"rod[1].name", "a"},
                                        {"rod[1].place[1]", "1"},
                                        {"rod[1].place[2]", "2.5"},
                                        {"rod[2].open", "true"},
                                        {"tire.file", "x.tir"}});
  CHECK(flatten_toml(two) == flatten_toml(one));
}

TEST_CASE("Replacing a text changes no other byte", "[unit][io]") {
  const TemporaryFolder folder;
  const auto file = folder.write(
      "a.toml",
      "# Stra\xc3\x9f"
      "e, \"old\"\nvehicle  = \"old\"   # \"old\" too\r\n"
      "name = \"\xc3\xa9t\xc3\xa9\"\ntire = { note = \"\xc3\xa4\", file = 'o\"ld' }  # end\n");
  CHECK(replace_toml_texts(file, {{"tire.file", "b"}, {"vehicle", "a \"new\" \\ one\n"}}) ==
        "# Stra\xc3\x9f"
        "e, \"old\"\nvehicle  = \"a \\\"new\\\" \\\\ one\\u000A\"   # \"old\" too\r\n"
        "name = \"\xc3\xa9t\xc3\xa9\"\ntire = { note = \"\xc3\xa4\", file = \"b\" }  # end\n");
  CHECK_THROWS_AS(replace_toml_texts(file, {{"tire.size", "b"}}), InputError);
  CHECK_THROWS_AS(replace_toml_texts(file, {{"tire", "b"}}), InputError);
}

TEST_CASE("Texts are replaced after a byte order mark, by any bytes", "[unit][io]") {
  const TemporaryFolder folder;
  const auto file = folder.write("a.toml", "\xef\xbb\xbfname = \"old\"\n");
  CHECK(replace_toml_texts(file, {{"name", "new"}}) == "\xef\xbb\xbfname = \"new\"\n");
  std::string all;
  for (int c = 1; c < 0x80; ++c) all += static_cast<char>(c);
  folder.write("b.toml", replace_toml_texts(file, {{"name", all}}));
  CHECK(flatten_toml(folder / "b.toml") == TomlValues{{"name", all}});
}

}  // namespace
}  // namespace strut
