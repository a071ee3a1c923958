// The parsed file behind a Document, and the keys that its reader asked for; for io only.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "io/format/parse_toml.h"
#include "io/format/toml_document.h"

namespace strut {

/// Unknown keys that one message lists.
inline constexpr std::size_t kMaxUnread = 20;

struct Table::Source {
  std::filesystem::path path;
  toml::table root;
  std::map<std::string, std::set<std::string>> asked;  // table name -> keys asked for

  /// Returns the error "PATH:LINE: WHAT" for a node.
  InputError error(const toml::node& node, const std::string& what) const;

  /// Returns the keys of a table that were not asked for.
  std::vector<std::string> list_unread(const toml::table& table, const std::string& name) const;
  /// Appends an error message for each key below a table that was not asked for; after kMaxUnread
  /// messages, empty texts.
  void add_unread(const toml::table& table, const std::string& name,
                  std::vector<std::string>& unread) const;

 private:
  bool is_asked(const std::string& table, const std::string& key) const;
  void add_unread_inside(const toml::node& node, const std::string& name,
                         std::vector<std::string>& unread) const;
};

}  // namespace strut
