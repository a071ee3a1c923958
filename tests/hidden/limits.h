// The least and the most that a fixed set of trials may score, from a measured run.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/hidden/score.h"

namespace strut::hidden {

/// Of one gate's cell: how many hits a run may have at least, or at most.
struct Limit {
  std::string score, grades;
  bool at_least = true;
  int count = 0;
  int of = 0;        // the cell's size: trials of another set are refused
  int measured = 0;  // hits when the limit was set
};

struct Limits {
  std::map<std::string, std::map<char, int>> contents;  // trials by category and grade
  std::vector<Limit> limits;
};

/// Limits for the gates' cells as they came out: the nearer end of Wilson's interval of half a
/// standard deviation, in whole trials, but one trial worse than measured at least: the same trials
/// are answered again, so that little moves but by changes of the tool. A cell that may be empty
/// then has no limit.
Limits make_limits(const Score& score);

/// What of the score lies beyond its limit, a line each; other trials than the limits were set for
/// and missing verdicts, too. Empty: passed.
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
