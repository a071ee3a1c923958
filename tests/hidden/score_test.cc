// The scorer: intervals, and who wins and loses.
#include "tests/hidden/score.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "tests/hidden/sha256.h"
#include "tests/temporary_folder.h"
#include "tests/tolerance.h"

namespace strut::hidden {
namespace {

using test::tolerance;

/// 78 trials in the shares of the protocol, every grade among those that hide something.
std::vector<TrueTrial> make_trials() {
  std::vector<TrueTrial> trials;
  const auto add = [&](const std::string& category, std::vector<TrueFault> faults) {
    TrueTrial t;
    t.name = std::to_string(trials.size());
    t.category = category;
    t.faults = std::move(faults);
    const char grade = "ABCD"[trials.size() % 4];
    for (TrueFault& f : t.faults) f.grade = grade;
    t.grade = t.faults.empty() ? '-' : grade;
    t.parameters = {{"front_stiffness", 20000.0}};
    trials.push_back(t);
  };
  const TrueFault asymmetry{"", "damper_asymmetry", "rear", "asymmetry", 0.3, 'A'};
  const TrueFault payload{"", "payload", "body", "mass", 40.0, 'A'};
  const TrueFault stranger{"engine", "", "body", "", 1.0, 'A'};
  for (int i = 0; i < 30; ++i) add("none", {});
  for (int i = 0; i < 28; ++i) add("one", {i % 2 == 0 ? asymmetry : payload});
  for (int i = 0; i < 10; ++i) add("two", {asymmetry, payload});
  for (int i = 0; i < 10; ++i) add("unknown", {stranger});
  return trials;
}

Claim make_claim(const TrueFault& fault, double probability) {
  Claim claim{fault.effect, fault.place, probability, {}};
  claim.parameters[fault.parameter] = {fault.magnitude, 0.9 * fault.magnitude,
                                       1.1 * fault.magnitude};
  return claim;
}

Verdict make_perfect(const TrueTrial& trial) {
  Verdict v;
  v.after["front_stiffness"] = {20000.0, 19900.0, 20100.0};
  v.verdict = "adequate";
  if (trial.category == "none") return v;
  v.verdict = "unknown";
  v.where = "body";
  if (trial.category == "unknown") return v;
  // What is hardly visible is not insisted on.
  v.verdict = trial.grade == 'D' ? "group" : "named";
  for (const TrueFault& f : trial.faults) {
    v.causes.push_back(make_claim(f, trial.grade == 'D' ? 0.6 : 0.95));
  }
  return v;
}

template <class Make>
Score score_all(const Make& make) {
  const std::vector<TrueTrial> trials = make_trials();
  std::map<std::string, Verdict> verdicts;
  for (const TrueTrial& t : trials) verdicts[t.name] = make(t);
  return calc_score(trials, verdicts);
}

bool is_passed(const Score& score) {
  bool passed = false;
  make_report(score, passed);
  return passed;
}

}  // namespace

TEST_CASE("Hidden data: Wilson's interval solves its equation", "[reference]") {
  const double z = 1.959963984540054;
  for (const auto& [hits, total] : {std::pair{3, 10}, {57, 60}, {150, 300}}) {
    const Interval i = calc_wilson(hits, total);
    const double p = static_cast<double>(hits) / total;
    for (const double end : {i.low, i.high}) {
      CHECK(std::fabs(p - end) ==
            Approx(z * std::sqrt(end * (1.0 - end) / total)).epsilon(tolerance(1e-12)));
    }
  }
  // The bounds that the protocol quotes.
  CHECK(calc_wilson(60, 60).low == Approx(0.94).margin(tolerance(1e-3)));
  CHECK(calc_wilson(280, 280).low == Approx(0.986).margin(tolerance(1e-3)));
  CHECK(calc_wilson(0, 0).low == 0.0);
  CHECK(calc_wilson(0, 0).high == 1.0);
}

TEST_CASE("Hidden data: who is always right passes", "[unit]") {
  const Score score = score_all(make_perfect);
  CHECK(score.failures.empty());
  CHECK(is_passed(score));
  CHECK(pool(score, Metric::kInGroup, "ABCD").total == 28);
  CHECK(pool(score, Metric::kUnknownPlaced, "ABCD").hits == 10);
  CHECK(pool(score, Metric::kBaseCovered, "ABCD-").hits == 78);
}

TEST_CASE("Hidden data: who always names an effect loses", "[unit]") {
  // Even one that happens to be right whenever something of the catalogue is hidden.
  const Score score = score_all([](const TrueTrial& trial) {
    Verdict v = make_perfect(trial);
    if (!v.causes.empty()) return v;
    v.verdict = "named";
    v.causes = {{"damper_asymmetry", "front", 0.95, {}}};
    return v;
  });
  CHECK_FALSE(is_passed(score));
  CHECK(pool(score, Metric::kFalseAlarm, "-").hits == 30);
  CHECK(pool(score, Metric::kWrongConfident, "ABCD-").hits == 40);
  CHECK_FALSE(passes(list_gates()[0], pool(score, Metric::kFalseAlarm, "-")));
}

TEST_CASE("Hidden data: who always says adequate loses", "[unit]") {
  const Score score = score_all([](const TrueTrial&) {
    Verdict v;
    v.verdict = "adequate";
    return v;
  });
  CHECK_FALSE(is_passed(score));
  CHECK(pool(score, Metric::kFalseAlarm, "-").hits == 0);
  CHECK(pool(score, Metric::kDetected, "AB").hits == 0);
}

TEST_CASE("Hidden data: who puts everything into one group names nothing", "[unit]") {
  const Score score = score_all([](const TrueTrial& trial) {
    Verdict v = make_perfect(trial);
    if (trial.category != "one") return v;
    v.verdict = "group";
    for (const char* other : {"a", "b", "c", "d"}) v.group.push_back({other, "rear", 0.1, {}});
    return v;
  });
  CHECK(pool(score, Metric::kInGroup, "ABCD").hits == 0);
  CHECK_FALSE(is_passed(score));
}

TEST_CASE("Hidden data: front for rear is wrong", "[unit]") {
  const Score score = score_all([](const TrueTrial& trial) {
    Verdict v = make_perfect(trial);
    for (Claim& c : v.causes) c.place = c.place == "rear" ? "front" : c.place;
    return v;
  });
  CHECK(pool(score, Metric::kInGroup, "ABCD").hits == 14);
  CHECK(pool(score, Metric::kBothNamed, "ABCD").hits == 0);
  CHECK(pool(score, Metric::kOneOfTwoNamed, "ABCD").hits == 10);
}

TEST_CASE("Hidden data: a missing verdict counts against the tool", "[unit]") {
  const std::vector<TrueTrial> trials = make_trials();
  std::map<std::string, Verdict> verdicts;
  for (const TrueTrial& t : trials) verdicts[t.name] = make_perfect(t);
  verdicts.erase("0");
  const Score score = calc_score(trials, verdicts);
  CHECK(score.missing == 1);
  CHECK(pool(score, Metric::kFalseAlarm, "-").hits == 1);
  CHECK_FALSE(is_passed(score));
}

TEST_CASE("Hidden data: the calibration error is the gap between claimed and right", "[unit]") {
  std::vector<std::pair<double, bool>> confidence;
  confidence.reserve(10);
  for (int i = 0; i < 10; ++i) confidence.emplace_back(0.75, i < 5);
  CHECK(calc_calibration_error(confidence) == Approx(0.25).margin(tolerance(1e-12)));
  CHECK(calc_calibration_error({}) == 0.0);
}

TEST_CASE("Hidden data: a truth that was touched is refused, an untouched one read", "[io]") {
  const test::TemporaryFolder folder;
  const std::string text =
      "{\"seed\": 1, \"kit\": \"car\", \"category\": \"one\", \"grade\": \"B\",\n"
      "\"faults\": [{\"fault\": \"f\", \"effect\": \"payload\", \"place\": \"body\", "
      "\"magnitude\": 20.5, \"parameter\": \"mass\", \"ratio\": 12.0, \"grade\": \"B\"}],\n"
      "\"parameters\": {\"front_stiffness\": 20000.0}}\n";
  std::ofstream(folder / "000001.json") << text;
  std::ofstream(folder / "SHA256SUMS") << calc_sha256(text) << "  000001.json\n";
  const std::filesystem::path place = std::filesystem::path(folder / "SHA256SUMS").parent_path();
  const auto trials = read_truths(place);
  REQUIRE(trials.size() == 1);
  CHECK(trials[0].faults.at(0).magnitude == 20.5);
  CHECK(trials[0].grade == 'B');
  std::ofstream(folder / "000001.json") << text << " ";
  CHECK_THROWS_WITH(read_truths(place), Catch::Contains("000001.json"));
}

TEST_CASE("Hidden data: a verdict is read as the interface writes it", "[io]") {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "verdict.json")
      << "{\"verdict\": \"named\", \"causes\": [{\"effect\": \"damper_asymmetry\", \"place\": "
         "\"rear\", \"probability\": 0.96, \"parameters\": {\"asymmetry\": {\"value\": 0.31, "
         "\"ci95\": [0.29, 0.33], \"unit\": \"1\"}}}], \"group\": [], \"runners_up\": "
         "[{\"effect\": "
         "\"bump_stop\", \"place\": \"rear\", \"probability\": 0.02}], \"unknown_share\": 0.01, "
         "\"where\": {\"depends_on\": \"rear suspension velocity\"}, \"parameters\": {\"after\": "
         "{\"front_stiffness\": {\"value\": 1.0, \"ci95\": [0.5, 1.5]}}}, \"gain\": "
         "{\"explained\": "
         "0.95}}";
  const Verdict v = read_verdict(folder / "verdict.json");
  CHECK(v.verdict == "named");
  REQUIRE(v.causes.size() == 1);
  CHECK(v.causes[0].parameters.at("asymmetry").high == 0.33);
  CHECK(v.runners_up.at(0).probability == 0.02);
  CHECK(v.where.find("velocity") != std::string::npos);
  CHECK(v.after.at("front_stiffness").low == 0.5);
  CHECK(v.explained == 0.95);
}

}  // namespace strut::hidden
