// An order-independent digest of a set of rows.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "io/file/sha256.h"

namespace strut {

/// Sum of row hashes: each SHA-256 is read as four little-endian 64-bit words, which are added word
/// by word modulo 2^64 (an additive multiset hash, Clarke et al. 2003, after Bellare and
/// Micciancio's AdHash). Shards, threads and jobs may therefore be summed in any order.
class DataDigest {
 public:
  void add(const Hash& row);
  void add(const DataDigest& other);
  /// Returns the SHA-256 of count and sum, 64 digits.
  std::string text() const;
  /// Converts count and sum to text, and back. `parse` throws InputError.
  std::string state() const;
  static DataDigest parse(const std::string& state);
  std::uint64_t count() const { return count_; }
  bool operator==(const DataDigest&) const = default;

 private:
  std::uint64_t count_ = 0;
  std::array<std::uint64_t, 4> sum_{};
};

}  // namespace strut
