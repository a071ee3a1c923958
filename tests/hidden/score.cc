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

/// A lost stroke and a worn joint are one motion in two sizes: the catalogue says so.
std::string merge_aliases(const std::string& effect) {
  return effect == "joint_play" ? "damper_leak" : effect;
}

bool is_truth(const Claim& claim, const TrueFault& fault) {
  return !fault.effect.empty() && merge_aliases(claim.effect) == merge_aliases(fault.effect) &&
         claim.place == fault.place;
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

bool is_in_group(const Verdict& v, const TrueFault& fault, std::size_t allowed) {
  return count_names(v) <= allowed && (names(v.causes, fault) || names(v.group, fault));
}

double find_probability(const Verdict& v, const TrueFault& fault) {
  for (const auto* list : {&v.causes, &v.group, &v.runners_up}) {
    for (const Claim& c : *list) {
      if (is_truth(c, fault)) return c.probability;
    }
  }
  return 0.0;
}

/// Effects with an alias that no run of the kits tells apart.
bool is_splittable(const TrueFault& fault) {
  static const std::set<std::string> kAliases = {"sensor_delay", "sensor_lowpass", "damper_leak",
                                                 "joint_play", "strut_friction"};
  return kAliases.count(fault.effect) == 0;
}

bool says_place(const Verdict& v, const TrueFault& fault) {
  if (fault.place.empty()) return true;
  const auto there = [&](const Claim& c) { return c.place == fault.place; };
  return std::any_of(v.causes.begin(), v.causes.end(), there) ||
         v.where.find(fault.place) != std::string::npos;
}

bool explains(const Verdict& v, double share) { return v.has_gain && v.explained >= share; }

bool is_strut_rate(const std::string& name) {
  return name.find("tire") == std::string::npos &&
         (name.find("stiffness") != std::string::npos || name.find("damping") != std::string::npos);
}

void add_baseline(const TrueTrial& trial, const Verdict& v, bool named, Score& score) {
  for (const auto& [name, truth] : trial.parameters) {
    const auto found = v.after.find(name);
    if (found == v.after.end()) continue;
    const Estimate& e = found->second;
    score.cells[Metric::kBaseCovered][trial.grade].add(e.low <= truth && truth <= e.high);
    if (!is_strut_rate(name)) continue;
    const double error = e.value / truth - 1.0, sigma = (e.high - e.low) / (2.0 * 1.96);
    if (trial.category == "none") {
      score.null_error.push_back(error);
      if (sigma > 0.0) score.null_pull.push_back((e.value - truth) / sigma);
    }
    if (!named) continue;
    constexpr double kSmooth = 1e-6, kClassA = 16e-6;  // m^3
    if (trial.roughness <= kSmooth) score.smooth_error.push_back(error);
    if (trial.roughness == kClassA) score.rough_error.push_back(error);
  }
}

void add_one(const TrueTrial& trial, const Verdict& v, Score& score) {
  const TrueFault& fault = trial.faults.front();
  const char grade = trial.grade;
  const bool claimed = !v.verdict.empty() && v.verdict != "adequate";
  const bool in_group = claimed && is_in_group(v, fault, kLargestGroup);
  const bool exact = claimed && !v.causes.empty() && is_truth(v.causes.front(), fault);
  score.cells[Metric::kDetected][grade].add(claimed);
  score.cells[Metric::kInGroup][grade].add(in_group);
  score.cells[Metric::kInPrintedGroup][grade].add(
      claimed && is_in_group(v, fault, std::numeric_limits<std::size_t>::max()));
  if (is_splittable(fault)) score.cells[Metric::kExact][grade].add(exact);
  if (grade <= 'B') score.probability_on_truth.push_back(find_probability(v, fault));
  score.cells[Metric::kExplained95][grade].add(explains(v, 0.95));
  score.cells[Metric::kExplained80][grade].add(explains(v, 0.80));
  if (!exact || fault.parameter.empty()) return;
  const auto found = v.causes.front().parameters.find(fault.parameter);
  if (found == v.causes.front().parameters.end()) return;
  const Estimate& e = found->second;
  score.effect_error.push_back(e.value / fault.magnitude - 1.0);
  score.cells[Metric::kEffectCovered][grade].add(e.low <= fault.magnitude &&
                                                 fault.magnitude <= e.high);
}

void add_two(const TrueTrial& trial, const Verdict& v, Score& score) {
  int right = 0;
  for (const TrueFault& fault : trial.faults) right += is_in_group(v, fault, 2 * kLargestGroup);
  score.cells[Metric::kBothNamed][trial.grade].add(right == 2);
  score.cells[Metric::kOneOfTwoNamed][trial.grade].add(right >= 1);
}

void add_unknown(const TrueTrial& trial, const Verdict& v, Score& score) {
  const bool flagged = v.verdict == "unknown" || v.verdict == "form_incomplete";
  score.cells[Metric::kUnknownFlagged][trial.grade].add(flagged);
  score.cells[Metric::kMapExplained70][trial.grade].add(explains(v, 0.70));
  if (flagged) {
    score.cells[Metric::kUnknownPlaced][trial.grade].add(says_place(v, trial.faults.front()));
  }
}

/// What any trial may get wrong. Returns whether the first cause is right.
void add_claims(const TrueTrial& trial, const Verdict& v, Score& score) {
  // Who says form_incomplete does not insist on the name.
  const bool insists = v.verdict == "named" || v.verdict == "group";
  const bool claims = insists && !v.causes.empty();
  bool right = false, grouped = false;
  for (const TrueFault& fault : trial.faults) {
    right = right || (claims && is_truth(v.causes.front(), fault));
    grouped = grouped || is_in_group(v, fault, 2 * kLargestGroup);
  }
  const bool confident = claims && v.causes.front().probability > kConfident;
  score.cells[Metric::kWrongConfident][trial.grade].add(confident && !right && !grouped);
  if (claims) score.confidence.emplace_back(v.causes.front().probability, right);
  if (trial.grade == 'D') {
    score.cells[Metric::kOverclaimed]['D'].add(confident && v.verdict == "named");
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
  if (trial.category == "unknown") return v.verdict != "unknown" && v.verdict != "form_incomplete";
  return !std::all_of(trial.faults.begin(), trial.faults.end(),
                      [&](const TrueFault& f) { return is_in_group(v, f, 2 * kLargestGroup); });
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

/// Value below which the share lies, nearest rank; 0 for nothing.
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
      "exact effect and place",
      "unknown flagged",
      "unknown placed",
      "two: both named",
      "two: one named",
      "wrong, confident",
      "overclaimed",
      "effect covered 95 %",
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
      {Metric::kUnknownFlagged, "AB", 0.95, true},
      {Metric::kUnknownPlaced, "AB", 0.85, true},
      {Metric::kWrongConfident, "ABCD-", 0.02, false},
      {Metric::kBothNamed, "AB", 0.70, true},
      {Metric::kOneOfTwoNamed, "AB", 0.95, true},
      {Metric::kOverclaimed, "D", 0.10, false},
      {Metric::kEffectCovered, "AB", 0.90, true},
      // Medians and a tenth as proportions: at least half, or nine tenths, explain so much.
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
    if (v.verdict.empty()) ++score.missing;
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
    add_claims(trial, v, score);
    add_baseline(trial, v, named, score);
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

bool passes(const Gate& gate, const Cell& cell) {
  const Interval i = calc_wilson(cell.hits, cell.total);
  return gate.at_least ? i.high >= gate.target : i.low <= gate.target;
}

std::vector<Quantity> list_quantities(const Score& score) {
  const auto calc_median_size = [](std::vector<double> values) {
    for (double& v : values) v = std::fabs(v);
    return calc_quantile(std::move(values), 0.5);
  };
  return {{"mean probability on the truth, A and B", calc_mean(score.probability_on_truth),
           score.probability_on_truth.size(), 0.85, true},
          {"calibration error of first causes", calc_calibration_error(score.confidence),
           score.confidence.size(), 0.05, false},
          {"stiffness and damping, named, smooth: rms relative", calc_rms(score.smooth_error),
           score.smooth_error.size(), 0.003, false},
          {"stiffness and damping, named, road of class A: rms relative",
           calc_rms(score.rough_error), score.rough_error.size(), 0.01, false},
          {"stiffness and damping, nothing hidden: rms over the stated 1 sigma",
           calc_rms(score.null_pull), score.null_pull.size(), 1.2, false},
          {"stiffness and damping, nothing hidden: rms relative", calc_rms(score.null_error),
           score.null_error.size(), 0.01, false},
          {"effect's parameter, named exactly: median relative error",
           calc_median_size(score.effect_error), score.effect_error.size(), 0.1, false}};
}

}  // namespace strut::hidden
