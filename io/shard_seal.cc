// The seal: 512 bytes of text in front of a shard that hold its size and hash.
#include <algorithm>
#include <charconv>
#include <cstring>
#include <stdexcept>

#include "io/file_bytes.h"
#include "io/shard.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr char kFirstLine[] = "strut shard seal 1";

std::string render(const ShardSeal& seal) {
  std::string text = std::string(kFirstLine) + "\nplan " + seal.plan_hash + "\nshard " +
                     std::to_string(seal.shard) + "\nsize " + std::to_string(seal.size) +
                     "\nsha256 " + seal.sha256 + "\n";
  text += "seal " + to_hex(calc_sha256(text)) + "\n";
  text.resize(kHdf5UserBlock, '\0');
  return text;
}

// The rest of the line at `at` behind `key`; `at` moves to the next line.
std::string take(const std::string& text, std::size_t& at, const std::string& key) {
  const std::size_t end = std::min(text.find('\n', at), text.size());
  const std::string line = text.substr(at, end - at);
  at = std::min(end + 1, text.size());
  return line.starts_with(key + " ") ? line.substr(key.size() + 1) : "";
}

template <class Integer>
Integer parse_integer(const std::string& text) {
  Integer value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// A seal is what renders to the very same bytes, so that no byte of it can be another.
ShardSeal parse(const fs::path& path, std::span<const std::byte> block) {
  std::string text(block.size(), '\0');
  std::memcpy(text.data(), block.data(), block.size());
  ShardSeal seal;
  std::size_t at = std::min(sizeof kFirstLine, text.size());
  seal.plan_hash = take(text, at, "plan");
  seal.shard = parse_integer<std::int64_t>(take(text, at, "shard"));
  seal.size = parse_integer<std::uint64_t>(take(text, at, "size"));
  seal.sha256 = take(text, at, "sha256");
  if (render(seal) != text) {
    throw InputError(path.string() + ": damaged, or no shard: no valid seal in its first " +
                     std::to_string(kHdf5UserBlock) + " bytes");
  }
  return seal;
}

ShardSeal parse_sized(const fs::path& path, std::span<const std::byte> block, std::uint64_t size) {
  ShardSeal seal = parse(path, block);
  if (seal.size != size) {
    throw InputError(path.string() + ": damaged: has " + std::to_string(size) + " bytes, was " +
                     std::to_string(seal.size));
  }
  return seal;
}

}  // namespace

std::string render_shard_seal(const std::string& plan_hash, std::int64_t shard,
                              std::span<const std::byte> image) {
  constexpr std::size_t kLongest = 128;
  if (plan_hash.size() > kLongest || plan_hash.find('\n') != std::string::npos) {
    throw std::logic_error("'" + plan_hash + "' does not fit a shard's seal");
  }
  return render(
      {plan_hash, shard, image.size(), to_hex(calc_sha256(image.subspan(kHdf5UserBlock)))});
}

ShardSeal read_shard_seal(const fs::path& path) {
  const auto block = read_first_bytes(path, kHdf5UserBlock);
  std::error_code error;
  const std::uint64_t size = fs::file_size(path, error);
  if (error) throw InputError(path.string() + ": cannot be read: " + error.message());
  return parse_sized(path, block, size);
}

ShardSeal read_shard_seal(const fs::path& path, std::span<const std::byte> bytes) {
  return parse_sized(path, bytes.first(std::min(bytes.size(), kHdf5UserBlock)), bytes.size());
}

ShardSeal check_shard_bytes(const fs::path& path, std::span<const std::byte> bytes) {
  ShardSeal seal = read_shard_seal(path, bytes);
  if (to_hex(calc_sha256(bytes.subspan(kHdf5UserBlock))) != seal.sha256) {
    throw InputError(path.string() + ": damaged: its bytes do not have the SHA-256 of its seal");
  }
  return seal;
}

std::vector<std::byte> read_shard_bytes(const fs::path& path) {
  read_shard_seal(path);
  return read_bytes(path);
}

ShardSeal check_shard_bytes(const fs::path& path) {
  return check_shard_bytes(path, read_shard_bytes(path));
}

}  // namespace strut
