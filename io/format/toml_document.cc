#include "io/format/toml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "base/text/shorten.h"
#include "io/format/toml_source.h"

namespace strut {

namespace {

namespace fs = std::filesystem;

// Elements of an array that a message quotes.
constexpr std::size_t kMaxQuotedElements = 6;

const toml::node& as_node(const void* node) { return *static_cast<const toml::node*>(node); }

const char* describe_type(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    default:
      return "a date or time";
  }
}

// Returns the value as a message quotes it, or its type if the text would be long.
std::string describe_value(const toml::node& node) {
  if (const auto* value = node.as_floating_point()) return format_number(value->get());
  if (const auto* value = node.as_integer()) return std::to_string(value->get());
  if (const auto* value = node.as_boolean()) return value->get() ? "true" : "false";
  if (const auto* value = node.as_string()) return fmt::format("\"{}\"", shorten(value->get()));
  const auto* array = node.as_array();
  if (array == nullptr || array->size() > kMaxQuotedElements || array->is_array_of_tables()) {
    return fmt::format("({})", describe_type(node));
  }
  std::string text;
  for (const toml::node& item : *array) text += (text.empty() ? "" : ", ") + describe_value(item);
  return fmt::format("[{}]", text);
}

}  // namespace

Table::Table(std::shared_ptr<Source> source, const void* node, std::string name)
    : source_(std::move(source)), node_(node), name_(std::move(name)) {
  source_->asked[name_];
}

std::string Table::full_name(const std::string& key) const { return join_key(name_, key); }

InputError Table::value_error(const std::string& key, const void* node,
                              const std::string& what) const {
  return source_->error(as_node(node), fmt::format("{} = {}: {}", full_name(key),
                                                   describe_value(as_node(node)), what));
}

const void* Table::find(const std::string& key) const {
  source_->asked[name_].insert(key);
  return as_node(node_).as_table()->get(key);
}

const void* Table::require(const std::string& key) const {
  const void* node = find(key);
  if (node != nullptr) return node;
  std::string what = fmt::format("missing key '{}'", full_name(key));
  // A required key is often missing because it is misspelled; the check of unread keys is never
  // reached then.
  const auto unread = source_->list_unread(*as_node(node_).as_table(), name_);
  const std::string misspelled = nearest_name(key, unread);
  if (!misspelled.empty()) what += fmt::format("; is '{}' meant to be it?", misspelled);
  throw source_->error(as_node(node_), what);
}

InputError Table::error(const std::string& key, const std::string& what) const {
  const void* node = find(key);
  if (node != nullptr) return value_error(key, node, what);
  return source_->error(as_node(node_), fmt::format("{}: {}", full_name(key), what));
}

InputError Table::error(const std::string& what) const {
  if (name_.empty()) return InputError(fmt::format("{}: {}", source_->path.string(), what));
  return source_->error(as_node(node_), fmt::format("[{}]: {}", name_, what));
}

InputError Table::wrong_type(const std::string& key, const void* node,
                             const std::string& wanted) const {
  return value_error(key, node, "must be " + wanted);
}

double Table::checked_number(const std::string& key, const void* node, const Range& range) const {
  if (!as_node(node).is_number()) throw wrong_type(key, node, "a number");
  const double value = as_node(node).value<double>().value_or(std::nan(""));
  if (range.contains(value)) return value;
  const std::string allowed = range.describe();
  const bool is_said = std::isfinite(value) || allowed.starts_with("must be a finite number");
  throw value_error(key, node, (is_said ? "" : "must be a finite number; ") + allowed);
}

bool Table::has(const std::string& key) const { return find(key) != nullptr; }

double Table::number(const std::string& key, const Range& range) const {
  return checked_number(key, require(key), range);
}

double Table::number_or(const std::string& key, double fallback, const Range& range) const {
  return has(key) ? number(key, range) : fallback;
}

std::vector<std::string> Table::keys() const {
  std::vector<std::pair<toml::source_position, std::string>> found;
  for (const auto& [key, value] : *as_node(node_).as_table()) {
    found.emplace_back(key.source().begin, std::string(key.str()));
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> names;
  names.reserve(found.size());
  for (auto& [position, name] : found) names.push_back(std::move(name));
  return names;
}

std::int64_t Table::integer(const std::string& key, std::int64_t low, std::int64_t high) const {
  const void* node = require(key);
  const auto* value = as_node(node).as_integer();
  if (value == nullptr) throw wrong_type(key, node, "a whole number");
  if (value->get() >= low && value->get() <= high) return value->get();
  throw error(key, fmt::format("must lie in [{}, {}]", low, high));
}

std::int64_t Table::integer_or(const std::string& key, std::int64_t fallback, std::int64_t low,
                               std::int64_t high) const {
  return has(key) ? integer(key, low, high) : fallback;
}

bool Table::boolean_or(const std::string& key, bool fallback) const {
  const void* node = find(key);
  if (node == nullptr) return fallback;
  const auto* value = as_node(node).as_boolean();
  if (value == nullptr) throw wrong_type(key, node, "true or false");
  return value->get();
}

std::string Table::text(const std::string& key) const {
  const void* node = require(key);
  const auto* value = as_node(node).as_string();
  if (value == nullptr) throw wrong_type(key, node, "a text in quotes");
  return value->get();
}

std::string Table::text_or(const std::string& key, const std::string& fallback) const {
  return has(key) ? text(key) : fallback;
}

bool Table::is_text(const std::string& key) const {
  const void* node = find(key);
  return node != nullptr && as_node(node).is_string();
}

std::vector<std::string> Table::texts(const std::string& key) const {
  const void* node = require(key);
  const toml::array* array = as_node(node).as_array();
  if (array == nullptr) throw wrong_type(key, node, "an array of texts");
  std::vector<std::string> values;
  values.reserve(array->size());
  for (const toml::node& item : *array) {
    const auto* value = item.as_string();
    if (value == nullptr) throw wrong_type(key, node, "an array of texts");
    values.push_back(value->get());
  }
  return values;
}

std::vector<double> Table::checked_numbers(const std::string& key, const void* node,
                                           const Range& range) const {
  const toml::array* array = as_node(node).as_array();
  if (array == nullptr) throw wrong_type(key, node, "an array of numbers");
  std::vector<double> values;
  for (std::size_t i = 0; i < array->size(); ++i) {
    values.push_back(checked_number(name_element(key, i), array->get(i), range));
  }
  return values;
}

std::vector<double> Table::numbers(const std::string& key, const Range& range) const {
  return checked_numbers(key, require(key), range);
}

std::vector<std::vector<double>> Table::rows(const std::string& key, const Range& range) const {
  const void* node = require(key);
  const toml::array* array = as_node(node).as_array();
  if (array == nullptr || array->empty()) {
    throw wrong_type(key, node, "an array of rows of numbers");
  }
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const std::string row = name_element(key, i);
    rows.push_back(checked_numbers(row, array->get(i), range));
    const std::size_t wanted = std::max<std::size_t>(rows.front().size(), 1);
    if (rows.back().size() == wanted) continue;
    throw wrong_type(row, array->get(i), fmt::format("an array of {} numbers", wanted));
  }
  return rows;
}

std::array<double, 3> Table::vector(const std::string& key, const Range& range) const {
  const void* node = require(key);
  const toml::array* array = as_node(node).as_array();
  if (array == nullptr || array->size() != 3) {
    throw wrong_type(key, node, "an array of three numbers");
  }
  const std::vector<double> values = numbers(key, range);
  return {values[0], values[1], values[2]};
}

std::array<double, 3> Table::vector_or(const std::string& key,
                                       const std::array<double, 3>& fallback,
                                       const Range& range) const {
  return has(key) ? vector(key, range) : fallback;
}

int Table::choice(const std::string& key, const std::vector<std::string>& names) const {
  const std::string name = text(key);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return static_cast<int>(i);
  }
  throw error(key,
              fmt::format("must be one of {}{}", join_names(names), suggest_name(name, names)));
}

int Table::choice_or(const std::string& key, int fallback,
                     const std::vector<std::string>& names) const {
  return has(key) ? choice(key, names) : fallback;
}

fs::path Table::file(const std::string& key) const {
  const fs::path named = text(key);
  fs::path path = (source_->path.parent_path() / named).lexically_normal();
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (fs::is_regular_file(status)) return path;
  const std::string what = fs::exists(status)                          ? "not a file"
                           : status.type() == fs::file_type::not_found ? "file not found"
                                                                       : code.message();
  throw error(key, fmt::format("{}: {}", what, shorten(path.string(), 4 * kMaxQuoted)));
}

Table Table::table(const std::string& key) const {
  const void* node = require(key);
  if (!as_node(node).is_table()) throw wrong_type(key, node, "a table");
  return {source_, node, full_name(key)};
}

std::optional<Table> Table::find_table(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return table(key);
}

std::vector<Table> Table::tables(const std::string& key) const {
  const void* node = require(key);
  const toml::array* array = as_node(node).as_array();
  if (array == nullptr || !array->is_array_of_tables()) {
    throw wrong_type(key, node, fmt::format("an array of tables, [[{}]]", full_name(key)));
  }
  std::vector<Table> found;
  for (std::size_t i = 0; i < array->size(); ++i) {
    found.push_back({source_, array->get(i), name_element(full_name(key), i)});
  }
  return found;
}

Document::Document(const fs::path& path) : source_(std::make_shared<Table::Source>()) {
  source_->path = path;
  source_->root = parse_toml(path, read_toml_text(path));
}

Table Document::root() const {
  return {source_, static_cast<const toml::node*>(&source_->root), ""};
}

const fs::path& Document::path() const { return source_->path; }

void Document::check_all_read() const {
  std::vector<std::string> unread;
  source_->add_unread(source_->root, "", unread);
  if (unread.empty()) return;
  std::string message = unread.front();
  const std::size_t shown = std::min(unread.size(), kMaxUnread);
  for (std::size_t i = 1; i < shown; ++i) message += "\n" + unread[i];
  if (shown < unread.size()) {
    message += fmt::format("\nand {} more unknown keys", unread.size() - shown);
  }
  throw InputError(message);
}

}  // namespace strut
