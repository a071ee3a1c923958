// What is fuzzed: the formats that strut reads, each with its readers.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/fuzz/mutate.h"

namespace strut::fuzz {

struct Format {
  std::string name;
  std::filesystem::path file;  // where readers look for the content, within the work folder
  std::vector<std::filesystem::path> seeds;  // within the work folder
  Dictionary dictionary;
  /// Reads the file, and goes on to what a command would make of it.
  std::function<void(const std::filesystem::path& file)> read;
  /// Changes behind checksums, see hdf5_tree.h.
  bool is_hdf5 = false;
  /// Changes of any bytes; where false, of the content alone.
  bool flips_bytes = true;
  /// Left out where no format is named.
  bool only_by_name = false;
};

/// Fills an empty folder with what the formats read beside their own file: the examples, a planned
/// sweep with shards, networks, a report.
void make_work_folder(const std::filesystem::path& folder);

std::vector<Format> list_formats();

// By room.
std::vector<Format> list_text_formats();
std::vector<Format> list_hdf5_formats();
std::vector<Format> list_sweep_formats();
std::vector<Format> list_command_formats();

}  // namespace strut::fuzz
