#include "io/toml_text.h"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <string_view>

#include "io/config.h"
#include "io/parse_toml.h"

namespace strut {
namespace {

std::string describe(const toml::node& node) {
  if (node.is_number()) return format_number(node.value<double>().value_or(0.0));
  if (const auto* value = node.as_string()) return value->get();
  std::ostringstream text;
  node.visit([&text](const auto& value) { text << value; });
  return text.str();
}

void add_values(const toml::node& node, const std::string& name, TomlValues& values) {
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) {
      add_values(value, (name.empty() ? "" : name + ".") + std::string(key.str()), values);
    }
  } else if (const toml::array* array = node.as_array()) {
    for (std::size_t i = 0; i < array->size(); ++i) {
      add_values(*array->get(i), name + "[" + std::to_string(i + 1) + "]", values);
    }
  } else {
    values.emplace_back(name, describe(node));
  }
}

/// Place in `text` of a line and column as the parser counts them: from 1, columns in code points,
/// from behind a byte order mark on.
std::size_t find_place(const std::string& text, const toml::source_position& position) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  std::size_t place = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  for (toml::source_index line = 1; line < position.line; ++line)
    place = text.find('\n', place) + 1;
  for (toml::source_index column = 1; column < position.column; ++column) {
    do {
      ++place;
    } while (place < text.size() && (static_cast<unsigned char>(text[place]) & 0xC0U) == 0x80U);
  }
  return place;
}

/// A basic string of TOML.
std::string quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20U && byte != 0x7fU) {
      quoted += c;
      continue;
    }
    char escaped[8];
    std::snprintf(escaped, sizeof escaped, "\\u%04X", static_cast<unsigned>(byte));
    quoted += escaped;
  }
  return quoted + "\"";
}

}  // namespace

TomlValues flatten_toml(const std::filesystem::path& path) {
  TomlValues values;
  add_values(parse_toml(path, read_text_file(path)), "", values);
  std::sort(values.begin(), values.end());
  return values;
}

std::string replace_toml_texts(const std::filesystem::path& path, const TomlValues& values) {
  const std::string text = read_text_file(path);
  const toml::table root = parse_toml(path, text);
  std::vector<std::pair<std::pair<std::size_t, std::size_t>, std::string>> changes;
  changes.reserve(values.size());
  for (const auto& [key, value] : values) {
    const toml::node* node = root.at_path(key).node();
    if (node == nullptr || !node->is_string()) {
      throw InputError(path.string() + ": " + key + ": no text there");
    }
    changes.push_back(
        {{find_place(text, node->source().begin), find_place(text, node->source().end)},
         quote(value)});
  }
  std::sort(changes.begin(), changes.end());
  std::string changed;
  std::size_t kept = 0;
  for (const auto& [range, value] : changes) {
    changed += text.substr(kept, range.first - kept) + value;
    kept = range.second;
  }
  return changed + text.substr(kept);
}

}  // namespace strut
