// Strict reader of TOML files: every value is asked for by name, type and allowed range, and a key
// that nobody asked for is an error. Every message names file, line, key, value and what is
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

/// One table of a document. All getters throw InputError on a missing key (unless a fallback is
/// given), a wrong type, a value that is not finite, or one outside the allowed range.
class Table {
 public:
  bool has(const std::string& key) const;
  /// All keys, in the order of the file.
  std::vector<std::string> keys() const;

  double number(const std::string& key, const Range& range = {}) const;
  double number_or(const std::string& key, double fallback, const Range& range = {}) const;
  /// A whole number of [low, high], written without a point.
  std::int64_t integer(const std::string& key, std::int64_t low, std::int64_t high) const;
  std::int64_t integer_or(const std::string& key, std::int64_t fallback, std::int64_t low,
                          std::int64_t high) const;
  bool boolean_or(const std::string& key, bool fallback) const;
  std::string text(const std::string& key) const;
  std::string text_or(const std::string& key, const std::string& fallback) const;
  bool is_text(const std::string& key) const;
  std::vector<std::string> texts(const std::string& key) const;
  std::vector<double> numbers(const std::string& key, const Range& range = {}) const;
  /// An array of arrays of numbers, at least one, all of one length, at least one.
  std::vector<std::vector<double>> rows(const std::string& key, const Range& range = {}) const;
  /// An array of exactly three numbers.
  std::array<double, 3> vector(const std::string& key, const Range& range = {}) const;
  std::array<double, 3> vector_or(const std::string& key, const std::array<double, 3>& fallback,
                                  const Range& range = {}) const;

  /// Position in `names` of the text at `key`.
  int choice(const std::string& key, const std::vector<std::string>& names) const;
  int choice_or(const std::string& key, int fallback, const std::vector<std::string>& names) const;

  /// An existing file; a relative name starts at the folder of the document that names it.
  std::filesystem::path file(const std::string& key) const;

  Table table(const std::string& key) const;
  std::optional<Table> find_table(const std::string& key) const;
  /// An array of tables, `[[key]]`.
  std::vector<Table> tables(const std::string& key) const;

  /// "file:line: full.key = value: what" for a rule the caller has checked; the line of the key, or
  /// of the table where it has no such key.
  InputError error(const std::string& key, const std::string& what) const;
  /// "file:line: [full.name]: what" for the table as a whole.
  InputError error(const std::string& what) const;

 private:
  friend class Document;
  struct Source;

  Table(std::shared_ptr<Source> source, const void* node, std::string name);
  const void* find(const std::string& key) const;
  const void* require(const std::string& key) const;
  std::string full_name(const std::string& key) const;
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
  /// Throws InputError where the file is missing or not TOML, EnvironmentError where it cannot be
  /// read.
  explicit Document(const std::filesystem::path& path);

  Table root() const;
  const std::filesystem::path& path() const;

  /// Throws InputError that lists every key nobody asked for, with the nearest one that somebody
  /// did ask for in the same table.
  void check_all_read() const;

 private:
  std::shared_ptr<Table::Source> source_;
};

}  // namespace strut
