#include "base/math/permutation.h"

#include <fmt/format.h>

#include <stdexcept>

#include "base/math/random.h"

namespace strut {
namespace {

/// Four rounds look random to an observer of few values (M. Luby, C. Rackoff, 1988); the other four
/// are margin.
constexpr int kRounds = 8;
constexpr int kMinHalfBits = 4;
constexpr std::int64_t kMaxSize = std::int64_t{1} << 62;

int find_half_bits(std::int64_t n) {
  int bits = kMinHalfBits;
  while (n > std::int64_t{1} << (2 * bits)) ++bits;
  return bits;
}

}  // namespace

Permutation::Permutation(std::int64_t n, std::uint64_t seed, std::uint64_t stream)
    : size_(n), seed_(seed), stream_(stream), half_bits_(0) {
  if (n < 1 || n > kMaxSize) {
    throw std::invalid_argument(fmt::format("Permutation: n = {}: must lie in [1, 2^62]", n));
  }
  half_bits_ = find_half_bits(n);
}

std::uint64_t Permutation::calc_round(int round, std::uint64_t half) const {
  // A half has at most 31 bits, so round and half fit into one counter.
  const std::uint64_t counter = half | static_cast<std::uint64_t>(round) << 32;
  return calc_random_bits(seed_, stream_, counter) >> (64 - half_bits_);
}

std::int64_t Permutation::apply(std::int64_t index) const {
  const std::uint64_t mask = (std::uint64_t{1} << half_bits_) - 1;
  auto value = static_cast<std::uint64_t>(index);
  do {
    std::uint64_t left = value >> half_bits_, right = value & mask;
    for (int round = 0; round < kRounds; ++round) {
      const std::uint64_t next = left ^ calc_round(round, right);
      left = right;
      right = next;
    }
    value = left << half_bits_ | right;
  } while (value >= static_cast<std::uint64_t>(size_));
  return static_cast<std::int64_t>(value);
}

std::int64_t Permutation::invert(std::int64_t value) const {
  const std::uint64_t mask = (std::uint64_t{1} << half_bits_) - 1;
  auto index = static_cast<std::uint64_t>(value);
  do {
    std::uint64_t left = index >> half_bits_, right = index & mask;
    for (int round = kRounds; round-- > 0;) {
      const std::uint64_t previous = right ^ calc_round(round, left);
      right = left;
      left = previous;
    }
    index = left << half_bits_ | right;
  } while (index >= static_cast<std::uint64_t>(size_));
  return static_cast<std::int64_t>(index);
}

}  // namespace strut
