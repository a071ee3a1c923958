// Layers: allocation, membership, drawing, and sums over grids against enumeration.
#include "base/math/strata.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <set>

#include "base/math/grid_sums.h"
#include "base/math/random.h"

namespace strut {
namespace {

using Counts = std::vector<std::int64_t>;

TEST_CASE("Allocation is proportional, whole by the largest remainder", "[unit]") {
  CHECK(allocate_proportionally(2000, Counts(10, 1000)) == Counts(10, 200));
  // Shares 1.5, 2.5, 1.0: two halves, one place; the lower index has it.
  CHECK(allocate_proportionally(5, Counts{3, 5, 2}) == Counts{2, 2, 1});
  // Shares 4.2, 3.5, 2.3.
  CHECK(allocate_proportionally(10, Counts{42, 35, 23}) == Counts{4, 4, 2});
  CHECK(allocate_proportionally(3, Counts(10, 7)) == Counts{1, 1, 1, 0, 0, 0, 0, 0, 0, 0});
  CHECK(allocate_proportionally(0, Counts{3, 5}) == Counts{0, 0});
  CHECK(allocate_proportionally(8, Counts{3, 5}) == Counts{3, 5});
  CHECK_THROWS(allocate_proportionally(9, Counts{3, 5}));
  CHECK_THROWS(allocate_proportionally(-1, Counts{3, 5}));
}

TEST_CASE("Allocation adds up, stays within one of the share, and takes nothing that is not there",
          "[unit][property]") {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    Counts populations(1 + calc_random_bits(1, trial, 0) % 12);
    const int bits = trial % 2 == 0 ? 60 : 6;  // products beyond 64 bits, and many ties
    for (std::size_t i = 0; i < populations.size(); ++i) {
      populations[i] =
          static_cast<std::int64_t>(calc_random_bits(1, trial, i + 1) >> (64 - bits)) / 16;
    }
    const std::int64_t total = std::accumulate(populations.begin(), populations.end(), 0LL);
    if (total == 0) continue;
    const auto count =
        static_cast<std::int64_t>(calc_uniform(2, trial, 0) * static_cast<double>(total));
    const Counts quotas = allocate_proportionally(count, populations);
    CHECK(std::accumulate(quotas.begin(), quotas.end(), 0LL) == count);
    for (std::size_t i = 0; i < quotas.size(); ++i) {
      const long double share = static_cast<long double>(count) * populations[i] / total;
      REQUIRE(quotas[i] <= populations[i]);
      REQUIRE(std::fabs(static_cast<double>(quotas[i] - share)) < 1.0 + 1e-9);
    }
  }
}

TEST_CASE("Levels fill the strata in order and as evenly as they can", "[unit][property]") {
  for (const std::int64_t levels : {1, 7, 10, 11, 1000}) {
    for (const int strata : {1, 3, 7, 10}) {
      Counts sizes(static_cast<std::size_t>(strata), 0);
      int before = 0;
      for (std::int64_t level = 0; level < levels; ++level) {
        const int stratum = find_stratum(level, levels, strata);
        REQUIRE(stratum >= before);
        REQUIRE(stratum < strata);
        REQUIRE(level >= find_first_level(stratum, levels, strata));
        REQUIRE(level < find_first_level(stratum + 1, levels, strata));
        before = stratum;
        ++sizes[static_cast<std::size_t>(stratum)];
      }
      CAPTURE(levels, strata);
      CHECK(find_first_level(strata, levels, strata) == levels);
      const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
      CHECK(*most - *least <= 1);
    }
  }
  CHECK(find_stratum((std::int64_t{1} << 62) - 1, std::int64_t{1} << 62, 10) == 9);
}

TEST_CASE("A stratified sample meets its quotas without repeats", "[unit][property]") {
  const auto stratum_of = [](std::int64_t i) { return static_cast<int>(i % 4); };
  const Counts quotas = {5, 0, 25, 1};
  const Counts drawn = draw_stratified(quotas, Permutation(100, 3, 0), stratum_of);
  CHECK(std::is_sorted(drawn.begin(), drawn.end()));
  CHECK(std::set<std::int64_t>(drawn.begin(), drawn.end()).size() == 31);
  Counts found(4, 0);
  for (const std::int64_t i : drawn) ++found[static_cast<std::size_t>(stratum_of(i))];
  CHECK(found == quotas);
  CHECK(draw_stratified(quotas, Permutation(100, 3, 0), stratum_of) == drawn);
  CHECK(draw_stratified(quotas, Permutation(100, 4, 0), stratum_of) != drawn);
}

TEST_CASE("Every member of a stratum is drawn equally often", "[unit][statistical]") {
  constexpr int kSeeds = 20000;
  const auto stratum_of = [](std::int64_t i) { return i < 10 ? 0 : 1; };
  std::vector<int> counts(30, 0);
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Permutation order(30, static_cast<std::uint64_t>(seed), 1);
    for (const std::int64_t i : draw_stratified({2, 4}, order, stratum_of)) {
      ++counts[static_cast<std::size_t>(i)];
    }
  }
  // Both strata give a fifth; five standard deviations of a binomial.
  for (const int n : counts) CHECK(std::abs(n - 0.2 * kSeeds) < 5.0 * std::sqrt(0.16 * kSeeds));
}

std::vector<RankedPoint> enumerate(const std::vector<SumAxis>& axes) {
  std::vector<RankedPoint> points = {{0, 0}};
  for (const SumAxis& axis : axes) {
    std::vector<RankedPoint> longer;
    for (const RankedPoint& p : points) {
      for (std::int64_t i = 0; i < axis.count; ++i) {
        longer.push_back({p.sum + i * axis.weight, p.id * axis.count + i});
      }
    }
    points = longer;
  }
  std::sort(points.begin(), points.end());
  return points;
}

TEST_CASE("The point of any rank is the one that sorting the whole grid finds",
          "[unit][property][reference]") {
  const std::vector<std::vector<SumAxis>> grids = {
      {{10, 5}, {10, 4}, {10, 5}, {10, 4}},  // many ties, as the paper's grid
      {{3, 7}},
      {{1, 0}, {1, 5}},
      {{4, 0}, {5, 3}},       // a weight of zero
      {{2, 1000}, {300, 1}},  // halves that differ much
      {{300, 1}, {2, 1000}},
      {{7, 11}, {2, 3}, {5, 1}, {3, 4}, {2, 9}}};
  for (const auto& axes : grids) {
    const std::vector<RankedPoint> points = enumerate(axes);
    const GridSums sums(axes);
    REQUIRE(sums.size() == static_cast<std::int64_t>(points.size()));
    for (std::size_t rank = 0; rank<points.size(); rank += points.size()> 1000 ? 37 : 1) {
      REQUIRE(sums.find(static_cast<std::int64_t>(rank)) == points[rank]);
    }
    CHECK(sums.find(sums.size() - 1) == points.back());
    CHECK(sums.count_up_to(-1) == 0);
    CHECK(sums.count_up_to(points.back().sum) == sums.size());
  }
}

TEST_CASE("A grid that cannot be halved is refused", "[unit]") {
  CHECK_THROWS(GridSums({{GridSums::kMaxHalf + 1, 1}}));
}

}  // namespace
}  // namespace strut
