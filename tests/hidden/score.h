// How good verdicts are, against the truth: the table and the gates of the evaluation protocol.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/hidden/verdicts.h"
#include "tests/hidden/wilson.h"

namespace strut::hidden {

/// What is counted, one cell for each grade.
enum class Metric {
  kFalseAlarm,      // nothing hidden, something claimed
  kDetected,        // one of the catalogue hidden, not called adequate
  kInGroup,         // one: the truth is a cause or in the group, of at most kLargestGroup
  kExact,           // one, effects that the kits can tell apart: the first cause is the truth
  kUnknownFlagged,  // unknown hidden: verdict unknown or form_incomplete
  kUnknownPlaced,   // unknown, flagged: the place is named
  kBothNamed,       // two hidden
  kOneOfTwoNamed,
  kWrongConfident,  // any trial: a wrong cause with more than 0.8, the truth not in the group
  kOverclaimed,     // grade D: one cause named with more than 0.8
  kEffectCovered,   // named exactly: 95 % interval holds the effect's parameter
  kBaseCovered,     // parameters of the baseline
  kCount
};
const char* get_name(Metric metric);

/// More names than these name nothing.
inline constexpr std::size_t kLargestGroup = 4;

struct Cell {
  int hits = 0, total = 0;
  void add(bool hit) {
    hits += hit ? 1 : 0;
    ++total;
  }
};

struct Score {
  std::map<Metric, std::map<char, Cell>> cells;     // by grade, '-' for nothing hidden
  std::vector<double> probability_on_truth;         // one, A and B
  std::vector<double> explained;                    // one, A and B
  std::vector<double> null_error, named_error;      // relative, of stiffnesses and dampings
  std::vector<double> effect_error;                 // relative, of effects named exactly
  std::vector<std::pair<double, bool>> confidence;  // of each first cause, and whether it is right
  std::vector<std::string> failures;                // a line a trial
  int missing = 0;                                  // trials without a verdict
};

/// `verdicts` by the trials' names; a trial without one counts against the tool everywhere.
Score calc_score(const std::vector<TrueTrial>& trials,
                 const std::map<std::string, Verdict>& verdicts);

/// Expected calibration error in ten bins of equal width: mean of |share right - mean confidence|
/// weighted by the bins' counts; 0 for nothing.
double calc_calibration_error(const std::vector<std::pair<double, bool>>& confidence);

struct Gate {
  Metric metric = Metric::kFalseAlarm;
  std::string grades;
  double target = 0.0;
  bool at_least = true;  // else: at most
};
const std::vector<Gate>& list_gates();

Cell pool(const Score& score, Metric metric, const std::string& grades);
/// A cell fails when its whole Wilson interval lies on the wrong side of the target.
bool passes(const Gate& gate, const Cell& cell);

/// The table in Markdown with what failed. `passed`: all gates, no verdict missing.
std::string make_report(const Score& score, bool& passed);

}  // namespace strut::hidden
