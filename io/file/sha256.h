// SHA-256, the hash of every checksum and identity here: `sha256sum` computes the same.
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
  /// The hash of all that came in; the object starts anew.
  Hash finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

Hash calc_sha256(std::span<const std::byte> bytes);
Hash calc_sha256(const std::string& text);

/// 64 lower-case digits.
std::string to_hex(const Hash& hash);

}  // namespace strut
