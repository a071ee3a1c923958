// SHA-256, the hash of all checksums and identities; `sha256sum` computes the same.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace strut {

using Hash = std::array<std::uint8_t, 32>;

class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void update(std::span<const std::byte> bytes);
  void update(const std::string& text);
  /// Returns the hash of all bytes since construction or the last finish().
  Hash finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

Hash calc_sha256(std::span<const std::byte> bytes);
Hash calc_sha256(const std::string& text);

/// Two lower-case digits per byte.
std::string to_hex(std::span<const std::uint8_t> bytes);

}  // namespace strut
