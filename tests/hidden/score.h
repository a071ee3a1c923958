// Scores of verdicts against the truth: the counts of the evaluation protocol, and their targets.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/hidden/verdicts.h"
#include "tests/hidden/wilson.h"

namespace strut::hidden {

/// A count, with one cell for each grade. The truth is the hidden effect, or one that the runs of
/// its trial cannot tell from it.
enum class Metric {
  kFalseAlarm,      // nothing hidden, something claimed
  kDetected,        // one effect of the catalogue hidden, verdict not adequate
  kInGroup,         // one: the truth is a cause or in the group, of at most kLargestGroup
  kInPrintedGroup,  // one: the truth is a cause or in the group, however large
  kAloneRight,      // one: the truth is the only cause, and the group holds no other name
  kExact,           // one: the first cause is the truth
  kUnknownFlagged,  // unknown hidden, graded beyond imitation: verdict unknown or form_incomplete
  kUnknownPlaced,   // unknown, flagged: where.place is the truth's, word for word
  kBothNamed,       // two hidden, graded beyond every other pair
  kOneOfTwoNamed,
  kWrongConfident,  // any trial: a wrong cause with more than 0.8, no truth for it in the group
  kOverclaimed,     // grade D: a cause named with more than 0.8, no group beside it
  kEffectCovered,   // named exactly: 95 % interval holds the effect's parameter
  kEffectWithin10,  // named exactly: off by at most 10 %
  kBaseCovered,     // parameters of the baseline
  kExplained95,     // one: explains at least 95 % of the excess error on the held-out runs
  kExplained80,     // one: at least 80 %
  kMapExplained70,  // unknown: flagged, and the force map explains at least 70 %
  kCount
};
const char* get_name(Metric metric);

/// Max names for each hidden effect; more names name nothing.
inline constexpr std::size_t kLargestGroup = 4;

/// Error and pull of a parameter without a verdict: 100 %, and far out of any interval.
inline constexpr double kMissingError = 1.0, kMissingPull = 10.0;

/// Smallest probability of the truth that its surprise counts.
inline constexpr double kLeastProbability = 0.01;

struct Cell {
  int hits = 0, total = 0;
  void add(bool hit) {
    hits += hit ? 1 : 0;
    ++total;
  }
};

struct Score {
  std::map<Metric, std::map<char, Cell>> cells;   // by grade, '-' for nothing hidden
  std::vector<double> probability_on_truth;       // one, A and B
  std::vector<double> null_error;                 // relative, of stiffnesses and dampings
  std::vector<double> null_pull;                  // the same over the stated 1 sigma
  std::vector<double> null_excess;                // the same over the Cramer-Rao bound
  std::vector<double> smooth_error, rough_error;  // relative, named; roads up to 1e-6, 16e-6
  std::vector<double> effect_error;               // relative, of effects named exactly
  /// Probability of each first cause, together with those that are not distinguished from it, and
  /// whether one of these is right.
  std::vector<std::pair<double, bool>> confidence;
  std::vector<double> surprise;       // -ln of the probability of the truth: none, one and unknown
  std::vector<double> names;          // one, A and B: number of names, where there are any
  std::vector<std::string> failures;  // one line per trial, with the runners-up
  std::map<std::string, std::map<char, int>> contents;  // trials by category and grade
  int missing = 0;                                      // trials without a verdict
};

/// `verdicts` by the trials' names. Names are credited and blamed in the verdicts named, group and
/// form_incomplete, and in no other. A trial without a verdict counts against the tool everywhere:
/// as a false alarm, as not detected, not named, not flagged, not placed; as a wrong name with
/// confidence 1 and, where grade D is hidden, as an overclaim; as intervals that miss every
/// parameter, kMissingError off and kMissingPull of their sigmas.
Score calc_score(const std::vector<TrueTrial>& trials,
                 const std::map<std::string, Verdict>& verdicts);

/// Expected calibration error in ten bins of equal width: mean of |fraction right - mean
/// confidence| weighted by the bins' counts; 0 for nothing.
double calc_calibration_error(const std::vector<std::pair<double, bool>>& confidence);

struct Gate {
  Metric metric = Metric::kFalseAlarm;
  std::string grades;
  double target = 0.0;
  bool at_least = true;  // else: at most
};
const std::vector<Gate>& list_gates();

Cell pool(const Score& score, Metric metric, const std::string& grades);
/// Whether the trials alone determine the size of the metric's cells, not the verdicts.
bool is_size_fixed(Metric metric);
/// A cell fails when its whole Wilson interval lies on the wrong side of the target.
bool passes(const Gate& gate, const Cell& cell);

/// A score that is not a proportion, with its target.
struct Quantity {
  std::string name;
  double value = 0.0;
  std::size_t count = 0;  // number of values
  double target = 0.0;
  bool at_least = true;
  double slack = 0.0;  // that a limit adds, since single trials may change it by so much

  bool passes() const { return count == 0 || (at_least ? value >= target : value <= target); }
};
std::vector<Quantity> list_quantities(const Score& score);

}  // namespace strut::hidden
