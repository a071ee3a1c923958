// Formats to fuzz, each with its readers.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/fuzz/mutate.h"

namespace strut::fuzz {

/// Method by which mutants of a format are made.
enum class Changes {
  kBytes,            // any bytes
  kBytesAndContent,  // half of them as kContent
  kContent,          // HDF5 content, with a valid structure and seal: see hdf5_tree.h
  kSealedBytes,      // any bytes, sealed again
};

struct Format {
  std::string name;
  std::filesystem::path file;                // the file that readers read, within the work folder
  std::vector<std::filesystem::path> seeds;  // within the work folder
  Dictionary dictionary;
  /// Reads the file and continues as a command would.
  std::function<void(const std::filesystem::path& file)> read;
  Changes changes = Changes::kBytes;
  /// Skipped unless it is named.
  bool only_by_name = false;
};

/// Fills an empty folder with the other files that the formats read: the examples, a planned sweep
/// with shards, networks, a report.
void make_work_folder(const std::filesystem::path& folder);

std::vector<Format> list_formats();

// By room.
std::vector<Format> list_text_formats();
std::vector<Format> list_hdf5_formats();
std::vector<Format> list_sweep_formats();
std::vector<Format> list_command_formats();

}  // namespace strut::fuzz
