// Parameters from snapshots: tables, histories, intervals.
#include <catch2/catch.hpp>
#include <cmath>

#include "base/error/input_error.h"
#include "base/math/normal.h"
#include "base/math/random.h"
#include "identify/snapshot.h"
#include "io/table/csv.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_model.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;
namespace fs = std::filesystem;

TEST_CASE("Noise of the sensors widens an interval as repeated measurements scatter",
          "[statistical]") {
  const TrainedModel model = test::make_random_model();
  const Identifier identifier(model);
  const std::vector<double> x = test::draw_inputs(model, 1);
  SnapshotOptions options{{1e-5, 0.0, 0.02, 5e-6}};
  const IdentifiedRow row = identify_snapshot(model, identifier, options, x.data());
  constexpr int kTrials = 20000;
  double sum = 0.0, square = 0.0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    std::vector<double> noisy = x, values(2);
    for (std::size_t i = 0; i < 4; ++i) {
      // Uniform of the same deviation.
      noisy[i] += options.noise[i] * std::sqrt(12.0) * (calc_uniform(5, i, trial) - 0.5);
    }
    identifier.identify(noisy.data(), values.data());
    sum += values[0] - row.parameters[0].value;
    square += (values[0] - row.parameters[0].value) * (values[0] - row.parameters[0].value);
  }
  const double scatter = std::sqrt(square / kTrials - sum * sum / (kTrials * double{kTrials}));
  const double half = row.parameters[0].half_width, own = model.ci95[0];
  REQUIRE(half > own);
  // Deviation of a deviation: 1 / sqrt(2 kTrials) = 0.5 %; four of them.
  CHECK(std::sqrt(half * half - own * own) / kNormal95 == Approx(scatter).epsilon(0.02));
  options.noise.assign(4, 0.0);
  CHECK(identify_snapshot(model, identifier, options, x.data()).parameters[0].half_width == own);
}

/// A history of the model's inputs, three samples of `rows`, at these times in this unit.
fs::path write_history(const TemporaryFolder& folder, const TrainedModel& model,
                       const std::vector<double>& rows, const std::vector<double>& times,
                       const std::string& unit = "s") {
  std::vector<CsvColumn> columns = {{"time", unit, times}};
  for (std::size_t i = 0; i < 4; ++i) {
    columns.push_back(
        {model.inputs[i].name, model.inputs[i].unit, {rows[i], rows[4 + i], rows[8 + i]}});
  }
  write_csv(folder / "drive.csv", columns);
  return folder / "drive.csv";
}

TEST_CASE("A snapshot between two samples of a history is on the straight line", "[unit]") {
  const TemporaryFolder folder;
  const TrainedModel model = test::make_random_model();
  const std::vector<double> x = test::draw_inputs(model, 3);
  const fs::path file = write_history(folder, model, x, {0.0, 0.1, 0.3});
  const Snapshots found = read_snapshots(model, {file, file}, 0.15);
  REQUIRE(found.sources.size() == 2);
  CHECK(found.sources[0] == file.string() + " at 0.15 s");
  for (std::size_t i = 0; i < 4; ++i) {
    // Three roundings.
    CHECK(found.rows[4 + i] == Approx(0.75 * x[4 + i] + 0.25 * x[8 + i]).epsilon(1e-14));
  }
  CHECK(read_snapshots(model, {file}, 0.0).rows == std::vector<double>(x.begin(), x.begin() + 4));
}

TEST_CASE("Snapshots of a history are refused without an instant, or at none of its times",
          "[unit]") {
  const TemporaryFolder folder;
  const TrainedModel model = test::make_random_model();
  const std::vector<double> x = test::draw_inputs(model, 3);
  const fs::path file = write_history(folder, model, x, {0.0, 0.1, 0.3});
  CHECK_THROWS_WITH(read_snapshots(model, {file}, {}), Contains("a time history"));
  CHECK_THROWS_WITH(read_snapshots(model, {file}, 0.31), Contains("must be in [0, 0.3] s"));
  CHECK_THROWS_WITH(read_snapshots(model, {write_history(folder, model, x, {0.0, 0.1, 0.1})}, 0.05),
                    Contains("drive.csv:5: time must ascend"));
  CHECK_THROWS_WITH(
      read_snapshots(model, {write_history(folder, model, x, {0.0, 0.1, 0.3}, "mm")}, 0.05),
      Contains("column 'time': unit \"mm\""));
}

TEST_CASE("Identified parameters are written with their bounds, unknown numbers as nan", "[unit]") {
  const TemporaryFolder folder;
  IdentifiedRow inside, outside;
  inside.parameters = {{"front_stiffness", "N/m", 100.0, 2.0, true}};
  outside.parameters = {{"front_stiffness", "N/m"}};
  outside.outside = {{"pitch_angle", "rad", 2.0, 0.0, 1.0, 1.0}};
  CHECK(are_in_range({inside}));
  CHECK_FALSE(are_in_range({inside, outside}));
  write_identified_csv(folder / "out.csv", {inside, outside});
  const std::string text = test::read_text(folder / "out.csv");
  CHECK_THAT(text, Contains("0,100,98,102,1") && Contains("1,nan,nan,nan,0"));
}

}  // namespace
}  // namespace strut
