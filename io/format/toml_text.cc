#include "io/format/toml_text.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <sstream>
#include <string_view>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "io/format/parse_toml.h"

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

TomlValues flatten(const std::filesystem::path& path, const std::string& text) {
  TomlValues values;
  add_values(parse_toml(path, text), "", values);
  std::sort(values.begin(), values.end());
  return values;
}

/// The text with a line of `key` set in a table that does not have it: in an inline table in front
/// of the others, else below the table's heading, or a new table at the end.
std::string insert_value(const std::string& text, const toml::table& root, const std::string& key,
                         const std::string& literal) {
  const std::size_t dot = key.rfind('.');
  const std::string line = key.substr(dot + 1) + " = " + literal;
  if (dot == std::string::npos) return line + "\n" + text;
  const std::string name = key.substr(0, dot);
  const toml::node* node = root.at_path(name).node();
  const toml::table* table = node == nullptr ? nullptr : node->as_table();
  if (table == nullptr) return text + "\n[" + name + "]\n" + line + "\n";
  const std::size_t begin = find_place(text, table->source().begin);
  const std::size_t place = text.find(table->is_inline() ? '{' : '\n', begin);
  if (place == std::string::npos) return text + "\n" + line + "\n";
  const std::string inserted = table->is_inline() ? " " + line + "," : line + "\n";
  return text.substr(0, place + 1) + inserted + text.substr(place + 1);
}

std::string set_value(const std::filesystem::path& path, const std::string& text,
                      const std::string& key, const std::string& literal) {
  const toml::table root = parse_toml(path, text);
  const toml::node* node = root.at_path(key).node();
  if (node == nullptr) return insert_value(text, root, key, literal);
  const std::size_t begin = find_place(text, node->source().begin);
  return text.substr(0, begin) + literal + text.substr(find_place(text, node->source().end));
}

/// Layouts of a file are many: what was to be set must be, and nothing else.
void check_set(const std::filesystem::path& path, const std::string& before,
               const std::string& after, const TomlValues& literals) {
  std::map<std::string, std::string> wanted;
  for (const auto& [key, value] : flatten(path, before)) wanted[key] = value;
  const std::string probe = "value";
  for (const auto& [key, literal] : literals) {
    const auto is_of_key = [&key = key](const auto& value) {
      return value.first == key || value.first.starts_with(key + "[") ||
             value.first.starts_with(key + ".");
    };
    std::erase_if(wanted, is_of_key);
    for (const auto& [name, value] : flatten(path, probe + " = " + literal)) {
      wanted[key + name.substr(probe.size())] = value;
    }
  }
  const TomlValues all(wanted.begin(), wanted.end());
  if (flatten(path, after) == all) return;
  throw InputError(path.string() + ": " + literals.front().first +
                   ": cannot be set there; write it as a key of its own line in its [table]");
}

}  // namespace

std::string quote_toml(const std::string& text) {
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

TomlValues flatten_toml(const std::filesystem::path& path) {
  return flatten(path, read_toml_text(path));
}

std::string set_toml_values(const std::filesystem::path& path, const TomlValues& literals) {
  const std::string before = read_toml_text(path);
  std::string text = before;
  for (const auto& [key, literal] : literals) text = set_value(path, text, key, literal);
  if (!literals.empty()) check_set(path, before, text, literals);
  return text;
}

std::string replace_toml_texts(const std::filesystem::path& path, const TomlValues& values) {
  const std::string text = read_toml_text(path);
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
         quote_toml(value)});
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
