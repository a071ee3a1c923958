// Measured runs and unknowns of a fit.
#include <catch2/catch.hpp>

#include "base/error/input_error.h"
#include "estimate/nuisances.h"
#include "identify/fit.h"
#include "identify/run.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;

const std::vector<int> kChannels = {CarChannel::kImuAccelerationZ, CarChannel::kImuRateY};

MeasuredRun read_run(const TemporaryFolder& folder, const std::string& rows) {
  const auto file = folder.write("m.csv", "time,imu_acceleration_z,imu_rate_y\n" + rows);
  return read_measured_run(file, test::make_paper_case(), kChannels, make_default_noise());
}

TEST_CASE("A run keeps its window, and an empty one is refused with the times", "[unit]") {
  const TemporaryFolder folder;
  MeasuredRun run = read_run(folder, "0.5,9.8,0\n0.6,9.8,0.1\n0.7,9.8,0\n");
  CHECK(run.channels[0].sigma == make_default_noise()[CarChannel::kImuAccelerationZ]);
  CHECK(find_constant_channels(run) == std::vector<std::size_t>{0});
  keep_window(run, 0.55, 0.65);
  CHECK(run.times == std::vector<double>{0.6});
  CHECK(find_constant_channels(run).empty());  // one reading says nothing
  CHECK_THROWS_WITH(keep_window(run, 1.0, 2.0),
                    Contains("m.csv lies in it; its times are 0.6 to 0.6 s"));
  CHECK_THROWS_WITH(read_run(folder, "0.5,9.8,0\n0.4,9.8,0\n"),
                    Contains("must be finite and ascend"));
}

TEST_CASE("The speed is one unknown per run, other parameters are one for all runs", "[unit]") {
  const TemporaryFolder folder;
  const std::vector<MeasuredRun> runs(2, read_run(folder, "0.5,9.8,0\n0.6,9.8,0.1\n"));
  const std::vector<Unknown> unknowns = make_free_unknowns(runs, {"front_stiffness", kSpeedName});
  REQUIRE(unknowns.size() == 3);
  CHECK(unknowns[0].run == kEveryRun);
  CHECK(unknowns[1].run == 0);
  CHECK(unknowns[2].run == 1);
  CHECK_THROWS_WITH(make_free_unknowns(runs, {"front_stifness"}), Contains("did you mean"));
  CHECK_THROWS_AS(make_free_unknowns(runs, {"rear_damping", "rear_damping"}), InputError);
}

TEST_CASE("A prior moves the start of its unknowns, within their bounds", "[unit]") {
  const TemporaryFolder folder;
  const std::vector<MeasuredRun> runs(2, read_run(folder, "0.5,9.8,0\n0.6,9.8,0.1\n"));
  std::vector<Unknown> unknowns = make_free_unknowns(runs, {"front_stiffness", kSpeedName});
  const ModelInfo& model = runs.front().setup.info();
  set_prior(model, kSpeedName, {21.0, 0.1}, unknowns);
  CHECK(unknowns[0].prior.informs() == false);
  for (const std::size_t i : {1, 2}) {
    CHECK(unknowns[i].start == 21.0);
    CHECK(unknowns[i].prior.sigma == 0.1);
  }
  set_prior(model, kSpeedName, {1e6, 0.1}, unknowns);
  CHECK(unknowns[1].start == unknowns[1].high);
  CHECK_THROWS_WITH(set_prior(model, "sped", {20.0, 1.0}, unknowns),
                    Contains("'sped' is not free") && Contains("did you mean 'speed'"));
}

}  // namespace
}  // namespace strut
