// Numbers by place: Philox against its published values, permutations against their definition.
#include "base/math/random.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iterator>
#include <vector>

#include "base/math/permutation.h"

namespace strut {
namespace {

using Block = std::array<std::uint32_t, 4>;

TEST_CASE("Philox gives the published known answers", "[unit][reference]") {
  // Random123 1.14, tests/kat_vectors, lines "philox4x32 10 ...".
  CHECK(calc_philox({0, 0, 0, 0}, {0, 0}) == Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  CHECK(calc_philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
        Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(calc_philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("Random bits are the block's of seed, stream and counter", "[unit]") {
  const Block block =
      calc_philox({0x13198a2e, 0x03707344, 0x243f6a88, 0x85a308d3}, {0xa4093822, 0x299f31d0});
  CHECK(calc_random_bits(0x299f31d0a4093822, 0x85a308d3243f6a88, 0x0370734413198a2e) ==
        (block[0] | static_cast<std::uint64_t>(block[1]) << 32));
}

TEST_CASE("Uniform numbers have the moments of their interval and fill it evenly",
          "[unit][statistical]") {
  constexpr int kCount = 100000, kBins = 100;
  double mean = 0.0, square = 0.0, product = 0.0, before = 0.5;
  std::vector<int> bins(kBins, 0);
  for (int i = 0; i < kCount; ++i) {
    const double u = calc_uniform(7, 3, static_cast<std::uint64_t>(i));
    REQUIRE(u >= 0.0);
    REQUIRE(u < 1.0);
    mean += u / kCount;
    square += u * u / kCount;
    product += (u - 0.5) * (before - 0.5) / kCount;
    before = u;
    ++bins[static_cast<std::size_t>(u * kBins)];
  }
  double chi2 = 0.0;
  const double expected = static_cast<double>(kCount) / kBins;
  for (const int n : bins) chi2 += std::pow(n - expected, 2) / expected;
  // Five standard deviations; 99 degrees of freedom: 99 +- 14.
  CHECK(std::abs(mean - 0.5) < 5.0 * std::sqrt(1.0 / 12.0 / kCount));
  CHECK(std::abs(square - 1.0 / 3.0) < 5.0 * std::sqrt(4.0 / 45.0 / kCount));
  CHECK(std::abs(product) < 5.0 / 12.0 / std::sqrt(kCount));
  CHECK(std::abs(chi2 - 99.0) < 5.0 * std::sqrt(2.0 * 99.0));
}

TEST_CASE("Streams and seeds are unrelated", "[unit][statistical]") {
  constexpr int kCount = 100000;
  double streams = 0.0, seeds = 0.0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const double u = calc_uniform(1, 0, i) - 0.5;
    streams += u * (calc_uniform(1, 1, i) - 0.5) / kCount;
    seeds += u * (calc_uniform(2, 0, i) - 0.5) / kCount;
  }
  CHECK(std::abs(streams) < 5.0 / 12.0 / std::sqrt(kCount));
  CHECK(std::abs(seeds) < 5.0 / 12.0 / std::sqrt(kCount));
}

TEST_CASE("A permutation hits every number once and knows the way back", "[unit][property]") {
  for (const std::int64_t n : {1, 2, 3, 5, 16, 17, 255, 256, 257, 1000, 4096, 10000}) {
    for (const std::uint64_t seed : {0U, 1U, 99U}) {
      const Permutation permutation(n, seed, 4);
      std::vector<int> hits(static_cast<std::size_t>(n), 0);
      for (std::int64_t i = 0; i < n; ++i) {
        const std::int64_t value = permutation.apply(i);
        REQUIRE(value >= 0);
        REQUIRE(value < n);
        ++hits[static_cast<std::size_t>(value)];
        REQUIRE(permutation.invert(value) == i);
      }
      CAPTURE(n, seed);
      CHECK(hits == std::vector<int>(static_cast<std::size_t>(n), 1));
    }
  }
}

TEST_CASE("A permutation of more numbers than memory holds goes there and back",
          "[unit][property]") {
  for (const std::int64_t n :
       {std::int64_t{1} << 32, std::int64_t{1000000007}, std::int64_t{1} << 62}) {
    const Permutation permutation(n, 5, 0);
    for (std::int64_t i = 0; i < 100; ++i) {
      const std::int64_t index = n / 101 * i + 3;
      const std::int64_t value = permutation.apply(index);
      REQUIRE(value >= 0);
      REQUIRE(value < n);
      CHECK(permutation.invert(value) == index);
    }
  }
  CHECK_THROWS(Permutation(0, 1, 1));
  CHECK_THROWS(Permutation((std::int64_t{1} << 62) + 1, 1, 1));
}

/// Pearson's chi-square of counts that should be equal.
double calc_chi2(const std::vector<int>& counts, double expected) {
  double chi2 = 0.0;
  for (const int n : counts) chi2 += (n - expected) * (n - expected) / expected;
  return chi2;
}

TEST_CASE("Over the seeds a place takes every number, and a pair every pair, equally often",
          "[unit][statistical]") {
  // 6 has few networks of its own size, 24 and 100 lie between powers of four.
  for (const std::int64_t n : {6, 24, 100}) {
    const auto size = static_cast<std::size_t>(n);
    const int seeds = 40 * static_cast<int>(n * n);
    std::vector<int> first(size, 0), last(size, 0), pairs(size * size, 0);
    for (int seed = 0; seed < seeds; ++seed) {
      const Permutation permutation(n, static_cast<std::uint64_t>(seed), 0);
      const auto a = static_cast<std::size_t>(permutation.apply(0));
      const auto b = static_cast<std::size_t>(permutation.apply(1));
      ++first[a];
      ++last[static_cast<std::size_t>(permutation.apply(n - 1))];
      ++pairs[a * size + b];
    }
    std::vector<int> different;
    different.reserve(size * (size - 1));
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (i / size != i % size) different.push_back(pairs[i]);
      if (i / size == i % size) CHECK(pairs[i] == 0);
    }
    const double f = static_cast<double>(n - 1), g = static_cast<double>(n * (n - 1) - 1);
    CAPTURE(n);
    CHECK(std::abs(calc_chi2(first, seeds / static_cast<double>(n)) - f) < 5.0 * std::sqrt(2 * f));
    CHECK(std::abs(calc_chi2(last, seeds / static_cast<double>(n)) - f) < 5.0 * std::sqrt(2 * f));
    CHECK(std::abs(calc_chi2(different, seeds / (g + 1.0)) - g) < 5.0 * std::sqrt(2 * g));
  }
}

TEST_CASE("Over the seeds every order of four is equally likely", "[unit][statistical]") {
  constexpr int kSeeds = 24000;
  std::vector<int> orders(256, 0), counts;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Permutation permutation(4, static_cast<std::uint64_t>(seed), 0);
    std::int64_t code = 0;
    for (std::int64_t i = 0; i < 4; ++i) code = 4 * code + permutation.apply(i);
    ++orders[static_cast<std::size_t>(code)];
  }
  std::copy_if(orders.begin(), orders.end(), std::back_inserter(counts),
               [](int n) { return n > 0; });
  REQUIRE(counts.size() == 24);
  CHECK(std::abs(calc_chi2(counts, kSeeds / 24.0) - 23.0) < 5.0 * std::sqrt(46.0));
}

TEST_CASE("Over the seeds as many orders of sixteen are odd as even", "[unit][statistical]") {
  // A network of just sixteen numbers would make even ones alone.
  constexpr int kSeeds = 4000;
  int odd = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Permutation permutation(16, static_cast<std::uint64_t>(seed), 0);
    int inversions = 0;
    for (std::int64_t i = 0; i < 16; ++i) {
      for (std::int64_t j = 0; j < i; ++j) {
        if (permutation.apply(j) > permutation.apply(i)) ++inversions;
      }
    }
    odd += inversions % 2;
  }
  CHECK(std::abs(odd - kSeeds / 2) < 5.0 * std::sqrt(kSeeds / 4.0));
}

TEST_CASE("A permutation keeps nothing of the order", "[unit][statistical]") {
  constexpr std::int64_t kSize = 10000;
  const Permutation permutation(kSize, 1, 0);
  double with_index = 0.0, with_next = 0.0;
  const double mean = 0.5 * (kSize - 1), variance = kSize * kSize / 12.0;
  for (std::int64_t i = 0; i < kSize; ++i) {
    const double value = static_cast<double>(permutation.apply(i)) - mean;
    const double next = static_cast<double>(permutation.apply((i + 1) % kSize)) - mean;
    with_index += value * (static_cast<double>(i) - mean) / variance / kSize;
    with_next += value * next / variance / kSize;
  }
  CHECK(std::abs(with_index) < 5.0 / std::sqrt(kSize));
  CHECK(std::abs(with_next) < 5.0 / std::sqrt(kSize));
}

}  // namespace
}  // namespace strut
