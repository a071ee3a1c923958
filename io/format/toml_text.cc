#include "io/format/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string_view>

#include "base/text/format_number.h"
#include "io/format/parse_toml.h"
#include "io/format/text_line.h"

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
      add_values(value, join_key(name, std::string(key.str())), values);
    }
  } else if (const toml::array* array = node.as_array()) {
    for (std::size_t i = 0; i < array->size(); ++i) {
      add_values(*array->get(i), name_element(name, i), values);
    }
  } else {
    values.emplace_back(name, describe(node));
  }
}

/// Returns the offset in `text` of a line and column as the parser counts them: from 1, columns in
/// code points, starting after a byte order mark.
std::size_t find_offset(const std::string& text, const toml::source_position& position) {
  std::size_t offset = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  for (toml::source_index line = 1; line < position.line; ++line) {
    offset = text.find('\n', offset) + 1;
  }
  for (toml::source_index column = 1; column < position.column; ++column) {
    do {
      ++offset;
    } while (offset < text.size() && (static_cast<unsigned char>(text[offset]) & 0xC0U) == 0x80U);
  }
  return offset;
}

TomlValues flatten(const std::filesystem::path& path, const std::string& text) {
  TomlValues values;
  add_values(parse_toml(path, text), "", values);
  std::sort(values.begin(), values.end());
  return values;
}

/// Returns the text with `key` added to its table: as the first key of an inline table, else below
/// the table's heading, or in a new table at the end.
std::string insert_value(const std::string& text, const toml::table& root, const std::string& key,
                         const std::string& literal) {
  const std::size_t dot = key.rfind('.');
  const std::string line = fmt::format("{} = {}", key.substr(dot + 1), literal);
  if (dot == std::string::npos) return line + "\n" + text;
  const std::string name = key.substr(0, dot);
  const toml::node* node = root.at_path(name).node();
  const toml::table* table = node == nullptr ? nullptr : node->as_table();
  if (table == nullptr) return fmt::format("{}\n[{}]\n{}\n", text, name, line);
  const std::size_t begin = find_offset(text, table->source().begin);
  const std::size_t before = text.find(table->is_inline() ? '{' : '\n', begin);
  if (before == std::string::npos) return fmt::format("{}\n{}\n", text, line);
  const std::string inserted =
      table->is_inline() ? fmt::format(" {},", line) : fmt::format("{}\n", line);
  return text.substr(0, before + 1) + inserted + text.substr(before + 1);
}

std::string set_value(const std::filesystem::path& path, const std::string& text,
                      const std::string& key, const std::string& literal) {
  const toml::table root = parse_toml(path, text);
  const toml::node* node = root.at_path(key).node();
  if (node == nullptr) return insert_value(text, root, key, literal);
  const std::size_t begin = find_offset(text, node->source().begin);
  return text.substr(0, begin) + literal + text.substr(find_offset(text, node->source().end));
}

/// Throws InputError unless `after` holds the values of `before` with `literals` set and no other
/// change: files have many layouts.
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
    for (const auto& [name, value] : flatten(path, fmt::format("{} = {}", probe, literal))) {
      wanted[key + name.substr(probe.size())] = value;
    }
  }
  const TomlValues all(wanted.begin(), wanted.end());
  if (flatten(path, after) == all) return;
  throw InputError(fmt::format(
      "{}: {}: cannot be set in this layout; write it on a line of its own in its [table]",
      path.string(), literals.front().first));
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
    quoted += fmt::format("\\u{:04X}", byte);
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
      throw InputError(fmt::format("{}: {}: must be a text in quotes", path.string(), key));
    }
    changes.push_back(
        {{find_offset(text, node->source().begin), find_offset(text, node->source().end)},
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
