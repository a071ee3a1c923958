// Roads of maneuver files: classes, surveys and rows of bumps, and what is refused.
#include "model_files/read_maneuver.h"

#include <catch2/catch.hpp>
#include <cstddef>
#include <string>

#include "base/error/input_error.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;

const std::string kDrive = "speed = 20.0\nduration = 2.0\ndrive_torque = 0.0\n";
const std::string kBump =
    "[bump]\nshape = \"cosine\"\nheight = 0.03\nlength = 0.5\ndistance = 5.0\n";

TEST_CASE("A maneuver's road is given by its class or its density", "[unit]") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& road) {
    return read_maneuver(folder.write("m.toml", kDrive + "[road]\n" + road));
  };
  const ManeuverSpec c = read("class = \"C\"\n");
  REQUIRE(c.profile.data);
  CHECK(c.road.shape == BumpShape::kNone);
  CHECK(c.profile == read("roughness = 256e-6\nseed = 1\nlength = 200.0\n").profile);
  CHECK_FALSE(c.profile == read("class = \"C\"\nseed = 2\n").profile);
  CHECK_FALSE(c.profile == read("class = \"B\"\n").profile);
  CHECK_THROWS_WITH(read("class = \"I\"\n"), Contains("class"));
  CHECK_THROWS_WITH(read("class = \"C\"\nroughness = 1e-6\n"), Contains("both given"));
  CHECK_THROWS_WITH(read("length = 100.0\n"), Contains("roughness"));
  CHECK_THROWS_WITH(read("class = \"C\"\nlength = 1e9\n"), Contains("length"));
  CHECK_THROWS_WITH(read("class = \"C\"\nsede = 1\n"), Contains("sede"));
  CHECK_THROWS_WITH(read("roughness = 1.0\n"), Contains("road, height"));
}

TEST_CASE("A surveyed road has the heights of its file, in their unit, level at both ends",
          "[unit]") {
  const TemporaryFolder folder;
  std::string rows = "position [m],left [mm],right [mm]\n";
  for (int i = 0; i <= 100; ++i) {
    rows += std::to_string(2.0 + 0.1 * i) + "," + std::to_string(100 + i % 3) + ",105\n";
  }
  folder.write("survey.csv", rows);
  const ManeuverSpec m = read_maneuver(
      folder.write("m.toml", kDrive + kBump + "[road]\nfile = \"survey.csv\"\nfade = 0.5\n"));
  REQUIRE(m.profile.data);
  const RoadProfile& road = *m.profile.data;
  CHECK(m.road.shape == BumpShape::kCosine);
  CHECK(road.begin == Approx(2.0));
  CHECK(road.spacing == Approx(0.01));
  REQUIRE(road.height[0].size() == 1001);
  CHECK(road.height[0][400] == Approx(1e-3));    // row 40, 101 mm above the first row's 100 mm
  CHECK(road.height[0][405] == Approx(1.5e-3));  // half way to row 41
  CHECK(road.height[1][500] == Approx(5e-3));
  CHECK(road.height[1][0] == 0.0);
  CHECK(road.height[1][1000] == Approx(0.0).margin(1e-12));
  folder.write("bad.csv", "position,height\n0,0\n2,1\n1,0\n");
  const auto read = [&](const std::string& text) {
    return read_maneuver(folder.write("m.toml", kDrive + "[road]\n" + text));
  };
  CHECK_THROWS_WITH(read("file = \"bad.csv\"\n"), Contains("bad.csv:4") && Contains("position"));
  CHECK_THROWS_WITH(read("file = \"missing.csv\"\n"), Contains("missing.csv"));
  folder.write("bad.csv", "position,left\n0,0\n1,1\n2,0\n");
  CHECK_THROWS_WITH(read("file = \"bad.csv\"\n"), Contains("left and right or height"));
  const auto refuse = [&](const std::string& text, const std::string& told) {
    folder.write("bad.csv", text);
    CHECK_THROWS_WITH(read("file = \"bad.csv\"\n"), Contains("bad.csv") && Contains(told));
  };
  refuse("x,links,rechts\n0,0,0\n1,1,1\n2,0,0\n", "must have position");
  refuse("position,height\n-1,0\n1,1\n2,0\n", ":2: position = -1 m");
  refuse("position,height\n0,0\n1,7\n2,0\n", ":3: height = 7 m");
  refuse("position,height\n0,0\n1,0.01\n1e7,0\n", ":4: position = 1e+07 m");
  refuse("position,height\n0,0\n1,0.01\n1e300,0\n", ":4: position");
  refuse("position,height [furlong]\n0,0\n1,0\n2,0\n", "column height");
  refuse("position,height\n0,0\n1,0.3\n2,0.6\n", "grade");
  refuse("position,left,right\n0,0,0.4\n1,0,0.4\n2,0,0\n", "right begins 0.4 m");
  folder.write("bad.csv", "position,height\n0,0\n1,0\n2,0\n");
  CHECK_THROWS_WITH(read("file = \"bad.csv\"\nclass = \"C\"\n"), Contains("random or surveyed"));
}

TEST_CASE("A bump may stand in a row", "[unit]") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    return read_maneuver(folder.write("m.toml", kDrive + kBump + text)).road;
  };
  CHECK(read("").count == 1);
  CHECK(read("count = 4\nspacing = 3.0\n").count == 4);
  CHECK(read("count = 4\nspacing = 3.0\n").spacing == 3.0);
  CHECK_THROWS_WITH(read("count = 4\n"), Contains("spacing"));
  CHECK_THROWS_WITH(read("count = 0\n"), Contains("count"));
  CHECK_THROWS_WITH(read("spacing = 3.0\n"), Contains("spacing"));
}

}  // namespace
}  // namespace strut
