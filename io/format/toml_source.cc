#include "io/format/toml_source.h"

#include <fmt/format.h>

#include "base/text/nearest_name.h"
#include "base/text/shorten.h"
#include "io/format/text_line.h"

namespace strut {

InputError Table::Source::error(const toml::node& node, const std::string& what) const {
  return line_error(path, node.source().begin.line, what);
}

bool Table::Source::is_asked(const std::string& table, const std::string& key) const {
  const auto found = asked.find(table);
  return found != asked.end() && found->second.contains(key);
}

std::vector<std::string> Table::Source::list_unread(const toml::table& table,
                                                    const std::string& name) const {
  std::vector<std::string> unread;
  for (const auto& [key, value] : table) {
    const std::string text(key.str());
    if (!is_asked(name, text)) unread.push_back(text);
  }
  return unread;
}

void Table::Source::add_unread(const toml::table& table, const std::string& name,
                               std::vector<std::string>& unread) const {
  std::vector<std::string> known;
  if (const auto found = asked.find(name); found != asked.end()) {
    known.assign(found->second.begin(), found->second.end());
  }
  for (const std::string& key : list_unread(table, name)) {
    if (unread.size() >= kMaxUnread) {
      unread.emplace_back();  // counts
      continue;
    }
    const std::string what =
        fmt::format("unknown key '{}'{}", shorten(join_key(name, key)), suggest_name(key, known));
    unread.emplace_back(error(*table.get(key), what).what());
  }
  for (const auto& [key, value] : table) {
    const std::string text(key.str());
    if (is_asked(name, text)) add_unread_inside(value, join_key(name, text), unread);
  }
}

void Table::Source::add_unread_inside(const toml::node& node, const std::string& name,
                                      std::vector<std::string>& unread) const {
  if (const toml::table* table = node.as_table()) return add_unread(*table, name, unread);
  const toml::array* array = node.as_array();
  if (array == nullptr) return;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::table* item = array->get(i)->as_table();
    if (item != nullptr) add_unread(*item, name_element(name, i), unread);
  }
}

}  // namespace strut
