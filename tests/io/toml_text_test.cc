// Flattening TOML files, and replacing texts in them.
#include "io/format/toml_text.h"

#include <catch2/catch.hpp>

#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using test::TemporaryFolder;
namespace fs = std::filesystem;

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

TEST_CASE("Values of a TOML file are set wherever its layout has them", "[io]") {
  const TemporaryFolder folder;
  struct Layout {
    const char *text, *key, *literal, *result;
  };
  const Layout layouts[] = {
      {"a = 1 # one\nb = 2\n", "a", "-0.25", "a = -0.25 # one\nb = 2\n"},
      {"a = \"x\"\n", "b", "3", "b = 3\na = \"x\"\n"},
      {"[t]\na = [1, 2] # c\n", "t.a", "\"all\"", "[t]\na = \"all\" # c\n"},
      {"[t] # c\na = 1\n", "t.b", "true", "[t] # c\nb = true\na = 1\n"},
      {"t = { a = 1 }\n", "t.b", "2", "t = { b = 2, a = 1 }\n"},
      {"[t]\nu = { a = 1, b = 2 }\n", "t.u.b", "5", "[t]\nu = { a = 1, b = 5 }\n"},
      {"a = 1\n", "t.b", "2", "a = 1\n\n[t]\nb = 2\n"},
      {"t = { s = \"\xce\xb1\", a = 2 }\n", "t.a", "3", "t = { s = \"\xce\xb1\", a = 3 }\n"},
      {"[t]\na = 1\n[u]\na = 2\n", "t.a", "[4, 5]", "[t]\na = [4, 5]\n[u]\na = 2\n"},
  };
  for (const Layout& layout : layouts) {
    const fs::path file = folder.write("a.toml", layout.text);
    CHECK(set_toml_values(file, {{layout.key, layout.literal}}) == layout.result);
  }
}

TEST_CASE("Setting a TOML value where it cannot stand is refused", "[io]") {
  const TemporaryFolder folder;
  const fs::path dotted = folder.write("a.toml", "t.a = 1\n[u]\nb = 2\n");
  // The table made by a dotted key has no heading; its line would land elsewhere.
  CHECK_THROWS_AS(set_toml_values(dotted, {{"t.c", "3"}}), InputError);
  CHECK_THROWS_AS(set_toml_values(dotted, {{"u.b", "]"}}), InputError);
  CHECK_THROWS_AS(set_toml_values(folder / "none.toml", {{"a", "1"}}), InputError);
}

}  // namespace
}  // namespace strut
