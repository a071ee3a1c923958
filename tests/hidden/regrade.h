// Grades published trials anew, without new verdicts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/hidden/trial.h"

namespace strut::hidden {

/// A trial of a published table: what was hidden, how it was graded, and what was answered.
struct PublishedTrial {
  std::string kit;
  std::uint64_t seed = 0;
  /// "right": every hidden fault named or flagged as unknown, or, where nothing is hidden,
  /// adequate; else the verdict's word.
  std::string answer;
  std::vector<std::string> names;  // EFFECT or EFFECT@PLACE, of answers that are not right
  std::vector<FaultSetting> faults;
  std::vector<double> ratios;  // of each fault, as published
  std::string grades;          // of each fault, as published
};

/// Lines KIT,SEED,ANSWER,NAMES,{FAULT,PLACE,MAGNITUDE,RATIO,GRADE}; # begins a comment. Throws
/// std::runtime_error with file and line for others.
std::vector<PublishedTrial> read_published(const std::filesystem::path& path);

/// Grades all trials; the result depends on nothing but the trials.
std::vector<Trial> regrade(const std::vector<PublishedTrial>& published, unsigned threads);

/// In Markdown: ratios of each fault, trials by old and new grade, and the scores by old and by new
/// grades with the restated targets.
std::string make_regrade_report(const std::vector<PublishedTrial>& published,
                                const std::vector<Trial>& trials);

/// One line of comma-separated values for each hidden fault: both ratios, ratios beyond imitation,
/// and twins.
std::string make_regrade_list(const std::vector<PublishedTrial>& published,
                              const std::vector<Trial>& trials);

}  // namespace strut::hidden
