#include "model_files/read_vehicle.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error/input_error.h"
#include "model/car/assemble.h"
#include "model_files/read_maneuver.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::TemporaryFolder;

const fs::path kExamples = fs::path(STRUT_SOURCE_DIR) / "examples";
const fs::path kSedan = kExamples / "vehicles/paper_sedan.toml";

std::vector<fs::path> list_examples(const char* folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(kExamples / folder)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// A copy of an example with one text replaced, beside a copy of the tire.
class ChangedFile {
 public:
  ChangedFile(const fs::path& original, const std::string& from, const std::string& to) {
    fs::create_directory(folder_ / "tires");
    fs::create_directory(folder_ / "files");
    fs::copy(kExamples / "tires/paper_sedan.tir", folder_ / "tires/paper_sedan.tir");
    std::string text = test::read_text(original);
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    line_ = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    path_ = folder_.write("files/changed.toml", text.replace(at, from.size(), to));
  }
  const fs::path& path() const { return path_; }
  /// "changed.toml:12: " for the line in which the change begins.
  std::string place() const { return "changed.toml:" + std::to_string(line_) + ": "; }

 private:
  TemporaryFolder folder_;
  fs::path path_;
  std::ptrdiff_t line_ = 0;
};

void check_refused(const std::string& from, const std::string& to, const std::string& message) {
  const ChangedFile file(kSedan, from, to);
  CHECK_THROWS_AS(read_vehicle(file.path()), InputError);
  CHECK_THROWS_WITH(read_vehicle(file.path()), Contains(file.place() + message));
}

TEST_CASE("Every example vehicle can be built", "[io]") {
  const ManeuverSpec maneuver = read_maneuver(kExamples / "maneuvers/bump_20mps.toml");
  const auto files = list_examples("vehicles");
  CHECK(files.size() >= 3);
  for (const fs::path& path : files) {
    INFO(path.string());
    const VehicleSpec vehicle = read_vehicle(path);
    const AssembledVehicle car = assemble_vehicle(vehicle, maneuver);
    // The heaviest and the lightest chassis a road car of 1 to 1.5 t has.
    CHECK(car.numbers.chassis.mass > 0.75 * vehicle.whole.mass);
    CHECK(car.numbers.chassis.mass < 0.95 * vehicle.whole.mass);
    const Sym3<double>& j = car.numbers.chassis.inertia;
    CHECK(j.xx + j.yy > j.zz);
    for (const double preload : car.preload) CHECK(preload > 0.0);
  }
}

TEST_CASE("Every example maneuver can be read", "[io]") {
  const auto files = list_examples("maneuvers");
  CHECK(files.size() >= 4);
  for (const fs::path& path : files) {
    INFO(path.string());
    const ManeuverSpec maneuver = read_maneuver(path);
    CHECK((maneuver.road.shape != BumpShape::kNone || maneuver.profile.data != nullptr));
  }
}

TEST_CASE("The paper's car is Table 1", "[io][reference]") {
  const VehicleSpec car = read_vehicle(kSedan);
  CHECK(car.whole.mass == 1155.0);
  CHECK(car.whole.centroid_to_front == 0.7209);
  CHECK(car.whole.centroid_to_front + car.whole.centroid_to_rear == Approx(2.8).epsilon(1e-15));
  CHECK(car.whole.centroid_height == 0.5373);
  CHECK(car.tire.unloaded_radius == 0.4673);
  for (const StrutSpec& strut : car.suspension[kFront].strut) {
    CHECK(strut.stiffness == 40000.0);
    CHECK(strut.damping == 1980.0);
  }
  for (const StrutSpec& strut : car.suspension[kRear].strut) {
    CHECK(strut.stiffness == 35000.0);
    CHECK(strut.damping == 1980.0);
  }
  CHECK(car.suspension[kFront].kind == SuspensionKind::kMacPherson);
  CHECK(car.suspension[kRear].kind == SuspensionKind::kMultilink);
  CHECK(car.suspension[kFront].drive_share == 1.0);
  CHECK(car.preload == PreloadKind::kFreeLength);
  CHECK(car.tire.contact == ContactKind::kEnvelope);
}

TEST_CASE("The generic car's front points keep their distances", "[io][reference]") {
  const SuspensionSpec s =
      read_vehicle(kExamples / "vehicles/generic_wide.toml").suspension[kFront];
  // As published, relative to the wheel center (-0.04000403, 1.09999965, -0.02602507); the file
  // holds eight decimals, so a shift is exact to their last digit.
  const Vec3<double> wheel{-0.04000403, 1.09999965, -0.02602507};
  const auto check = [&](const Vec3<double>& point, const Vec3<double>& published) {
    const Vec3<double> center{0.0, s.wheel_center_y, 0.0};
    CHECK(norm((point - center) - (published - wheel)) < 1e-12);
  };
  check(s.arm_front, {0.220, 0.520, -0.156});
  check(s.arm_rear, {-0.300, 0.507, -0.137});
  check(s.ball_joint, {-0.02165371, 0.94057703, -0.17402826});
  check(s.rods[0].chassis, {-0.300, 0.520, -0.059});
  check(s.rods[0].upright, {-0.2373756, 0.89495045, -0.01605418});
  check(s.strut_top, {-0.115, 0.785, 0.579});
  check(s.strut_bottom, {-0.07402507, 0.8532915, 0.2484536});
  check(s.spring_upper.position, {-0.115, 0.785, 0.579});
  check(s.spring_lower.position, {-0.07402507, 0.8532915, 0.2484536});
}

TEST_CASE("A mount finds the part it is fixed to", "[io]") {
  const VehicleSpec car = read_vehicle(kExamples / "vehicles/generic_wide.toml");
  const SuspensionSpec& rear = car.suspension[kRear];
  CHECK(rear.spring_upper.body == MountBody::kChassis);
  CHECK(rear.spring_lower.body == MountBody::kRod);
  CHECK(rear.spring_lower.rod == 3);
  CHECK(rear.rods[3].mass == 6.0);
  CHECK(car.suspension[kFront].damper_lower.body == MountBody::kUpright);
}

TEST_CASE("A vehicle file with a slip is refused with file, line, key and what is allowed",
          "[io]") {
  check_refused("mass = 1155.0 ", "mass = -1155.0 ",
                "whole_car.mass = -1155: must lie in [200, 20000] kg");
  check_refused("mass = 18.0 ", "mass = -18.0 ",
                "front_suspension.upright.mass = -18: must be > 0 kg");
  check_refused("mass = 2.372", "mass = -2.372",
                "rear_suspension.rod[1].mass = -2.372: must lie in [0, 500] kg");
  check_refused("stiffness = 40000.0", "stiffness = \"stiff\"",
                "front_suspension.spring.stiffness = \"stiff\": must be a number");
  check_refused("contact = \"envelope\"", "contact = \"envelop\"",
                "tire.contact = \"envelop\": must be one of envelope, point; did you mean "
                "'envelope'?");
  check_refused("ball_joint = [0.0059856, 0.69905, -0.1175]", "ball_joint = [0.0, 0.7]",
                "front_suspension.ball_joint = [0, 0.7]: must be an array of three numbers");
  check_refused("../tires/paper_sedan.tir", "../tires/no.tir", "tire.file = \"../tires/no.tir\": ");
  check_refused("footprint = 0.12", "footprnt = 0.12",
                "unknown key 'tire.footprnt'; did you mean 'footprint'?");
  check_refused("type = \"full_vehicle\"", "type = \"hovercraft\"",
                "type = \"hovercraft\": must be one of full_vehicle");
  check_refused("lower_on = \"upright\"", "lower_on = \"sky\"",
                "front_suspension.spring.lower_on = \"sky\": must be one of chassis, upright, "
                "lower_arm, tie_rod");
  check_refused("front_share = 1.0", "front_share = 1.5", "drive.front_share = 1.5: must lie in");
}

TEST_CASE("A vehicle file that lacks something is refused", "[io]") {
  check_refused("[imu]", "[imo]", "unknown key 'imo'; did you mean 'imu'?");
  const auto refused = [](const std::string& from, const std::string& to) {
    const ChangedFile file(kSedan, from, to);
    CHECK_THROWS_AS(read_vehicle(file.path()), InputError);
  };
  refused("[front_suspension.wheel]", "[front_suspension.weel]");
  refused("name = \"upper_rear\"", "name = \"upper_front\"");
  refused("[[rear_suspension.rod]]", "[[rear_suspension.rods]]");
  refused("kind = \"multilink\"", "kind = \"macpherson\"");
  CHECK_THROWS_WITH(read_vehicle("no/such/car.toml"), Contains("car.toml: file not found"));
}

TEST_CASE("A body that cannot be is refused", "[io]") {
  check_refused("inertia = [300.0, 1560.0, 1700.0]", "inertia = [100.0, 1560.0, 1700.0]",
                "whole_car.inertia = [100, 1560, 1700]: impossible for a body");
  check_refused("inertia = [300.0, 1560.0, 1700.0]",
                "inertia = [300.0, 1560.0, 1700.0]\ninertia_products = [0.0, 900.0, 0.0]",
                "whole_car.inertia = [300, 1560, 1700]: impossible for a body");
  check_refused("spin_inertia = 1.5 ", "spin_inertia = 1.7 ",
                "front_suspension.wheel.spin_inertia = 1.7: impossible for a body");
  check_refused("strut_bottom = [0.00001, 0.5791, -0.003]",
                "strut_bottom = [-0.02897, 0.541, 0.516]", "front_suspension.strut_bottom");
}

TEST_CASE("A maneuver file with a slip is refused", "[io]") {
  const auto refused = [](const char* name, const std::string& from, const std::string& to,
                          const std::string& message) {
    const ChangedFile file(kExamples / "maneuvers" / name, from, to);
    CHECK_THROWS_WITH(read_maneuver(file.path()), Contains(message));
    CHECK_THROWS_AS(read_maneuver(file.path()), InputError);
  };
  refused("bump_20mps.toml", "speed = 20.0", "speed = 0.0", "speed = 0: must lie in [0.5, 100]");
  refused("bump_20mps.toml", "shape = \"arc\"", "shape = \"ark\"", "did you mean 'arc'?");
  refused("bump_20mps.toml", "height = 0.05", "height = 0.3", "[bump]: ");
  refused("bump_20mps.toml", "side = \"both\"", "ramp = 0.1", "unknown key 'bump.ramp'");
  refused("one_sided.toml", "ramp = 0.15", "ramp = 0.4", "[bump]: ");
  refused("measured_profile.toml", "measured_profile.csv", "no.csv", "file not found");
}

TEST_CASE("A profile must run forward", "[io]") {
  const TemporaryFolder folder;
  fs::copy(kExamples / "maneuvers/measured_profile.toml", folder / "a.toml");
  const auto read = [&](const std::string& csv) {
    folder.write("measured_profile.csv", csv);
    return read_maneuver(folder / "a.toml");
  };
  CHECK_THROWS_WITH(read("position,height\n0,0\n0.1,0.05\n0.1,0\n"),
                    Contains("measured_profile.csv:4: position = 0.1: must be > 0.1 m"));
  CHECK_THROWS_WITH(read("position,height\n0,0\n"), Contains("must be at least 3"));
  CHECK_THROWS_WITH(read("position,z\n0,0\n1,0\n"), Contains("no column 'height'"));
}

TEST_CASE("Springs and dampers may differ from left to right", "[io]") {
  const ChangedFile file(kSedan, "damping = 1980.0                # [1]\nupper = [-0.02897",
                         "damping = 1980.0\ndamping_right = 1500\nupper = [-0.02897");
  const SuspensionSpec front = read_vehicle(file.path()).suspension[kFront];
  CHECK(front.strut[0].damping == 1980.0);
  CHECK(front.strut[1].damping == 1500.0);
  const ChangedFile softer(kSedan, "stiffness = 35000.0             # [1]",
                           "stiffness = 35000.0\nstiffness_left = 30000");
  const SuspensionSpec rear = read_vehicle(softer.path()).suspension[kRear];
  CHECK(rear.strut[0].stiffness == 30000.0);
  CHECK(rear.strut[0].nominal_stiffness == 30000.0);
  CHECK(rear.strut[1].stiffness == 35000.0);
  check_refused("damping = 1980.0                # [1]\nupper = [-0.02897",
                "damping_left = -1\ndamping = 1980\nupper = [-0.02897",
                "front_suspension.damper.damping_left = -1");
}

TEST_CASE("A car's tire may be a measured curve, of its own file or of the tire's", "[io]") {
  const std::string name = "file = \"../tires/paper_sedan.tir\"";
  const ChangedFile file(kSedan, name, name + "\ncurve = [[0, 0], [0.01, 1500], [0.03, 6500]]");
  const TireContactSpec tire = read_vehicle(file.path()).tire;
  CHECK(tire.curve.force == std::vector<double>{0.0, 1500.0, 6500.0});
  CHECK(tire.stiffness == Approx((15.0 + 195.0) / 0.001));
  const auto refuse = [&](const std::string& line, const std::string& message) {
    const ChangedFile changed(kSedan, name, name + "\n" + line);
    CHECK_THROWS_WITH(read_vehicle(changed.path()), Contains("tire.curve = ") && Contains(message));
  };
  refuse("curve = [[0, 0], [0.01, 2000]]\nstiffness = 200000", "must be one of the two");
  refuse("curve = [[0, 0], [0.01, 2000], [0.02, 1000]]", "must increase");
  // In millimeters
  refuse("curve = [[0, 0], [10, 2000]]", "tire_stiffness would be 200");

  const ChangedFile plain(kSedan, "[tire]", "[tire]");
  const fs::path tir = plain.path().parent_path() / "../tires/paper_sedan.tir";
  std::string text = test::read_text(tir);
  text += "[DEFLECTION_LOAD_CURVE]\n{pen fz}\n0 0\n0.02 4400\n";
  std::ofstream(tir) << text;
  CHECK(read_vehicle(plain.path()).tire.stiffness == Approx(220000.0));
  CHECK(read_vehicle(plain.path()).tire.curve.x == std::vector<double>{0.0, 0.02});
}

TEST_CASE("A damper may be a measured curve", "[io]") {
  const std::string rate = "damping = 1980.0                # [1]\nupper = [-0.02897";
  const ChangedFile file(kSedan, rate,
                         "curve = [[-0.5, -1200], [0, 0], [0.5, 600]]\nupper = [-0.02897");
  const SuspensionSpec front = read_vehicle(file.path()).suspension[kFront];
  CHECK(front.damper_curve.force == std::vector<double>{-1200.0, 0.0, 600.0});
  CHECK(front.strut[1].damping == Approx(1800.0));  // the mean of 2400 and 1200
  check_refused(rate, "curve = [[-0.5, -1200], [0, 0]]\nupper = [-0.02897",
                "front_suspension.damper.curve = ");
  check_refused(rate, "curve = [[-0.5, -1200, 1]]\nupper = [-0.02897",
                "front_suspension.damper.curve = ");
  check_refused(rate, "curve = [[-1, -1], [0, 0], [1, 1]]\ndamping = 1\nupper = [-0.02897",
                "front_suspension.damper.curve = ");
}

}  // namespace
}  // namespace strut
