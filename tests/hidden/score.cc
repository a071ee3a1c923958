#include "tests/hidden/score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <set>
#include <utility>

namespace strut::hidden {
namespace {

constexpr double kConfident = 0.8;

/// A lost stroke and a worn joint cause the same motion in two sizes, by the catalogue.
std::string merge_aliases(const std::string& effect) {
  return effect == "joint_play" ? "damper_leak" : effect;
}

bool is_cause(const Claim& claim, const std::string& effect, const std::string& place) {
  return merge_aliases(claim.effect) == merge_aliases(effect) && claim.place == place;
}

/// Whether a claim is the hidden effect, or one that the trial's runs cannot tell from it.
bool is_truth(const Claim& claim, const TrueFault& fault) {
  if (fault.effect.empty()) return false;
  return is_cause(claim, fault.effect, fault.place) ||
         std::any_of(fault.twins.begin(), fault.twins.end(),
                     [&](const CauseName& c) { return is_cause(claim, c.effect, c.place); });
}

bool names(const std::vector<Claim>& claims, const TrueFault& fault) {
  return std::any_of(claims.begin(), claims.end(),
                     [&](const Claim& c) { return is_truth(c, fault); });
}

/// Different effects and places among causes and group.
std::size_t count_names(const Verdict& v) {
  std::set<std::pair<std::string, std::string>> different;
  for (const auto* list : {&v.causes, &v.group}) {
    for (const Claim& c : *list) different.emplace(c.effect, c.place);
  }
  return different.size();
}

/// Whether names are claimed; then they are credited and blamed.
bool claims_names(const Verdict& v) {
  return v.verdict == "named" || v.verdict == "group" || v.verdict == "form_incomplete";
}

bool is_flagged(const Verdict& v) {
  return v.verdict == "unknown" || v.verdict == "form_incomplete";
}

/// Names that are still a group where the trial hides so many effects.
std::size_t count_allowed(const TrueTrial& trial) {
  return kLargestGroup * std::max<std::size_t>(trial.faults.size(), 1);
}

bool is_in_group(const Verdict& v, const TrueFault& fault, std::size_t allowed) {
  return claims_names(v) && count_names(v) <= allowed &&
         (names(v.causes, fault) || names(v.group, fault));
}

bool is_same(const Claim& a, const Claim& b) { return a.effect == b.effect && a.place == b.place; }

/// All different claims, with their probabilities.
std::vector<Claim> list_claims(const Verdict& v) {
  std::vector<Claim> claims;
  for (const auto* list : {&v.causes, &v.group, &v.runners_up}) {
    for (const Claim& c : *list) {
      if (std::none_of(claims.begin(), claims.end(),
                       [&](const Claim& other) { return is_same(c, other); })) {
        claims.push_back(c);
      }
    }
  }
  return claims;
}

/// Probability of the hidden effect and of what the runs cannot tell from it.
double find_probability(const Verdict& v, const TrueFault& fault) {
  if (!claims_names(v)) return 0.0;
  double sum = 0.0;
  for (const Claim& c : list_claims(v)) sum += is_truth(c, fault) ? c.probability : 0.0;
  return std::min(sum, 1.0);
}

/// The first cause with what is not distinguished from it.
std::vector<Claim> list_first(const Verdict& v) {
  if (!v.first.empty()) return v.first;
  const Claim& first = v.causes.front();
  const bool is_grouped = std::any_of(v.group.begin(), v.group.end(),
                                      [&](const Claim& c) { return is_same(c, first); });
  return is_grouped ? v.group : std::vector<Claim>{first};
}

double sum_probabilities(const std::vector<Claim>& claims) {
  double sum = 0.0;
  for (const Claim& c : claims) sum += c.probability;
  return std::min(sum, 1.0);
}

/// Probability that a verdict gives to what is hidden in a trial.
double find_probability(const TrueTrial& trial, const Verdict& v) {
  if (v.verdict == "adequate") return trial.category == "none" ? 1.0 : 0.0;
  if (trial.category == "one") return find_probability(v, trial.faults.front());
  return trial.category == "unknown" ? v.unknown_share : 0.0;
}

bool is_strut_rate(const std::string& name) {
  return name.find("tire") == std::string::npos &&
         (name.find("stiffness") != std::string::npos || name.find("damping") != std::string::npos);
}

/// Errors of a baseline parameter in the scores that its trial belongs to.
struct ParameterError {
  double relative = 0.0, pull = 0.0, excess = 0.0;
};

void add_error(const TrueTrial& trial, bool named, const ParameterError& error, Score& score) {
  if (trial.category == "none") {
    score.null_error.push_back(error.relative);
    score.null_pull.push_back(error.pull);
    score.null_excess.push_back(error.excess);
  }
  if (!named) return;
  constexpr double kSmooth = 1e-6, kClassA = 16e-6;  // m^3
  if (trial.roughness <= kSmooth) score.smooth_error.push_back(error.relative);
  if (trial.roughness == kClassA) score.rough_error.push_back(error.relative);
}

void add_baseline(const TrueTrial& trial, const Verdict& v, bool named, Score& score) {
  for (const auto& [name, truth] : trial.parameters) {
    const auto found = v.after.find(name);
    // A verdict leaves out parameters that are not identifiable.
    if (found == v.after.end()) continue;
    const Estimate& e = found->second;
    score.cells[Metric::kBaseCovered][trial.grade].add(e.low <= truth && truth <= e.high);
    if (!is_strut_rate(name)) continue;
    // An interval without width is as wrong as none.
    const double off = e.value - truth, sigma = (e.high - e.low) / (2.0 * 1.96);
    add_error(trial, named,
              {off / truth, sigma > 0.0 ? off / sigma : kMissingPull, off / trial.bounds.at(name)},
              score);
  }
}

/// Explained shares; where nothing stood out to be explained, none is asked for: but who calls the
/// model adequate has explained nothing of what is hidden.
void add_explained(const Verdict& v, char grade, Score& score) {
  const bool claimed = !v.verdict.empty() && v.verdict != "adequate";
  if (claimed && !v.explained) return;
  const double share = v.explained.value_or(0.0);
  score.cells[Metric::kExplained95][grade].add(share >= 0.95);
  score.cells[Metric::kExplained80][grade].add(share >= 0.80);
}

void add_effect(const TrueFault& fault, const Claim& claim, char grade, Score& score) {
  if (!is_cause(claim, fault.effect, fault.place)) return;
  const auto found = claim.parameters.find(fault.parameter);
  if (found == claim.parameters.end()) return;
  const Estimate& e = found->second;
  score.effect_error.push_back(e.value / fault.magnitude - 1.0);
  score.cells[Metric::kEffectCovered][grade].add(e.low <= fault.magnitude &&
                                                 fault.magnitude <= e.high);
  score.cells[Metric::kEffectWithin10][grade].add(std::fabs(score.effect_error.back()) <= 0.1);
}

void add_one(const TrueTrial& trial, const Verdict& v, Score& score) {
  const TrueFault& fault = trial.faults.front();
  const char grade = trial.grade;
  const bool detected = !v.verdict.empty() && v.verdict != "adequate";
  const bool claims = claims_names(v) && !v.causes.empty();
  const bool exact = claims && is_truth(v.causes.front(), fault);
  score.cells[Metric::kDetected][grade].add(detected);
  score.cells[Metric::kInGroup][grade].add(is_in_group(v, fault, kLargestGroup));
  score.cells[Metric::kInPrintedGroup][grade].add(
      is_in_group(v, fault, std::numeric_limits<std::size_t>::max()));
  score.cells[Metric::kAloneRight][grade].add(exact && count_names(v) == 1);
  score.cells[Metric::kExact][grade].add(exact);
  if (grade <= 'B') {
    score.probability_on_truth.push_back(find_probability(v, fault));
    if (claims) score.names.push_back(static_cast<double>(count_names(v)));
  }
  add_explained(v, grade, score);
  if (exact && !fault.parameter.empty()) add_effect(fault, v.causes.front(), grade, score);
}

void add_two(const TrueTrial& trial, const Verdict& v, Score& score) {
  int right = 0;
  for (const TrueFault& fault : trial.faults) right += is_in_group(v, fault, count_allowed(trial));
  // Both are asked for where no other pair explains the data as well.
  const char grade = std::max(trial.grade, find_grade(trial.beyond_two));
  score.cells[Metric::kBothNamed][grade].add(right == 2);
  score.cells[Metric::kOneOfTwoNamed][trial.grade].add(right >= 1);
}

void add_unknown(const TrueTrial& trial, const Verdict& v, Score& score) {
  const bool flagged = is_flagged(v);
  // A cause that a known one imitates cannot be flagged.
  const char grade = find_grade(trial.beyond_one);
  score.cells[Metric::kUnknownFlagged][grade].add(flagged);
  score.cells[Metric::kMapExplained70][grade].add(flagged && v.map_share.value_or(0.0) >= 0.70);
  if (flagged) {
    score.cells[Metric::kUnknownPlaced][grade].add(v.place == trial.faults.front().where);
  }
}

/// More wrong causes with confidence than hidden effects that the group holds in their stead.
bool is_wrong_confident(const TrueTrial& trial, const Verdict& v) {
  if (!claims_names(v)) return false;
  const auto wrong = std::count_if(v.causes.begin(), v.causes.end(), [&](const Claim& c) {
    return c.probability > kConfident &&
           std::none_of(trial.faults.begin(), trial.faults.end(),
                        [&](const TrueFault& f) { return is_truth(c, f); });
  });
  const auto grouped =
      std::count_if(trial.faults.begin(), trial.faults.end(), [&](const TrueFault& f) {
        return !names(v.causes, f) && is_in_group(v, f, count_allowed(trial));
      });
  return wrong > grouped;
}

/// Counts the errors that any trial may have.
void add_claims(const TrueTrial& trial, const Verdict& v, Score& score) {
  score.cells[Metric::kWrongConfident][trial.grade].add(is_wrong_confident(trial, v));
  const bool claims = claims_names(v) && !v.causes.empty();
  if (claims) {
    const std::vector<Claim> first = list_first(v);
    score.confidence.emplace_back(sum_probabilities(first),
                                  std::any_of(trial.faults.begin(), trial.faults.end(),
                                              [&](const TrueFault& f) { return names(first, f); }));
  }
  // Effects below the detection limit are left out, and pairs, which have several right answers.
  const bool is_seen = trial.grade != 'D' && trial.category != "two";
  if (is_seen && (trial.category != "unknown" || find_grade(trial.beyond_one) != 'D')) {
    score.surprise.push_back(-std::log(std::max(find_probability(trial, v), kLeastProbability)));
  }
  if (trial.grade == 'D') {
    score.cells[Metric::kOverclaimed]['D'].add(claims && v.verdict != "group" &&
                                               v.causes.front().probability > kConfident);
  }
}

/// Counts a trial without a verdict in the scores of claims, which would otherwise skip it.
void add_missing(const TrueTrial& trial, Score& score) {
  ++score.missing;
  const char grade = trial.grade;
  score.cells[Metric::kWrongConfident][grade].add(true);
  score.confidence.emplace_back(1.0, false);
  score.surprise.push_back(-std::log(kLeastProbability));
  if (grade == 'D') score.cells[Metric::kOverclaimed]['D'].add(true);
  if (trial.category == "unknown") {
    score.cells[Metric::kUnknownPlaced][find_grade(trial.beyond_one)].add(false);
  }
  const bool one = trial.category == "one";
  if (one && !trial.faults.front().parameter.empty()) {
    score.cells[Metric::kEffectCovered][grade].add(false);
    score.cells[Metric::kEffectWithin10][grade].add(false);
    score.effect_error.push_back(kMissingError);
  }
  for (const auto& [name, truth] : trial.parameters) {
    score.cells[Metric::kBaseCovered][grade].add(false);
    if (!is_strut_rate(name)) continue;
    add_error(trial, one, {kMissingError, kMissingPull, kMissingPull}, score);
  }
}

std::string describe(const Claim& c) {
  std::array<char, 16> probability{};
  std::snprintf(probability.data(), probability.size(), " %.2f", c.probability);
  return " " + c.effect + (c.place.empty() ? "" : "@") + c.place + probability.data();
}

std::string describe(const TrueTrial& trial, const Verdict& v) {
  std::string line = trial.name + " " + trial.grade + ": ";
  if (trial.faults.empty()) line += "nothing hidden";
  for (const TrueFault& f : trial.faults) {
    line += (&f == &trial.faults.front() ? "" : " + ") + f.fault + (f.place.empty() ? "" : " ") +
            f.place;
  }
  line += "; said: " + (v.verdict.empty() ? std::string("nothing") : v.verdict);
  for (const Claim& c : v.causes) line += describe(c);
  constexpr std::size_t kListed = 3;
  const auto add = [&](const char* title, const std::vector<Claim>& claims) {
    for (std::size_t i = 0; i < std::min(claims.size(), kListed); ++i) {
      line += (i == 0 ? title : ",") + describe(claims[i]);
    }
  };
  add("; group:", v.group);
  add("; then:", v.runners_up);
  return line;
}

bool is_failure(const TrueTrial& trial, const Verdict& v) {
  const bool adequate = v.verdict == "adequate";
  if (trial.category == "none") return !adequate;
  if (trial.grade == 'D' && adequate) return false;
  if (trial.category == "unknown") return !is_flagged(v);
  return !std::all_of(trial.faults.begin(), trial.faults.end(),
                      [&](const TrueFault& f) { return is_in_group(v, f, count_allowed(trial)); });
}

double calc_rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

double calc_mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// Quantile by nearest rank; 0 without values.
double calc_quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const auto rank =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  return values[rank];
}

}  // namespace

const char* get_name(Metric metric) {
  constexpr std::array<const char*, static_cast<std::size_t>(Metric::kCount)> kNames = {
      "false alarm",
      "detected",
      "truth in group",
      "truth in printed group",
      "named alone and right",
      "exact effect and place",
      "unknown flagged",
      "unknown placed",
      "two: both named",
      "two: one named",
      "wrong, confident",
      "overclaimed",
      "effect covered 95 %",
      "effect within 10 %",
      "baseline covered 95 %",
      "one: 95 % explained on hold-out",
      "one: 80 % explained on hold-out",
      "unknown: 70 % explained on hold-out"};
  return kNames[static_cast<std::size_t>(metric)];
}

const std::vector<Gate>& list_gates() {
  static const std::vector<Gate> gates = {
      {Metric::kFalseAlarm, "-", 0.01, false},
      {Metric::kDetected, "AB", 0.99, true},
      {Metric::kDetected, "C", 0.80, true},
      {Metric::kInGroup, "A", 0.98, true},
      {Metric::kInGroup, "B", 0.95, true},
      {Metric::kInGroup, "C", 0.80, true},
      {Metric::kInPrintedGroup, "AB", 0.99, true},
      {Metric::kExact, "AB", 0.90, true},
      {Metric::kUnknownFlagged, "A", 0.95, true},
      {Metric::kUnknownFlagged, "B", 0.85, true},
      {Metric::kUnknownPlaced, "AB", 0.85, true},
      {Metric::kWrongConfident, "ABCD-", 0.02, false},
      {Metric::kBothNamed, "AB", 0.70, true},
      {Metric::kOneOfTwoNamed, "AB", 0.95, true},
      {Metric::kOverclaimed, "D", 0.10, false},
      // Intervals of 95 %: those that nearly always cover are too wide.
      {Metric::kEffectCovered, "AB", 0.90, true},
      {Metric::kEffectCovered, "AB", 0.98, false},
      {Metric::kBaseCovered, "ABCD-", 0.90, true},
      {Metric::kBaseCovered, "ABCD-", 0.98, false},
      // Median and 10 % quantile as proportions: at least 50 or 90 % explain so much.
      {Metric::kExplained95, "AB", 0.50, true},
      {Metric::kExplained80, "AB", 0.90, true},
      {Metric::kMapExplained70, "AB", 0.50, true},
  };
  return gates;
}

Score calc_score(const std::vector<TrueTrial>& trials,
                 const std::map<std::string, Verdict>& verdicts) {
  Score score;
  for (const TrueTrial& trial : trials) {
    const auto found = verdicts.find(trial.name);
    const Verdict v = found == verdicts.end() ? Verdict{} : found->second;
    ++score.contents[trial.category][trial.grade];
    const bool named = trial.category == "one" && v.verdict == "named" && !v.causes.empty() &&
                       is_truth(v.causes.front(), trial.faults.front());
    if (trial.category == "none") {
      score.cells[Metric::kFalseAlarm]['-'].add(v.verdict != "adequate");
    } else if (trial.category == "one") {
      add_one(trial, v, score);
    } else if (trial.category == "two") {
      add_two(trial, v, score);
    } else {
      add_unknown(trial, v, score);
    }
    if (v.verdict.empty()) {
      add_missing(trial, score);
    } else {
      add_claims(trial, v, score);
      add_baseline(trial, v, named, score);
    }
    if (is_failure(trial, v)) score.failures.push_back(describe(trial, v));
  }
  return score;
}

double calc_calibration_error(const std::vector<std::pair<double, bool>>& confidence) {
  constexpr std::size_t kBins = 10;
  std::array<double, kBins> sum{}, right{};
  for (const auto& [p, correct] : confidence) {
    const auto bin = std::min(static_cast<std::size_t>(std::max(p, 0.0) * kBins), kBins - 1);
    sum[bin] += p;
    right[bin] += correct ? 1.0 : 0.0;
  }
  double error = 0.0;
  for (std::size_t b = 0; b < kBins; ++b) error += std::fabs(sum[b] - right[b]);
  return confidence.empty() ? 0.0 : error / static_cast<double>(confidence.size());
}

Cell pool(const Score& score, Metric metric, const std::string& grades) {
  Cell sum;
  const auto found = score.cells.find(metric);
  if (found == score.cells.end()) return sum;
  for (const auto& [grade, cell] : found->second) {
    if (grades.find(grade) == std::string::npos) continue;
    sum.hits += cell.hits;
    sum.total += cell.total;
  }
  return sum;
}

bool is_size_fixed(Metric metric) {
  switch (metric) {
    case Metric::kUnknownPlaced:
    case Metric::kEffectCovered:
    case Metric::kEffectWithin10:
    case Metric::kBaseCovered:
    case Metric::kExplained95:
    case Metric::kExplained80:
      return false;
    default:
      return true;
  }
}

bool passes(const Gate& gate, const Cell& cell) {
  const Interval i = calc_wilson(cell.hits, cell.total);
  return gate.at_least ? i.high >= gate.target : i.low <= gate.target;
}

std::vector<Quantity> list_quantities(const Score& score) {
  const auto calc_median_size = [](std::vector<double> values) {
    for (double& v : values) v = std::fabs(v);
    return calc_quantile(std::move(values), 0.5);
  };
  const auto calc_surprise_of_two = [](std::size_t count) {
    return count > 0 ? -2.0 * std::log(kLeastProbability) / static_cast<double>(count) : 0.0;
  };
  return {{"mean probability on the truth, A and B", calc_mean(score.probability_on_truth),
           score.probability_on_truth.size(), 0.85, true},
          {"names in cause and group, A and B: mean", calc_mean(score.names), score.names.size(),
           static_cast<double>(kLargestGroup), false},
          // 0 where nothing is hidden and the verdict is adequate.
          {"-ln of the truth's probability: mean", calc_mean(score.surprise), score.surprise.size(),
           0.25, false, calc_surprise_of_two(score.surprise.size())},
          {"calibration error of first causes", calc_calibration_error(score.confidence),
           score.confidence.size(), 0.07, false},
          {"stiffness and damping, named, smooth: rms relative", calc_rms(score.smooth_error),
           score.smooth_error.size(), 0.003, false},
          {"stiffness and damping, named, road of class A: rms relative",
           calc_rms(score.rough_error), score.rough_error.size(), 0.01, false},
          {"stiffness and damping, nothing hidden: rms over the stated 1 sigma",
           calc_rms(score.null_pull), score.null_pull.size(), 1.2, false},
          // 1.4 for cars and 1.15 for stands, in the table's shares.
          {"stiffness and damping, nothing hidden: rms over the Cramer-Rao bound",
           calc_rms(score.null_excess), score.null_excess.size(), 1.24, false},
          {"stiffness and damping, nothing hidden: rms relative", calc_rms(score.null_error),
           score.null_error.size(), 0.01, false},
          {"effect's parameter, named exactly: median relative error",
           calc_median_size(score.effect_error), score.effect_error.size(), 0.1, false}};
}

}  // namespace strut::hidden
