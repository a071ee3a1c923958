// The scorer: intervals, and who wins and loses.
#include "tests/hidden/score.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "tests/hidden/limits.h"
#include "tests/hidden/report.h"
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
  v.has_gain = true;
  v.explained = 0.8;
  if (trial.category == "unknown") return v;
  // What is hardly visible is not insisted on.
  v.verdict = trial.grade == 'D' ? "group" : "named";
  for (const TrueFault& f : trial.faults) {
    v.causes.push_back(make_claim(f, 0.99));
  }
  v.has_gain = true;
  v.explained = 0.97;
  return v;
}

using Verdicts = std::map<std::string, Verdict>;

template <class Make>
Verdicts answer_all(const std::vector<TrueTrial>& trials, const Make& make) {
  Verdicts verdicts;
  for (const TrueTrial& t : trials) verdicts[t.name] = make(t);
  return verdicts;
}

template <class Make>
Score score_all(const Make& make) {
  const std::vector<TrueTrial> trials = make_trials();
  return calc_score(trials, answer_all(trials, make));
}

bool is_passed(const Verdicts& verdicts) {
  bool passed = false;
  make_report(make_trials(), verdicts, passed);
  return passed;
}

template <class Make>
bool passes_all(const Make& make) {
  return is_passed(answer_all(make_trials(), make));
}

Verdict say_adequate(const TrueTrial&) {
  Verdict v;
  v.verdict = "adequate";
  return v;
}

/// Right whenever something of the catalogue is hidden, and names the front damper else.
Verdict always_name(const TrueTrial& trial) {
  Verdict v = make_perfect(trial);
  if (!v.causes.empty()) return v;
  v.verdict = "named";
  v.causes = {{"damper_asymmetry", "front", 0.95, {}}};
  return v;
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
  CHECK(passes_all(make_perfect));
  CHECK(pool(score, Metric::kInGroup, "ABCD").total == 28);
  CHECK(pool(score, Metric::kUnknownPlaced, "ABCD").hits == 10);
  CHECK(pool(score, Metric::kBaseCovered, "ABCD-").hits == 78);
}

TEST_CASE("Hidden data: who always names an effect loses", "[unit]") {
  const Score score = score_all(always_name);
  CHECK_FALSE(passes_all(always_name));
  CHECK(pool(score, Metric::kFalseAlarm, "-").hits == 30);
  CHECK(pool(score, Metric::kWrongConfident, "ABCD-").hits == 40);
  CHECK_FALSE(passes(list_gates()[0], pool(score, Metric::kFalseAlarm, "-")));
}

TEST_CASE("Hidden data: who always says adequate loses", "[unit]") {
  const Score score = score_all(say_adequate);
  CHECK_FALSE(passes_all(say_adequate));
  CHECK(pool(score, Metric::kFalseAlarm, "-").hits == 0);
  CHECK(pool(score, Metric::kDetected, "AB").hits == 0);
}

TEST_CASE("Hidden data: who puts everything into one group names nothing", "[unit]") {
  const auto group = [](const TrueTrial& trial) {
    Verdict v = make_perfect(trial);
    if (trial.category != "one") return v;
    v.verdict = "group";
    for (const char* other : {"a", "b", "c", "d"}) v.group.push_back({other, "rear", 0.1, {}});
    return v;
  };
  const Score score = score_all(group);
  CHECK(pool(score, Metric::kInGroup, "ABCD").hits == 0);
  CHECK(pool(score, Metric::kInPrintedGroup, "ABCD").hits == 28);
  CHECK_FALSE(passes_all(group));
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
  Verdicts verdicts = answer_all(trials, make_perfect);
  verdicts.erase("0");
  const Score score = calc_score(trials, verdicts);
  CHECK(score.missing == 1);
  CHECK(pool(score, Metric::kFalseAlarm, "-").hits == 1);
  CHECK_FALSE(is_passed(verdicts));
}

TEST_CASE("Hidden data: the calibration error is the gap between claimed and right", "[unit]") {
  std::vector<std::pair<double, bool>> confidence;
  confidence.reserve(10);
  for (int i = 0; i < 10; ++i) confidence.emplace_back(0.75, i < 5);
  CHECK(calc_calibration_error(confidence) == Approx(0.25).margin(tolerance(1e-12)));
  CHECK(calc_calibration_error({}) == 0.0);
}

TEST_CASE("Hidden data: right answers to other trials are wrong", "[unit]") {
  const std::vector<TrueTrial> trials = make_trials();
  for (const Impostor& impostor : make_impostors(trials, answer_all(trials, make_perfect))) {
    INFO(impostor.name);
    CHECK(impostor.verdicts.size() == trials.size());
    CHECK_FALSE(is_passed(impostor.verdicts));
  }
  // Shuffled: what is named is as often right as a name drawn from the hat, two kinds in 78.
  const Impostor shuffled = make_impostors(trials, answer_all(trials, make_perfect)).back();
  const Cell named = pool(calc_score(trials, shuffled.verdicts), Metric::kInGroup, "ABCD");
  CHECK(named.total == 28);
  CHECK(named.hits < 14);
}

TEST_CASE("Hidden data: a lost stroke and a worn joint are one answer", "[unit]") {
  TrueTrial trial;
  trial.name = "1";
  trial.category = "one";
  trial.grade = 'A';
  trial.faults = {{"worn joint", "joint_play", "rear", "play", 1e-3, 'A'}};
  const auto ask = [&](const std::string& effect) {
    Verdict v;
    v.verdict = "named";
    v.causes = {{effect, "rear", 0.99, {}}};
    return pool(calc_score({trial}, {{"1", v}}), Metric::kInGroup, "A").hits;
  };
  CHECK(ask("damper_leak") == 1);
  CHECK(ask("joint_play") == 1);
  CHECK(ask("strut_friction") == 0);
}

TEST_CASE("Hidden data: an unknown cause is not named by a claim without a name", "[unit]") {
  const Score score = score_all([](const TrueTrial& trial) {
    Verdict v = make_perfect(trial);
    if (trial.category != "unknown") return v;
    v.verdict = "named";
    v.causes = {{"", "body", 0.99, {}}};
    return v;
  });
  CHECK(pool(score, Metric::kWrongConfident, "ABCD").hits == 10);
}

TEST_CASE("Hidden data: limits pass the tool they were set by and one as good", "[unit]") {
  const std::vector<TrueTrial> trials = make_trials();
  Verdicts verdicts = answer_all(trials, make_perfect);
  const Limits limits = make_limits(calc_score(trials, verdicts));
  CHECK(find_misses(limits, calc_score(trials, verdicts)).empty());
  // 0 of 30: Wilson's interval of half a standard deviation ends at 0.25 / 30.25, 0.25 of 30.
  REQUIRE(limits.limits.front().score == get_name(Metric::kFalseAlarm));
  CHECK(limits.limits.front().count == 1);
  verdicts["0"] = always_name(trials[0]);
  CHECK(find_misses(limits, calc_score(trials, verdicts)).empty());
  verdicts["1"] = always_name(trials[1]);
  const auto misses = find_misses(limits, calc_score(trials, verdicts));
  REQUIRE(misses.size() == 2);  // the second false alarm, and the second confident wrong name
  CHECK_THAT(misses[0], Catch::Contains("false alarm (-): at most 1 of 30, measured 2 of 30"));
  CHECK_THAT(misses[1], Catch::Contains("wrong, confident (ABCD-): at most 1 of 78"));
  // 28 of 28 in the group: none of them may be lost but one a grade.
  const Cell named = pool(calc_score(trials, verdicts), Metric::kInGroup, "A");
  const auto group = std::find_if(limits.limits.begin(), limits.limits.end(), [](const Limit& l) {
    return l.score == get_name(Metric::kInGroup) && l.grades == "A";
  });
  REQUIRE(group != limits.limits.end());
  CHECK(group->count == named.total - 1);
}

TEST_CASE("Hidden data: limits fail missing verdicts and other trials", "[unit]") {
  std::vector<TrueTrial> trials = make_trials();
  Verdicts verdicts = answer_all(trials, make_perfect);
  const Limits limits = make_limits(calc_score(trials, verdicts));
  const TrueTrial last = trials.back();
  trials.pop_back();
  CHECK_THAT(find_misses(limits, calc_score(trials, verdicts)).at(0),
             Catch::Contains("not the trials"));
  trials.push_back(last);
  verdicts.erase(last.name);
  CHECK_THAT(find_misses(limits, calc_score(trials, verdicts)).at(0),
             Catch::Contains("1 verdicts are missing"));
}

TEST_CASE("Hidden data: limits are read as they were written", "[io]") {
  const test::TemporaryFolder folder;
  const Limits limits = make_limits(score_all(make_perfect));
  const auto path = folder.write("limits.json", make_limits_json(limits));
  const Limits read = read_limits(path);
  CHECK(read.contents == limits.contents);
  REQUIRE(read.limits.size() == limits.limits.size());
  for (std::size_t i = 0; i < read.limits.size(); ++i) {
    CHECK(read.limits[i].count == limits.limits[i].count);
    CHECK(read.limits[i].at_least == limits.limits[i].at_least);
  }
  CHECK(make_limits_json(read) == make_limits_json(limits));
  folder.write("limits.json", "{\"trials\": {}}");
  CHECK_THROWS_WITH(read_limits(path), Catch::Contains("limits.json"));
}

/// Trials as many and of the grades as the limits say.
std::vector<TrueTrial> make_trials_of(const Limits& limits) {
  std::vector<TrueTrial> trials;
  for (const auto& [category, grades] : limits.contents) {
    for (const auto& [grade, count] : grades) {
      const std::size_t wanted = trials.size() + static_cast<std::size_t>(count);
      for (const TrueTrial& like : make_trials()) {
        if (like.category != category) continue;
        for (int repeat = 0; repeat < count && trials.size() < wanted; ++repeat) {
          trials.push_back(like);
          trials.back().name = std::to_string(trials.size());
          trials.back().grade = grade;
        }
      }
    }
  }
  return trials;
}

TEST_CASE("Hidden data: the slice's limits fail who always and who never names", "[unit]") {
  const Limits limits = read_limits(STRUT_SOURCE_DIR "/tests/hidden/slice_limits.json");
  const std::vector<TrueTrial> trials = make_trials_of(limits);
  int none = 0;
  std::string grades;
  for (const TrueTrial& t : trials) {
    none += t.category == "none" ? 1 : 0;
    grades += t.grade;
  }
  CHECK(trials.size() >= 60);
  CHECK(4 * none >= static_cast<int>(trials.size()));
  CHECK(grades.find_first_of("ABCD") != std::string::npos);
  CHECK(limits.contents.size() == 4);
  const auto find = [&](const auto& make) {
    return find_misses(limits, calc_score(trials, answer_all(trials, make)));
  };
  CHECK(find(make_perfect).empty());
  CHECK_FALSE(find(always_name).empty());
  CHECK_FALSE(find(say_adequate).empty());
  for (const Impostor& impostor : make_impostors(trials, answer_all(trials, make_perfect))) {
    INFO(impostor.name);
    CHECK_FALSE(find_misses(limits, calc_score(trials, impostor.verdicts)).empty());
  }
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
