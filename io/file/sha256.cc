#include "io/file/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include "base/error/input_error.h"

namespace strut {

struct Sha256::State {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  ~State() { EVP_MD_CTX_free(context); }
};

namespace {

// EVP fails only if memory or the algorithm itself is missing.
void require(int good) {
  if (good != 1) throw EnvironmentError("OpenSSL: SHA-256 is not available");
}

}  // namespace

Sha256::Sha256() : state_(std::make_unique<State>()) {
  require(EVP_DigestInit_ex(state_->context, EVP_sha256(), nullptr));
}

Sha256::~Sha256() = default;

void Sha256::update(std::span<const std::byte> bytes) {
  require(EVP_DigestUpdate(state_->context, bytes.data(), bytes.size()));
}

void Sha256::update(const std::string& text) { update(std::as_bytes(std::span(text))); }

Hash Sha256::finish() {
  Hash hash;
  require(EVP_DigestFinal_ex(state_->context, hash.data(), nullptr));
  // A null type keeps the previous one, which saves a lookup.
  require(EVP_DigestInit_ex(state_->context, nullptr, nullptr));
  return hash;
}

Hash calc_sha256(std::span<const std::byte> bytes) {
  Sha256 hash;
  hash.update(bytes);
  return hash.finish();
}

Hash calc_sha256(const std::string& text) { return calc_sha256(std::as_bytes(std::span(text))); }

std::string to_hex(std::span<const std::uint8_t> bytes) {
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

}  // namespace strut
