// A random permutation of 0 .. n - 1 that is computed, not stored.
#pragma once

#include <cstdint>

namespace strut {

/// Keyed bijection of [0, n), in constant memory: a balanced Feistel network over the next even
/// number of bits, with Philox as round function and cycle walking until the value is below n
/// (J. Black, P. Rogaway: "Ciphers with arbitrary finite domains", CT-RSA 2002). Small n use a
/// larger network, because a few bits allow only a few networks.
class Permutation {
 public:
  /// Throws std::invalid_argument unless 0 < n <= 2^62. Different streams of one seed give
  /// independent permutations.
  Permutation(std::int64_t n, std::uint64_t seed, std::uint64_t stream);

  std::int64_t size() const { return size_; }
  /// The value in [0, n) at `index`.
  std::int64_t apply(std::int64_t index) const;
  /// The index of `value`.
  std::int64_t invert(std::int64_t value) const;

 private:
  std::uint64_t calc_round(int round, std::uint64_t half) const;

  std::int64_t size_;
  std::uint64_t seed_, stream_;
  int half_bits_;
};

}  // namespace strut
