// A digest of a set of rows that does not depend on their order.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "io/file/sha256.h"

namespace strut {

/// Sum of row hashes: each SHA-256 read as four little-endian 64-bit words, word by word modulo
/// 2^64 (an additive multiset hash, Clarke et al. 2003, after Bellare and Micciancio's AdHash). So
/// shards, threads and jobs may be summed in any order.
class DataDigest {
 public:
  void add(const Hash& row);
  void add(const DataDigest& other);
  /// Takes a row out again, as where a retry replaces it.
  void subtract(const Hash& row);
  /// SHA-256 of count and sum, 64 digits.
  std::string text() const;
  /// Count and sum as text, and back. `parse` throws InputError.
  std::string state() const;
  static DataDigest parse(const std::string& state);
  std::uint64_t count() const { return count_; }
  bool operator==(const DataDigest&) const = default;

 private:
  std::uint64_t count_ = 0;
  std::array<std::uint64_t, 4> sum_{};
};

}  // namespace strut
