// The least and the most that a fixed set of trials may score, from a measured run.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/hidden/score.h"

namespace strut::hidden {

/// Of one gate's cell: how many hits a run may have at least, or at most; where the verdicts have a
/// say in the cell's size, as a share of it.
struct Limit {
  std::string score, grades;
  bool at_least = true;
  int count = 0;
  int of = 0;  // the cell's size: where trials alone say it, trials of another set are refused
  int measured = 0;  // hits when the limit was set
};

/// Of a score that is no proportion.
struct QuantityLimit {
  std::string quantity;
  bool at_least = true;
  double bound = 0.0;
  std::size_t of = 0;  // values that it came from
  double measured = 0.0;
};

struct Limits {
  std::map<std::string, std::map<char, int>> contents;  // trials by category and grade
  std::vector<Limit> limits;
  std::vector<QuantityLimit> quantities;
};

/// Limits for the gates' cells as they came out: the nearer end of Wilson's interval of half a
/// standard deviation, in whole trials, but one trial worse than measured at least: the same trials
/// are answered again, so that little moves but by changes of the tool. A cell that may be empty
/// then has no limit. Of what the intervals miss of the baseline, and of quantities that must be
/// small, 1.5 times as much is allowed; of those that must be large, a 1.5th; their target where 0
/// was measured.
Limits make_limits(const Score& score);

/// What of the score lies beyond its limit, a line each; other trials than the limits were set for
/// and missing verdicts, too, and quantities that nothing is left of. Empty: passed.
std::vector<std::string> find_misses(const Limits& limits, const Score& score);

/// The limits beside what was measured, in Markdown.
std::string make_limits_table(const Limits& limits, const Score& score);

/// A tool that deserves to fail, as it would answer these trials.
struct Impostor {
  std::string name;
  std::map<std::string, Verdict> verdicts;
};

/// Who always names the effect that is hidden most often, who never names any, and the tool itself
/// with its verdicts handed out to other trials.
std::vector<Impostor> make_impostors(const std::vector<TrueTrial>& trials,
                                     const std::map<std::string, Verdict>& verdicts);

/// JSON; reading throws std::runtime_error with the file's name for what is no such file.
std::string make_limits_json(const Limits& limits);
Limits read_limits(const std::filesystem::path& path);

}  // namespace strut::hidden
