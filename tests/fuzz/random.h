// Random numbers of the fuzzer: the same on every machine, determined by a few numbers that a
// finding prints.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace strut::fuzz {

/// Splitmix64 (Steele, Lea and Flood 2014).
class Random {
 public:
  /// The sequence of these numbers.
  explicit Random(std::initializer_list<std::uint64_t> keys) {
    for (const std::uint64_t key : keys) state_ = next() ^ key;
  }

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  /// Returns 0 .. count - 1, or 0 if count is 0. The bias of the remainder does not matter here.
  std::size_t below(std::size_t count) { return count == 0 ? 0 : next() % count; }
  bool one_in(std::size_t count) { return below(count) == 0; }
  /// Returns a number of [1, max]: a uniform power of two, plus a uniform remainder below it.
  std::size_t log_uniform(std::size_t max) {
    std::size_t bits = 0;
    while (max >> bits > 1) ++bits;
    const std::size_t high = std::size_t{1} << below(bits + 1);
    const std::size_t value = high + below(high);
    return value < max ? value : max;
  }
  template <class T>
  const T& pick(const std::vector<T>& values) {
    return values[below(values.size())];
  }

 private:
  std::uint64_t state_ = 0;
};

}  // namespace strut::fuzz
