// Strict reader of TOML files: every value is requested by name, type and allowed range, and a key
// that was not requested is an error. Every message names file, line, key, value and what is
// allowed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error/input_error.h"
#include "base/text/range.h"

namespace strut {

/// One table of a document. All getters throw InputError for a missing key (unless a fallback is
/// given), a wrong type, a value that is not finite, or one outside the allowed range.
class Table {
 public:
  bool has(const std::string& key) const;
  /// Returns all keys in the order of the file.
  std::vector<std::string> keys() const;

  double number(const std::string& key, const Range& range = {}) const;
  double number_or(const std::string& key, double fallback, const Range& range = {}) const;
  /// Returns a whole number in [low, high], written without a decimal point.
  std::int64_t integer(const std::string& key, std::int64_t low, std::int64_t high) const;
  std::int64_t integer_or(const std::string& key, std::int64_t fallback, std::int64_t low,
                          std::int64_t high) const;
  bool boolean_or(const std::string& key, bool fallback) const;
  std::string text(const std::string& key) const;
  std::string text_or(const std::string& key, const std::string& fallback) const;
  bool is_text(const std::string& key) const;
  std::vector<std::string> texts(const std::string& key) const;
  std::vector<double> numbers(const std::string& key, const Range& range = {}) const;
  /// Returns an array of one or more arrays of equal length, one or more numbers each.
  std::vector<std::vector<double>> rows(const std::string& key, const Range& range = {}) const;
  /// Returns an array of exactly three numbers.
  std::array<double, 3> vector(const std::string& key, const Range& range = {}) const;
  std::array<double, 3> vector_or(const std::string& key, const std::array<double, 3>& fallback,
                                  const Range& range = {}) const;

  /// Returns the index in `names` of the text at `key`.
  int choice(const std::string& key, const std::vector<std::string>& names) const;
  int choice_or(const std::string& key, int fallback, const std::vector<std::string>& names) const;

  /// Returns the path of an existing file; relative paths start at the folder of the document.
  std::filesystem::path file(const std::string& key) const;

  Table table(const std::string& key) const;
  std::optional<Table> find_table(const std::string& key) const;
  /// Returns an array of tables, `[[key]]`.
  std::vector<Table> tables(const std::string& key) const;

  /// Returns the error "PATH:LINE: full.key = value: WHAT" for a rule that the caller has checked.
  /// The line is that of the key, or of the table if it lacks the key.
  InputError error(const std::string& key, const std::string& what) const;
  /// Returns the error "PATH:LINE: [full.name]: WHAT" for the table as a whole.
  InputError error(const std::string& what) const;

 private:
  friend class Document;
  struct Source;

  Table(std::shared_ptr<Source> source, const void* node, std::string name);
  const void* find(const std::string& key) const;
  const void* require(const std::string& key) const;
  std::string full_name(const std::string& key) const;
  InputError value_error(const std::string& key, const void* node, const std::string& what) const;
  InputError wrong_type(const std::string& key, const void* node, const std::string& wanted) const;
  double checked_number(const std::string& key, const void* node, const Range& range) const;
  std::vector<double> checked_numbers(const std::string& key, const void* node,
                                      const Range& range) const;

  std::shared_ptr<Source> source_;
  const void* node_;  // the parser's table, owned by source_
  std::string name_;  // dotted, "" at the root
};

/// A parsed file. Read everything through `root()`, then call `check_all_read()`.
class Document {
 public:
  /// Throws InputError if the file is missing or not TOML, EnvironmentError if it cannot be read.
  explicit Document(const std::filesystem::path& path);

  Table root() const;
  const std::filesystem::path& path() const;

  /// Throws InputError that lists every key that was not requested, each with the nearest key that
  /// was requested in the same table.
  void check_all_read() const;

 private:
  std::shared_ptr<Table::Source> source_;
};

}  // namespace strut
