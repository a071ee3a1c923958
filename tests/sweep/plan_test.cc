// Plans of sweeps: every case exactly once, its stratum and its position by index.
#include "sweep/plan.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <set>

#include "tests/support/sweep_text.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::make_grid_text;
using test::make_plan_of;
using test::make_sweep_text;
using test::Replacements;

std::vector<std::int64_t> list_cases(const Plan& plan) {
  std::vector<std::int64_t> cases;
  cases.reserve(static_cast<std::size_t>(plan.case_count()));
  for (std::int64_t i = 0; i < plan.case_count(); ++i) cases.push_back(plan.calc_case_id(i));
  return cases;
}

/// Number of the plan's cases in each stratum, counted case by case.
std::vector<std::int64_t> count_strata(const Plan& plan) {
  std::vector<std::int64_t> counts(plan.strata().size(), 0);
  for (const std::int64_t id : list_cases(plan)) {
    ++counts[static_cast<std::size_t>(plan.calc_stratum(id))];
  }
  return counts;
}

std::vector<double> calc_parameters(const Plan& plan, std::int64_t id) {
  std::vector<double> values(plan.request().grid.axes().size());
  plan.calc_parameters(id, values);
  return values;
}

/// Mean relative loss, as docs/sweeps.md defines it.
double calc_degradation(const Plan& plan, std::int64_t id) {
  const std::vector<double> values = calc_parameters(plan, id);
  double sum = 0.0;
  for (std::size_t a = 0; a < values.size(); ++a) {
    sum += std::fabs(1.0 - values[a] / plan.request().grid.axes()[a].from);
  }
  return sum / static_cast<double>(values.size());
}

void check_positions(const Plan& plan) {
  const std::vector<std::int64_t> cases = list_cases(plan);
  CHECK(std::set<std::int64_t>(cases.begin(), cases.end()).size() == cases.size());
  for (std::int64_t i = 0; i < plan.case_count(); ++i) {
    REQUIRE(plan.find_position(plan.calc_case_id(i)) == i);
  }
  CHECK(plan.find_position(-1) == -1);
  CHECK(plan.find_position(plan.point_count()) == -1);
}

TEST_CASE("The paper's sweep has each point of its grid once, in ten strata of a thousand",
          "[unit]") {
  const Plan plan = make_plan_of(make_sweep_text());
  CHECK(plan.case_count() == 10000);
  CHECK(plan.shard_count() == 20);
  CHECK(plan.shard_range(0) == std::pair<std::int64_t, std::int64_t>{0, 512});
  CHECK(plan.shard_range(19) == std::pair<std::int64_t, std::int64_t>{9728, 10000});
  check_positions(plan);
  REQUIRE(plan.strata().size() == 10);
  CHECK(count_strata(plan) == std::vector<std::int64_t>(10, 1000));
  for (const Stratum& stratum : plan.strata()) {
    CHECK(stratum.population == 1000);
    CHECK(stratum.drawn == 1000);
    CHECK(stratum.lower == stratum.upper);
  }
  CHECK(plan.strata()[3].lower == 38500.0);
  CHECK(plan.calc_stratum(3999) == 3);
  CHECK(calc_parameters(plan, 1234) == std::vector<double>{39500.0, 1940.0, 33500.0, 1900.0});
  const Case c = plan.make_case(1234);
  CHECK(c.vehicle.suspension[kFront].strut[0].stiffness == 39500.0);
  CHECK(c.vehicle.suspension[kRear].strut[1].damping == 1900.0);
  CHECK(plan.list_drawn().empty());
}

TEST_CASE("The first shard of a shuffled grid is an unbiased sample of the whole grid",
          "[unit][statistical]") {
  const Plan plan = make_plan_of(make_sweep_text());
  for (std::size_t a = 0; a < 4; ++a) {
    std::vector<int> counts(10, 0);
    for (std::int64_t i = 0; i < 512; ++i) {
      const std::int64_t id = plan.calc_case_id(i);
      ++counts[static_cast<std::size_t>(id / static_cast<std::int64_t>(std::pow(10, 3 - a)) % 10)];
    }
    // 51.2 ± 6.6 by the hypergeometric distribution; five standard deviations.
    for (const int n : counts) CHECK(std::abs(n - 51.2) < 5.0 * 6.6);
  }
}

TEST_CASE("A drawn sample takes from each stratum in proportion to its size", "[unit]") {
  const Plan plan = make_plan_of(make_sweep_text({{"\"all\"", "2000"}}));
  CHECK(plan.case_count() == 2000);
  CHECK(plan.point_count() == 10000);
  CHECK(count_strata(plan) == std::vector<std::int64_t>(10, 200));
  check_positions(plan);
  const auto drawn = plan.list_drawn();
  CHECK(drawn.size() == 2000);
  CHECK(std::is_sorted(drawn.begin(), drawn.end()));
  std::int64_t outside = 0;
  while (std::binary_search(drawn.begin(), drawn.end(), outside)) ++outside;
  CHECK(plan.find_position(outside) == -1);
}

TEST_CASE("Strata of unequal size get whole numbers of cases by the largest remainder", "[unit]") {
  // Ten levels in three strata: 4, 3, 3; of 25 cases: 10, 7.5, 7.5.
  const Plan plan =
      make_plan_of(make_sweep_text({{"\"all\"", "25"}, {"strata = 10", "strata = 3"}}));
  CHECK(plan.strata()[0].population == 4000);
  CHECK(plan.strata()[0].lower == 40000.0);
  CHECK(plan.strata()[0].upper == 38500.0);
  CHECK(plan.strata()[1].lower == 38000.0);
  CHECK(plan.strata()[2].population == 3000);
  CHECK(count_strata(plan) == std::vector<std::int64_t>{10, 8, 7});
}

TEST_CASE("Ten strata are the default if there are at least ten levels and cases", "[unit]") {
  const auto count = [](const std::string& axis, const std::string& sample) {
    return make_plan_of(make_grid_text(axis, {{"strata = 10", ""}, {"\"all\"", sample}}))
        .strata()
        .size();
  };
  CHECK(count("front_stiffness = { from = 40000, to = 35000, count = 51 }", "\"all\"") == 10);
  CHECK(count("front_stiffness = { from = 40000, to = 35000, count = 3 }", "\"all\"") == 3);
  CHECK(count("front_stiffness = { from = 40000, to = 35000, count = 51 }", "7") == 7);
}

TEST_CASE("The same seed draws the same cases in the same order, another seed draws others",
          "[unit]") {
  const Replacements two_hundred = {{"\"all\"", "200"}};
  const auto first = list_cases(make_plan_of(make_sweep_text(two_hundred)));
  CHECK(list_cases(make_plan_of(make_sweep_text(two_hundred))) == first);
  const Plan other =
      make_plan_of(make_sweep_text({{"\"all\"", "200"}, {"seed   = 1", "seed = 2"}}));
  CHECK(list_cases(other) != first);
  CHECK(other.list_drawn() != make_plan_of(make_sweep_text(two_hundred)).list_drawn());
}

TEST_CASE("Another seed runs all cases of a grid in another order", "[unit]") {
  const auto first = list_cases(make_plan_of(make_sweep_text()));
  const auto other = list_cases(make_plan_of(make_sweep_text({{"seed   = 1", "seed = 2"}})));
  std::size_t alike = 0;
  for (std::size_t i = 0; i < first.size(); ++i) alike += first[i] == other[i];
  // Two random orders agree in one position on average.
  CHECK(alike < 10);
  CHECK(std::set<std::int64_t>(other.begin(), other.end()).size() == first.size());
}

TEST_CASE("Strata by degradation are the sorted grid cut into equal parts", "[unit][reference]") {
  const Plan plan =
      make_plan_of(make_sweep_text({{"by     = \"front_stiffness\"", "by = \"degradation\""}}));
  CHECK(count_strata(plan) == std::vector<std::int64_t>(10, 1000));
  std::vector<std::pair<double, std::int64_t>> sorted;
  for (std::int64_t id = 0; id < 10000; ++id) {
    // Losses that tie exactly differ by rounding here: about 1e-12 of a step.
    sorted.emplace_back(std::round(1e12 * calc_degradation(plan, id)), id);
  }
  std::sort(sorted.begin(), sorted.end());
  int wrong = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (plan.calc_stratum(sorted[i].second) != static_cast<int>(i / 1000)) ++wrong;
  }
  CHECK(wrong == 0);
  CHECK(plan.strata().front().lower == 0.0);
  CHECK(plan.strata().back().upper == Approx(calc_degradation(plan, 9999)).epsilon(1e-12));
  for (std::size_t i = 1; i < 10; ++i) {
    CHECK(plan.strata()[i].lower == Approx(1e-12 * sorted[1000 * i].first).epsilon(1e-9));
  }
}

TEST_CASE("A billion points are planned like ten thousand", "[unit]") {
  const std::string axes =
      "front_stiffness = { from = 40000, to = 30010, step = -10 }\n"
      "front_damping = { from = 1980, to = 981, step = -1 }\n"
      "rear_stiffness = { from = 35000, to = 25010, step = -10 }";
  const Plan all = make_plan_of(make_grid_text(axes, {{"cases = 512", "cases = 65536"}}));
  CHECK(all.case_count() == 1000000000);
  CHECK(all.shard_count() == 15259);
  for (const std::int64_t position : {0LL, 1LL, 123456789LL, 999999999LL}) {
    CHECK(all.find_position(all.calc_case_id(position)) == position);
  }
  for (const Stratum& stratum : all.strata()) CHECK(stratum.population == 100000000);
  const Plan drawn = make_plan_of(make_grid_text(
      axes, {{"\"all\"", "2000"}, {"by     = \"front_stiffness\"", "by = \"degradation\""}}));
  CHECK(count_strata(drawn) == std::vector<std::int64_t>(10, 200));
  for (const Stratum& stratum : drawn.strata()) CHECK(stratum.population == 100000000);
}

TEST_CASE("Axes that change the mechanism vary slowest", "[unit]") {
  const Plan plan =
      make_plan_of(make_grid_text("front_stiffness = { from = 40000, to = 38000, step = -1000 }\n"
                                  "mass = { from = 1155, to = 1145, step = -5 }\n"
                                  "rear_damping = { from = 1980, to = 1960, step = -20 }",
                                  {{"strata = 10", "strata = 3"}}));
  CHECK_FALSE(plan.request().shuffle);
  check_positions(plan);
  int changes = 0;
  for (std::int64_t i = 1; i < plan.case_count(); ++i) {
    const double before = calc_parameters(plan, plan.calc_case_id(i - 1))[1];
    if (calc_parameters(plan, plan.calc_case_id(i))[1] != before) ++changes;
  }
  CHECK(changes == 2);
}

Plan make_samples(const std::string& method, int count, const std::string& by,
                  const std::string& seed = "1") {
  return make_plan_of(make_sweep_text({{"\"grid\"", "\"" + method + "\""},
                                       {"\"all\"", std::to_string(count)},
                                       {"by     = \"front_stiffness\"", "by = \"" + by + "\""},
                                       {"seed   = 1", "seed = " + seed}}));
}

/// Position of a case along an axis, in [0, 1).
double calc_fraction(const Plan& plan, std::int64_t id, std::size_t axis) {
  const Axis& a = plan.request().grid.axes()[axis];
  return (calc_parameters(plan, id)[axis] - a.from) / (a.last() - a.from);
}

/// Number of cases in [first, end) that lie in each of `parts` equal parts of an axis.
std::vector<int> count_fractions(const Plan& plan, std::int64_t first, std::int64_t end,
                                 std::size_t axis, std::size_t parts) {
  std::vector<int> counts(parts, 0);
  for (std::int64_t id = first; id < end; ++id) {
    const double fraction = calc_fraction(plan, id, axis);
    REQUIRE(fraction >= 0.0);
    REQUIRE(fraction < 1.0);
    ++counts[static_cast<std::size_t>(fraction * static_cast<double>(parts))];
  }
  return counts;
}

TEST_CASE("A Latin hypercube has one sample in every cell of every axis", "[unit][property]") {
  const Plan plan = make_samples("latin_hypercube", 500, "rear_damping");
  CHECK(plan.case_count() == 500);
  check_positions(plan);
  for (std::size_t a = 0; a < 4; ++a) {
    CHECK(count_fractions(plan, 0, 500, a, 500) == std::vector<int>(500, 1));
  }
  CHECK(count_strata(plan) == std::vector<std::int64_t>(10, 50));
  for (std::int64_t id = 0; id < 500; ++id) {
    REQUIRE(plan.calc_stratum(id) == static_cast<int>(10.0 * calc_fraction(plan, id, 3)));
  }
  // The axes are independent: five standard deviations of a correlation.
  double correlation = 0.0;
  for (std::int64_t id = 0; id < 500; ++id) {
    correlation +=
        12.0 * (calc_fraction(plan, id, 0) - 0.5) * (calc_fraction(plan, id, 1) - 0.5) / 500;
  }
  CHECK(std::fabs(correlation) < 5.0 / std::sqrt(500.0));
}

TEST_CASE("Every block of 2^k Sobol samples has one in each of 2^k parts of an axis",
          "[unit][property]") {
  const Plan plan = make_samples("sobol", 1024, "front_damping");
  for (std::size_t a = 0; a < 4; ++a) {
    for (const std::int64_t block : {8, 64, 256}) {
      for (std::int64_t first = 0; first < 1024; first += block) {
        const auto parts = static_cast<std::size_t>(block);
        REQUIRE(count_fractions(plan, first, first + block, a, parts) ==
                std::vector<int>(parts, 1));
      }
    }
  }
  const auto counts = count_strata(plan);
  for (std::size_t i = 0; i < counts.size(); ++i) CHECK(counts[i] == plan.strata()[i].drawn);
  CHECK(calc_parameters(plan, 5) !=
        calc_parameters(make_samples("sobol", 1024, "front_damping", "2"), 5));
}

TEST_CASE("Two axes of a Sobol sequence fill every square of an even net", "[unit][property]") {
  const Plan plan = make_samples("sobol", 1024, "front_damping");
  std::vector<int> squares(256, 0);
  for (std::int64_t id = 0; id < 256; ++id) {
    const auto x = static_cast<std::size_t>(16.0 * calc_fraction(plan, id, 0));
    const auto y = static_cast<std::size_t>(16.0 * calc_fraction(plan, id, 1));
    ++squares[16 * x + y];
  }
  CHECK(squares == std::vector<int>(256, 1));
}

TEST_CASE("Samples are stratified by degradation into strata of equal size", "[unit]") {
  for (const char* method : {"latin_hypercube", "sobol"}) {
    const Plan plan = make_samples(method, 1000, "degradation");
    CHECK(count_strata(plan) == std::vector<std::int64_t>(10, 100));
    for (std::int64_t id = 0; id < 1000; ++id) {
      const Stratum& stratum = plan.strata()[static_cast<std::size_t>(plan.calc_stratum(id))];
      const double degradation = calc_degradation(plan, id);
      REQUIRE(degradation >= stratum.lower - 1e-12);
      REQUIRE(degradation <= stratum.upper + 1e-12);
    }
  }
}

TEST_CASE("An impossible plan is refused with what is allowed", "[unit]") {
  const auto refuses = [](const Replacements& replacements, const std::string& what,
                          const std::string& allowed) {
    CHECK_THROWS_WITH(make_plan_of(make_sweep_text(replacements)),
                      Contains("sweep.toml") && Contains(what) && Contains(allowed));
  };
  refuses({{"\"all\"", "10001"}}, "sample.count = 10001", "[1, 10000]");
  refuses({{"\"all\"", "9"}}, "stratum 10 of 10 empty", "at least 10");
  refuses({{"strata = 10", "strata = 11"}}, "sample.strata = 11", "1 to 10");
  refuses(
      {{"strata = 10", "strata = 10001"}, {"by     = \"front_stiffness\"", "by = \"degradation\""}},
      "sample.strata = 10001", "1 to 10000");
  refuses({{"\"grid\"", "\"sobol\""}, {"\"all\"", "10000001"}}, "sample.count", "[1, 10000000]");
  refuses({{"\"grid\"", "\"latin_hypercube\""}, {"\"all\"", "9"}}, "sample.strata = 10", "1 to 9");
}

TEST_CASE("The schema names the columns of a row", "[unit]") {
  const Plan plan = make_plan_of(make_sweep_text(
      {{"[shards]", "history = { rate = 100, channels = [\"pitch_rate\"] }\n[shards]"}}));
  const ShardSchema schema = plan.make_schema();
  REQUIRE(schema.parameters.size() == 4);
  CHECK(schema.parameters[1].name == "front_damping");
  CHECK(schema.parameters[1].unit == "N s/m");
  REQUIRE(schema.snapshot.size() == 5);
  CHECK(schema.snapshot[3].name == "pitch_angle");
  CHECK(schema.snapshot[3].unit == "rad");
  REQUIRE(schema.history.size() == 1);
  CHECK(schema.history_samples == 301);
  CHECK(schema.history_interval == 0.01);
  CHECK_THAT(schema.status_meaning, Contains("0 done"));
}

TEST_CASE("The hash covers everything that changes a result, and nothing else", "[unit]") {
  const std::string text = make_sweep_text();
  const std::string hash = make_plan_of(text).hash();
  CHECK(hash.size() == 64);
  CHECK(make_plan_of("# a comment\n" + text).hash() == hash);
  const std::size_t begin = text.find("[integrate]"), end = text.find("[record]");
  const std::string moved =
      text.substr(0, begin) + text.substr(end) + "\n" + text.substr(begin, end - begin);
  CHECK(make_plan_of(moved).hash() == hash);
  CHECK(make_plan_of(make_sweep_text({{"step    = 1e-3", "step = 0.001"}})).hash() == hash);
  CHECK(make_plan_of(make_sweep_text({{"cases = 512", ""}})).hash() == hash);
  const Replacements changes = {{"step    = 1e-3", "step = 2e-3"},
                                {"cases = 512", "cases = 256"},
                                {"seed   = 1", "seed = 2"},
                                {"strata = 10", "strata = 5"},
                                {"by     = \"front_stiffness\"", "by = \"front_damping\""},
                                {"\"all\"", "9999"},
                                {"\"newton\"", "\"table\""},
                                {"offset = 0.0", "offset = 0.1"},
                                {", \"pitch_rate\"]", "]"},
                                {"bump_20mps", "one_sided"},
                                {"paper_sedan", "compact_hatch"},
                                {"to = 30500", "to = 31000"}};
  for (const auto& change : changes) {
    CAPTURE(change.second);
    CHECK(make_plan_of(make_sweep_text({change})).hash() != hash);
  }
  // The order of the axes decides the numbers of the cases.
  const auto axis = [](const std::string& name) {
    return name + " = { from = 40000, to = 35500, step = -500 }\n";
  };
  CHECK(make_plan_of(make_grid_text(axis("front_stiffness") + axis("rear_stiffness"))).hash() !=
        make_plan_of(make_grid_text(axis("rear_stiffness") + axis("front_stiffness"))).hash());
}

TEST_CASE("A sweep that an earlier version planned keeps that version's rules", "[unit]") {
  SweepRequest request = make_plan_of(make_sweep_text()).request();
  request.history = {};
  CHECK(find_text(list_facts(request), "record.until") == "snapshot");
  CHECK(get_start_method(request) == StartMethod::kLanes);
  request.results_version = 1;
  CHECK_FALSE(ends_at_snapshot(request));
  CHECK_FALSE(make_sample_plan(request).until_snapshot);
  CHECK(get_start_method(request) == StartMethod::kKinsol);
  CHECK(find_text(list_facts(request), "results_version") == "1");
  CHECK_FALSE(find_text(list_facts(request), "record.until"));
}

TEST_CASE("The differences of two requests are listed line by line", "[unit]") {
  const Facts was = {{"a", "1"}, {"b", "2"}, {"c", "3"}}, is = {{"b", "2"}, {"a", "4"}, {"d", "5"}};
  CHECK(compare_facts(was, is) ==
        std::vector<std::string>{"a: was 1, is 4", "c: was 3, is absent", "d: was absent, is 5"});
  CHECK(compare_facts(was, was).empty());
}

}  // namespace
}  // namespace strut
