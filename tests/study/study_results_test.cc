// Results of studies: medians, ratios to published numbers, noise limits in files.
#include <catch2/catch.hpp>
#include <cmath>

#include "base/error/input_error.h"
#include "study/noise/limits_file.h"
#include "study/results.h"
#include "study/summary.h"
#include "tests/support/study_files.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::StudyFiles;
using test::TemporaryFolder;

TEST_CASE("The median of an even number of seeds is the mean of the middle two", "[unit]") {
  const Spread odd = calc_spread({3.0, 1.0, 2.0}), even = calc_spread({4.0, 1.0, 3.0, 2.0});
  CHECK(odd.median == 2.0);
  CHECK(even.median == 2.5);
  CHECK(even.low == 1.0);
  CHECK(even.high == 4.0);
  CHECK(calc_spread({5.0}).median == 5.0);
  CHECK(std::isnan(calc_spread({1.0, std::nan(""), 2.0}).median));
  CHECK_THROWS_AS(calc_spread({}), std::invalid_argument);
}

/// The cell of a request, two parameters, whose metrics have these medians.
CellResult make_cell(const StudyRequest& request, const StudyCell& cell, double error, double r2) {
  CellResult result;
  result.cell = cell;
  result.key = make_key(request, cell);
  result.parameters = {{"front_stiffness", "N/m", ""}, {"rear_stiffness", "N/m", ""}};
  for (std::size_t p = 0; p < 2; ++p) {
    result.spread.emplace_back();
    result.spread.back().fill({error, error, error});
    result.spread.back()[kR2] = {r2, r2, r2};
  }
  return result;
}

TEST_CASE("A summary counts errors within a tenth of the published ones", "[unit]") {
  const StudyFiles files;
  const StudyRequest request = read_study(files / "study.toml");
  StudyResults results;
  for (const StudyCell& cell : list_cells(request)) {
    results.cells.push_back(make_cell(request, cell, 10.0, 1.0 - 1e-3));
  }
  const std::vector<StudySummary> summaries = summarize(request, results);
  REQUIRE(summaries.size() == 2);
  for (const StudySummary& s : summaries) {
    // Published: MAE 100, MAPE 0.3, RMSE 150, and MAE 0.001 of the other inputs.
    CHECK(s.errors == 4);
    CHECK(s.errors_held == 2);
    CHECK(s.largest_at == "small_90_two rear_stiffness MAE");
    CHECK(s.largest_ratio == Approx(1e4));
    CHECK(s.gaps == 10);
    CHECK(s.gaps_held == 0);
    CHECK(s.largest_gap == Approx(1e-3));
  }
  CHECK(&find_main_cell(request, results, 1) == &results.cells[5]);
  CHECK(std::isnan(find_published(request, results.cells.back(), 1, kMae)));  // at the best instant
}

TEST_CASE("Bounds and fits are read as they were written", "[unit]") {
  const TemporaryFolder folder;
  const std::vector<std::string> names = {"front_stiffness", "rear_stiffness"};
  FittedCase fit;
  fit.bounds = {17, {{38000.25, 12.5}, {31000.0, 1.0 / 3.0}}};
  fit.estimates = {38001.0, 30999.875};
  fit.chi2_per_degree = 1.01;
  fit.seconds = 0.7;
  fit.converged = true;
  write_fits(folder / "fits.csv", names, {fit});
  const FittedCase read = read_fits(folder / "fits.csv", names).at(0);
  CHECK(read.bounds.number == 17);
  CHECK(read.bounds.parameters[1].bound == 1.0 / 3.0);
  CHECK(read.estimates == fit.estimates);
  CHECK(read.converged);
  CHECK(read.seconds == 0.7);
  write_bounds(folder / "bounds.csv", names, {fit.bounds, {18, {{1.0, 0.0}, {1.0, 1.0}}}});
  CHECK_THROWS_WITH(read_bounds(folder / "bounds.csv", names),
                    Contains("bounds.csv:4: front_stiffness_bound = 0: must be above 0"));
}

}  // namespace
}  // namespace strut
