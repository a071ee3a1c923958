// Reader of ADAMS property files (.tir): sections, `KEY = value`, tables. Independent of tire
// models.
//
//   $ comment          ! comment
//   [SECTION]
//   KEY = 1.5          $ comment
//   KEY = 'text'
//   {column names}     a table: rows of numbers follow
//    1.0  0.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error/input_error.h"

namespace strut {

/// One `KEY = value`; section and key in capitals, `text` without quotes.
struct TirEntry {
  std::string section;
  std::string key;
  std::string text;
  bool quoted = false;
  int line = 0;
};

/// The rows below a `{...}` line.
struct TirTable {
  std::string section;
  std::string columns;
  std::vector<std::vector<double>> rows;
  int line = 0;
};

struct TirFile {
  std::filesystem::path path;
  std::vector<TirEntry> entries;
  std::vector<TirTable> tables;

  /// Returns the first entry with this key in any section, or nullptr.
  const TirEntry* find(std::string_view key) const;
};

/// Reads the file at `path`. Throws InputError if it is missing or larger than 4 MiB, or, with path
/// and line, if a line is none of the above; EnvironmentError if it cannot be read.
TirFile read_tir(const std::filesystem::path& path);

/// Parses the content of a file that messages call `path`.
TirFile parse_tir(std::string_view content, const std::filesystem::path& path);

/// Returns the value of an entry. Throws InputError if it is not a finite number.
double get_number(const TirFile& file, const TirEntry& entry);

/// Returns the error "PATH:LINE: KEY = value: WHAT".
InputError tir_error(const TirFile& file, const TirEntry& entry, const std::string& what);

}  // namespace strut
