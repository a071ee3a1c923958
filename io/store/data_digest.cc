#include "io/store/data_digest.h"

#include <fmt/format.h>

#include <charconv>

#include "base/error/input_error.h"

namespace strut {
namespace {

std::array<std::uint64_t, 4> read_words(const Hash& hash) {
  std::array<std::uint64_t, 4> words{};
  for (std::size_t i = 0; i < hash.size(); ++i) {
    words[i / 8] |= std::uint64_t{hash[i]} << (8 * (i % 8));
  }
  return words;
}

InputError digest_error(const std::string& text) {
  return InputError(fmt::format("data digest '{}': not a digest", text));
}

// Reads the number at `at` and advances `at` past it and one separator.
std::uint64_t take_number(const std::string& text, std::size_t& at, int base) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + at, end, value, base);
  if (error != std::errc{}) throw digest_error(text);
  at = static_cast<std::size_t>(stop - text.data()) + (stop == end ? 0 : 1);
  return value;
}

}  // namespace

void DataDigest::add(const Hash& row) {
  const auto words = read_words(row);
  for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += words[i];
  ++count_;
}

void DataDigest::add(const DataDigest& other) {
  for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += other.sum_[i];
  count_ += other.count_;
}

std::string DataDigest::text() const { return to_hex(calc_sha256(state())); }

std::string DataDigest::state() const {
  return fmt::format("{}:{:x}", count_, fmt::join(sum_, ":"));
}

DataDigest DataDigest::parse(const std::string& state) {
  DataDigest digest;
  std::size_t at = 0;
  digest.count_ = take_number(state, at, 10);
  for (std::uint64_t& word : digest.sum_) word = take_number(state, at, 16);
  // Each digest has one notation: signs, spaces, leading zeros and trailing text are damage.
  if (digest.state() != state) throw digest_error(state);
  return digest;
}

}  // namespace strut
