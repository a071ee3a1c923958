// Runs readers on mutants in processes of their own, and tells how they end.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/fuzz/format.h"

namespace strut::fuzz {

/// What may stand where a file is expected.
enum class Kind { kFile, kFifo, kFolder, kDanglingLink, kZeroDevice };

struct Input {
  Kind kind = Kind::kFile;
  std::string content;
};

/// Input `number` of a format: a function of these alone.
Input make_input(const Format& format, const std::vector<std::string>& seeds, std::uint64_t seed,
                 std::uint64_t number);

/// Puts it at `path`, in place of what is there.
void write_input(const std::filesystem::path& path, const Input& input);
/// What write_input() put there.
Input read_input(const std::filesystem::path& path);

/// Contents of a format's seeds.
std::vector<std::string> read_seeds(const Format& format, const std::filesystem::path& work);

/// Reads `format.file` in `work`. Empty: accepted, or refused as a bad file should be; `refused`,
/// where given, tells which. Else what is wrong with how it was refused.
std::string judge(const Format& format, const std::filesystem::path& work,
                  std::optional<std::string>* refused = nullptr);

struct Campaign {
  std::uint64_t seed = 1, first = 0;
  std::uint64_t executions = 0;                      // 0: as many as there is time for
  std::chrono::duration<double> time{0.0};           // 0: as long as it takes
  std::filesystem::path findings;                    // folder
  double max_seconds = 5.0;                          // of processor time, for one input
  std::uint64_t max_bytes = std::uint64_t{1} << 30;  // resident, beyond those of an idle process
};

struct Finding {
  std::uint64_t number = 0;  // of its first input
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
