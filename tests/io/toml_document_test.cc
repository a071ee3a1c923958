#include "io/format/toml_document.h"

#include <catch2/catch.hpp>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "base/text/range.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using test::TemporaryFolder;

const char* const kCar = R"(
[car]
mass = 1155.0
wheels = 4
name = "a"
open = true
place = [1, 2.5, -3]

[[car.rod]]
length = 0.1
[[car.rod]]
length = 0.2
)";

TEST_CASE("Values read as written", "[io]") {
  const TemporaryFolder folder;
  const Document document(folder.write("car.toml", kCar));
  const Table car = document.root().table("car");
  CHECK(car.number("mass", above(0.0, "kg")) == 1155.0);
  CHECK(car.number("wheels") == 4.0);
  CHECK(car.text("name") == "a");
  CHECK(car.choice("name", {"b", "a"}) == 1);
  CHECK(car.boolean_or("open", false));
  CHECK(car.vector("place") == std::array<double, 3>{1.0, 2.5, -3.0});
  CHECK(car.numbers("place").size() == 3);
  const auto rods = car.tables("rod");
  REQUIRE(rods.size() == 2);
  CHECK(rods[0].number("length") == 0.1);
  CHECK(rods[1].number("length") == 0.2);
  CHECK_NOTHROW(document.check_all_read());
}

TEST_CASE("A fallback applies only to a missing key", "[io]") {
  const TemporaryFolder folder;
  const Document document(folder.write("a.toml", "speed = 3\nside = 'left'\n"));
  const Table root = document.root();
  CHECK(root.number_or("speed", 20.0) == 3.0);
  CHECK(root.number_or("torque", 500.0) == 500.0);
  CHECK(root.choice_or("side", 0, {"both", "left"}) == 1);
  CHECK(root.choice_or("trim", 1, {"steady", "static"}) == 1);
  CHECK(root.text_or("name", "x") == "x");
  CHECK(root.vector_or("place", {1.0, 2.0, 3.0})[2] == 3.0);
  CHECK_FALSE(root.find_table("bump").has_value());
  CHECK_THROWS_AS(root.number_or("side", 1.0), InputError);
}

TEST_CASE("Every unread key is an error that names the nearest known one", "[io]") {
  const TemporaryFolder folder;
  const auto path =
      folder.write("car.toml", std::string(kCar) + "lenght = 3\n[motor]\npower = 1\n");
  const Document document(path);
  const Table car = document.root().table("car");
  for (const char* key : {"mass", "wheels", "name", "open", "place", "rod"}) CHECK(car.has(key));
  for (const Table& rod : car.tables("rod")) rod.number("length");
  CHECK_THROWS_WITH(
      document.check_all_read(),
      Contains("car.toml:13: unknown key 'car.rod[2].lenght'; did you mean 'length'?") &&
          Contains("car.toml:14: unknown key 'motor'"));
}

TEST_CASE("A key in an unread table is unknown even if its neighbor is read", "[io]") {
  const TemporaryFolder folder;
  const Document document(folder.write("a.toml", "[a]\nx = 1\n[b]\nx = 1\n"));
  document.root().table("a").number("x");
  document.root().table("b");
  CHECK_THROWS_WITH(document.check_all_read(), Contains("unknown key 'b.x'"));
}

TEST_CASE("A missing key names its table and the misspelled key", "[io]") {
  const TemporaryFolder folder;
  const Document document(folder.write("a.toml", "[car]\nmas = 1\n"));
  CHECK_THROWS_WITH(document.root().table("car").number("mass"),
                    Contains("a.toml:1: missing key 'car.mass'; is 'mas' meant to be it?"));
  CHECK_THROWS_WITH(document.root().table("road"), Contains("missing key 'road'"));
}

TEST_CASE("An error names file, line, key, value and what is allowed", "[io]") {
  const TemporaryFolder folder;
  const Document document(folder.write("a.toml", "[car]\nmass = -5\nname = 'x'\n"));
  const Table car = document.root().table("car");
  CHECK_THROWS_WITH(car.number("mass", above(0.0, "kg")),
                    EndsWith("a.toml:2: car.mass = -5: must be > 0 kg"));
  CHECK_THROWS_WITH(car.number("mass", between(1.0, 2.5)),
                    EndsWith("car.mass = -5: must lie in [1, 2.5]"));
  CHECK_THROWS_WITH(car.number("name"), EndsWith("a.toml:3: car.name = \"x\": must be a number"));
  CHECK_THROWS_WITH(car.text("mass"), EndsWith("car.mass = -5: must be a text in quotes"));
  CHECK_THROWS_WITH(car.table("mass"), EndsWith("must be a table"));
  CHECK_THROWS_WITH(car.choice("name", {"left", "right"}), Contains("must be one of left, right"));
  CHECK_THAT(car.error("mass", "too light").what(), EndsWith("car.mass = -5: too light"));
}

TEST_CASE("A range contains its bounds unless it is open", "[unit]") {
  CHECK(between(1.0, 2.0).contains(1.0));
  CHECK(between(1.0, 2.0).contains(2.0));
  CHECK_FALSE(between(1.0, 2.0).contains(2.0000001));
  CHECK(at_least(0.0).contains(0.0));
  CHECK_FALSE(above(0.0).contains(0.0));
  CHECK_FALSE(any_number().contains(std::numeric_limits<double>::infinity()));
}

TEST_CASE("No value that is not finite is accepted", "[io]") {
  const TemporaryFolder folder;
  const Document document(folder.write("a.toml", "a = nan\nb = inf\nc = [0, -inf, 0]\n"));
  CHECK_THROWS_AS(document.root().number("a"), InputError);
  CHECK_THROWS_AS(document.root().number("b", at_least(0.0)), InputError);
  CHECK_THROWS_WITH(document.root().vector("c"), Contains("c[2]") && Contains("finite"));
}

TEST_CASE("A vector has three numbers", "[io]") {
  const TemporaryFolder folder;
  const Document document(folder.write("a.toml", "a = [1, 2]\nb = [1, 'x', 3]\nc = 1\n"));
  for (const char* key : {"a", "b", "c"}) {
    CHECK_THROWS_AS(document.root().vector(key), InputError);
  }
}

TEST_CASE("A relative file name starts at the folder of the file that contains it", "[io]") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "cars");
  folder.write("tire.tir", "");
  const Document document(folder.write("cars/a.toml", "tire = '../tire.tir'\nroad = 'no.csv'\n"));
  CHECK(document.root().file("tire") == folder / "tire.tir");
  CHECK_THROWS_WITH(document.root().file("road"),
                    Contains("a.toml:2: road = \"no.csv\"") && Contains("file not found"));
}

TEST_CASE("A missing file and one that is not TOML are refused with the reason", "[io]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(Document(folder / "no.toml"), EndsWith("no.toml: file not found"));
  CHECK_THROWS_AS(Document(folder / ""), InputError);
  CHECK_THROWS_WITH(Document(folder.write("b.toml", "a = 1\nb = = 2\n")), Contains("b.toml:2: "));
  CHECK_THROWS_AS(Document(folder.write("c.toml", "a = 1\na = 2\n")), InputError);
  CHECK_NOTHROW(Document(folder.write("empty.toml", "")));
}

TEST_CASE("An edit distance counts single typing errors", "[unit]") {
  CHECK(edit_distance("mass", "mass") == 0);
  CHECK(edit_distance("mass", "mas") == 1);
  CHECK(edit_distance("mass", "mess") == 1);
  CHECK(edit_distance("mass", "amss") == 1);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("stiffness", "damping") == edit_distance("damping", "stiffness"));
}

TEST_CASE("Only a near name is suggested", "[unit]") {
  const std::vector<std::string> known = {"front_stiffness", "front_damping", "mass"};
  CHECK(nearest_name("front_stifness", known) == "front_stiffness");
  CHECK(nearest_name("maas", known) == "mass");
  CHECK(nearest_name("quaternion", known).empty());
}

TEST_CASE("The text of a number reads back as the same number", "[property]") {
  for (const double value : {0.1, 1.0 / 3.0, -0.0, 1.7976931348623157e308, 1155.0}) {
    CHECK(std::stod(format_number(value)) == value);
  }
  CHECK(format_number(0.1) == "0.1");
}

}  // namespace
}  // namespace strut
