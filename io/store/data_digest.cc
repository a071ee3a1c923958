#include "io/store/data_digest.h"

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

std::string to_digits(std::uint64_t value, int base) {
  std::array<char, 24> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, base);
  return {digits.data(), end.ptr};
}

// The number at `at`, which moves behind it and one separator.
std::uint64_t take_number(const std::string& text, std::size_t& at, int base) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + at, end, value, base);
  if (error != std::errc{}) throw InputError("data digest '" + text + "': not a digest");
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

void DataDigest::subtract(const Hash& row) {
  const auto words = read_words(row);
  for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] -= words[i];
  --count_;
}

std::string DataDigest::text() const { return to_hex(calc_sha256(state())); }

std::string DataDigest::state() const {
  std::string text = to_digits(count_, 10);
  for (const std::uint64_t word : sum_) text += ":" + to_digits(word, 16);
  return text;
}

DataDigest DataDigest::parse(const std::string& state) {
  DataDigest digest;
  std::size_t at = 0;
  digest.count_ = take_number(state, at, 10);
  for (std::uint64_t& word : digest.sum_) word = take_number(state, at, 16);
  // One way to write each digest: signs, spaces, leading zeros and trailing text are damage.
  if (digest.state() != state) throw InputError("data digest '" + state + "': not a digest");
  return digest;
}

}  // namespace strut
