// A random order of 0 .. n - 1 that is computed, not stored.
#pragma once

#include <cstdint>

namespace strut {

/// Keyed bijection of [0, n) by index, in constant memory: a balanced Feistel network over the next
/// even number of bits whose round function is Philox, walked along its cycle until it is back
/// below n (J. Black, P. Rogaway: "Ciphers with arbitrary finite domains", CT-RSA 2002). Small n
/// take a larger network, because few bits leave few networks to choose from.
class Permutation {
 public:
  /// 0 < n <= 2^62; throws std::invalid_argument. `stream` tells permutations of one seed apart.
  Permutation(std::int64_t n, std::uint64_t seed, std::uint64_t stream);

  std::int64_t size() const { return size_; }
  /// Where `index` of [0, n) goes.
  std::int64_t apply(std::int64_t index) const;
  /// The number that the permutation maps to `value`.
  std::int64_t invert(std::int64_t value) const;

 private:
  std::uint64_t calc_round(int round, std::uint64_t half) const;

  std::int64_t size_;
  std::uint64_t seed_, stream_;
  int half_bits_;
};

}  // namespace strut
