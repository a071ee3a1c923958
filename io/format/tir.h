// Reader of ADAMS property files (.tir): sections, `KEY = value`, tables. Knows no tire model.
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

  /// The entry of this key in whatever section, or nullptr.
  const TirEntry* find(std::string_view key) const;
};

/// Reads the file at `path`. Throws InputError "file:line: ..." where it is missing, larger than
/// 4 MiB, or a line is none of the above, EnvironmentError where it cannot be read.
TirFile read_tir(const std::filesystem::path& path);

/// Parses the content of a file; `path` only names it in messages.
TirFile parse_tir(std::string_view content, const std::filesystem::path& path);

/// The entry's value as a finite number. Throws InputError otherwise.
double get_number(const TirFile& file, const TirEntry& entry);

/// "file:line: KEY = value: what"
InputError tir_error(const TirFile& file, const TirEntry& entry, const std::string& what);

}  // namespace strut
