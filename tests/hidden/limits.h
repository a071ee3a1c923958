// Bounds on the scores of a fixed set of trials, from a measured run.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/hidden/score.h"

namespace strut::hidden {

/// Min or max hits of one gate's cell; as a fraction of its size where that depends on the
/// verdicts.
struct Limit {
  std::string score, grades;
  bool at_least = true;
  int count = 0;
  int of = 0;  // the cell's size; where the trials alone determine it, other trials are refused
  int measured = 0;  // hits when the limit was set
};

/// Limit of a score that is not a proportion.
struct QuantityLimit {
  std::string quantity;
  bool at_least = true;
  double bound = 0.0;
  std::size_t of = 0;  // number of values
  double measured = 0.0;
};

struct Limits {
  std::map<std::string, std::map<char, int>> contents;  // trials by category and grade
  std::vector<Limit> limits;
  std::vector<QuantityLimit> quantities;
};

/// Limits from the measured cells of the gates: the nearer end of Wilson's interval of half a
/// standard deviation, in whole trials, but at least one trial worse than measured. That is narrow,
/// since the same trials are run again and differ only by changes of the tool. A cell that may then
/// be empty has no limit. Missed intervals of the baseline, and quantities that must be small, may
/// be 1.5 times as large; quantities that must be large, 1.5 times smaller; their target where 0
/// was measured.
Limits make_limits(const Score& score);

/// One line per score beyond its limit, for other trials than those of the limits, for missing
/// verdicts, and for quantities without values. Empty: passed.
std::vector<std::string> find_misses(const Limits& limits, const Score& score);

/// A table of limits and measured values in Markdown.
std::string make_limits_table(const Limits& limits, const Score& score);

/// The verdicts of a useless tool, which must fail.
struct Impostor {
  std::string name;
  std::map<std::string, Verdict> verdicts;
};

/// A tool that always names the most frequently hidden effect, one that never names any, and the
/// tool itself with its verdicts permuted among the trials.
std::vector<Impostor> make_impostors(const std::vector<TrueTrial>& trials,
                                     const std::map<std::string, Verdict>& verdicts);

/// As JSON; reading throws std::runtime_error with the file's name for another format.
std::string make_limits_json(const Limits& limits);
Limits read_limits(const std::filesystem::path& path);

}  // namespace strut::hidden
