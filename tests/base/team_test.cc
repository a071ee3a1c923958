// Items shared among threads.
#include "base/parallel/team.h"

#include <catch2/catch.hpp>
#include <vector>

namespace strut {

TEST_CASE("Large items run side by side, and what does not fill the threads gets all of them",
          "[unit]") {
  std::vector<int> inside(5, 0), calls(5, 0);
  share_large_items(2, inside.size(), [&](std::size_t item, int threads) {
    inside[item] = threads;
    ++calls[item];
  });
  CHECK(calls == std::vector<int>{1, 1, 1, 1, 1});
  CHECK(inside == std::vector<int>{1, 1, 1, 1, 2});
  share_large_items(4, 3, [&](std::size_t item, int threads) { inside[item] = threads; });
  CHECK(inside == std::vector<int>{1, 1, 1, 1, 2});
  share_large_items(4, 1, [&](std::size_t item, int threads) { inside[item] = threads; });
  CHECK(inside.front() == 4);
  CHECK_THROWS_AS(share_large_items(2, 2, [](std::size_t, int) { throw 1; }), int);
}

}  // namespace strut
