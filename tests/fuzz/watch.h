// Runs readers on mutants in processes of their own and reports how these end.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/fuzz/format.h"

namespace strut::fuzz {

/// Types of file system entries in place of a file.
enum class Kind { kFile, kFifo, kFolder, kDanglingLink, kZeroDevice };

struct Input {
  Kind kind = Kind::kFile;
  std::string content;
};

/// Makes input `number` of a format, a function of the arguments alone.
Input make_input(const Format& format, const std::vector<std::string>& seeds, std::uint64_t seed,
                 std::uint64_t number);

/// Writes an input to `path`, replacing any entry there.
void write_input(const std::filesystem::path& path, const Input& input);
/// Reads what write_input() wrote.
Input read_input(const std::filesystem::path& path);

/// Reads the seeds of a format.
std::vector<std::string> read_seeds(const Format& format, const std::filesystem::path& work);

/// Reads `format.file` in `work`. Returns "" if it was accepted or refused properly (`refused`, if
/// given, is set to which), otherwise the fault of the refusal.
std::string judge(const Format& format, const std::filesystem::path& work,
                  std::optional<std::string>* refused = nullptr);

struct Campaign {
  std::uint64_t seed = 1, first = 0;
  std::uint64_t executions = 0;                      // 0: limited by the time
  std::chrono::duration<double> time{0.0};           // 0: no limit
  std::filesystem::path findings;                    // folder
  double max_seconds = 5.0;                          // processor time of one input
  std::uint64_t max_bytes = std::uint64_t{1} << 30;  // resident, beyond those of an idle process
};

struct Finding {
  std::uint64_t number = 0;  // number of its first input
  std::string what;
  std::uint64_t count = 1;
  std::filesystem::path file;
};

struct Tally {
  std::uint64_t executions = 0, accepted = 0, refused = 0;
  std::vector<Finding> findings;  // different ones
};

/// Fuzzes one format. Inputs of findings stay in `campaign.findings`, one for each kind of finding.
Tally run_campaign(const Format& format, const std::filesystem::path& work,
                   const Campaign& campaign);

}  // namespace strut::fuzz
