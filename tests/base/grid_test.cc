// The grid: numbers and levels.
#include "base/math/grid.h"

#include <catch2/catch.hpp>

#include "base/error/input_error.h"

namespace strut {
namespace {

TEST_CASE("A grid counts like an odometer, the first axis slowest", "[unit]") {
  const Grid grid({{"a", 1.0, 1.0, 2}, {"b", 10.0, -2.0, 3}, {"c", 0.0, 0.5, 4}});
  CHECK(grid.size() == 24);
  std::int64_t id = 0;
  for (std::int64_t a = 0; a < 2; ++a) {
    for (std::int64_t b = 0; b < 3; ++b) {
      for (std::int64_t c = 0; c < 4; ++c, ++id) {
        std::vector<std::int64_t> levels(3, -1);
        grid.calc_levels(id, levels);
        CHECK(levels == std::vector<std::int64_t>{a, b, c});
        CHECK(grid.calc_id(levels) == id);
      }
    }
  }
}

TEST_CASE("An axis goes from its first value in equal steps to its last", "[unit]") {
  const Axis axis{"front_stiffness", 40000.0, -500.0, 10};
  CHECK(axis.calc_value(0) == 40000.0);
  CHECK(axis.calc_value(1) == 39500.0);
  CHECK(axis.last() == 35500.0);
}

TEST_CASE("A grid has as many points as can be counted, and no more", "[unit]") {
  const std::int64_t large = std::int64_t{1} << 31;
  const Grid grid({{"a", 0.0, 1.0, large}, {"b", 0.0, 1.0, large}});
  CHECK(grid.size() == std::int64_t{1} << 62);
  std::vector<std::int64_t> levels(2);
  grid.calc_levels(grid.size() - 1, levels);
  CHECK(levels == std::vector<std::int64_t>{large - 1, large - 1});
  CHECK_THROWS_AS(Grid({{"a", 0.0, 1.0, large}, {"b", 0.0, 1.0, large}, {"c", 0.0, 1.0, 2}}),
                  InputError);
}

}  // namespace
}  // namespace strut
