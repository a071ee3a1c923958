#include "io/file/file_seal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>

#include "base/error/check.h"
#include "io/file/file_bytes.h"
#include "io/file/file_sync.h"
#include "io/file/sha256.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr char kSize[] = "size", kSha256[] = "sha256", kSeal[] = "seal";

std::string make_first_line(const std::string& kind) {
  return fmt::format("strut {} seal 1", kind);
}

std::string render(const FileSeal& seal) {
  std::string text = make_first_line(seal.kind) + "\n";
  for (const auto& [key, value] : seal.lines) text += fmt::format("{} {}\n", key, value);
  text += fmt::format("{} {}\n{} {}\n", kSize, seal.size, kSha256, seal.sha256);
  text += fmt::format("{} {}\n", kSeal, to_hex(calc_sha256(text)));
  STRUT_CHECK(text.size() <= kSealBytes,
              fmt::format("a seal of more than {} bytes: {}", kSealBytes, text));
  text.resize(kSealBytes, '\0');
  return text;
}

/// Returns the line at `at` and advances `at` to the next one.
std::string take_line(const std::string& text, std::size_t& at) {
  const std::size_t end = std::min(text.find('\n', at), text.size());
  std::string line = text.substr(at, end - at);
  at = std::min(end + 1, text.size());
  return line;
}

/// Reads the lines of a seal of kind `kind` from `at` on, valid or not.
FileSeal read_lines(const std::string& kind, const std::string& text, std::size_t at) {
  FileSeal seal;
  seal.kind = kind;
  while (at < text.size()) {
    const std::string line = take_line(text, at);
    const std::size_t space = std::min(line.find(' '), line.size());
    const std::string key = line.substr(0, space);
    const std::string value = line.substr(std::min(space + 1, line.size()));
    if (key == kSeal) break;
    if (key == kSize) {
      std::from_chars(value.data(), value.data() + value.size(), seal.size);
    } else if (key == kSha256) {
      seal.sha256 = value;
    } else {
      seal.lines.emplace_back(key, value);
    }
  }
  return seal;
}

/// Returns whether a seal may be rendered: whether its text is short enough.
bool fits(const FileSeal& seal) {
  constexpr std::size_t kOwnLines = 192;  // bytes of the lines that every seal has, at most
  std::size_t length = make_first_line(seal.kind).size();
  for (const auto& [key, value] : seal.lines) length += key.size() + value.size();
  return length + seal.sha256.size() + kOwnLines <= kSealBytes;
}

/// Returns the seal in `bytes`; nullopt unless it renders to the very same bytes, so that every
/// changed byte of a seal is found.
std::optional<FileSeal> parse(std::span<const std::byte> bytes) {
  if (bytes.size() < kSealBytes) return std::nullopt;
  std::string text(kSealBytes, '\0');
  std::memcpy(text.data(), bytes.data(), kSealBytes);
  std::size_t at = 0;
  const std::string first = take_line(text, at), frame = make_first_line("");
  if (first.size() <= frame.size()) return std::nullopt;
  const std::string kind = first.substr(std::strlen("strut "), first.size() - frame.size());
  FileSeal seal = read_lines(kind, text, at);
  if (!fits(seal) || render(seal) != text) return std::nullopt;
  return seal;
}

constexpr char kOtherBytes[] = "damaged: its bytes do not match the SHA-256 of its seal";

void compare_hash(SealCheck& check, const std::string& sha256, const SealKind& kind) {
  if (sha256 == check.seal.sha256) return;
  check.fault = kOtherBytes;
  check.remedy = kind.remedy;
}

/// Returns the SHA-256 of all bytes after the seal; nullopt, with errno, if the file cannot be
/// read.
std::optional<std::string> hash_content(const FileDescriptor& file) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  if (!file.is_open()) return std::nullopt;
  std::vector<std::byte> block(kBlock);
  Sha256 hash;
  for (auto at = static_cast<off_t>(kSealBytes);;) {
    const ssize_t count = ::pread(file.get(), block.data(), block.size(), at);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return std::nullopt;
    if (count == 0) return to_hex(hash.finish());
    hash.update(std::span(block).first(static_cast<std::size_t>(count)));
    at += count;
  }
}

}  // namespace

std::string FileSeal::get(const std::string& key) const {
  const auto found =
      std::find_if(lines.begin(), lines.end(), [&](const auto& line) { return line.first == key; });
  return found == lines.end() ? "" : found->second;
}

SealCheck check_seal(std::span<const std::byte> first_bytes, std::uint64_t size,
                     const SealKind& kind) {
  const std::string name = kind.name;
  const std::optional<FileSeal> seal = parse(first_bytes);
  if (!seal) {
    return {{},
            fmt::format("damaged, or not a {} file: no valid seal in its first {} bytes", name,
                        kSealBytes),
            kind.remedy};
  }
  if (seal->kind != name) {
    return {*seal,
            fmt::format("not a {} file of strut: its seal is that of a {} file", name, seal->kind),
            ""};
  }
  if (seal->size != size) {
    return {*seal, fmt::format("damaged: has {} bytes, was {}", size, seal->size), kind.remedy};
  }
  return {*seal, "", ""};
}

SealCheck check_seal(const fs::path& path, const SealKind& kind) {
  const auto first_bytes = read_first_bytes(path, kSealBytes);
  std::error_code error;
  const std::uint64_t size = fs::file_size(path, error);
  if (error) throw InputError(fmt::format("{}: {}: {}", path.string(), kNotRead, error.message()));
  return check_seal(first_bytes, size, kind);
}

SealCheck check_sealed_file(const fs::path& path, const SealKind& kind) {
  SealCheck check = check_seal(path, kind);
  if (!check.fault.empty()) return check;
  const std::optional<std::string> sha256 = hash_content(open_regular_file(path));
  if (!sha256) throw file_failure(path, kNotRead, errno);
  compare_hash(check, *sha256, kind);
  return check;
}

SealCheck check_sealed_bytes(std::span<const std::byte> bytes, const SealKind& kind) {
  SealCheck check = check_seal(bytes, bytes.size(), kind);
  if (!check.fault.empty()) return check;
  compare_hash(check, to_hex(calc_sha256(bytes.subspan(kSealBytes))), kind);
  return check;
}

FileSeal require_intact(const fs::path& path, SealCheck check) {
  if (check.fault.empty()) return std::move(check.seal);
  throw InputError(fmt::format("{}: {}{}{}", path.string(), check.fault,
                               check.remedy.empty() ? "" : "; ", check.remedy));
}

SealedBytes read_sealed(const fs::path& path, const SealKind& kind) {
  require_intact(path, check_seal(path, kind));
  SealedBytes sealed{{}, read_bytes(path)};
  sealed.seal = require_intact(path, check_sealed_bytes(sealed.bytes, kind));
  return sealed;
}

std::string find_seal_kind(const fs::path& path) {
  const std::optional<FileSeal> seal = parse(read_first_bytes(path, kSealBytes));
  return seal ? seal->kind : "";
}

bool is_sealed(const fs::path& path) {
  constexpr std::array<char, 8> kSignature = {'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  const std::vector<std::byte> bytes = read_first_bytes(path, kSignature.size());
  return bytes.size() < kSignature.size() ||
         std::memcmp(bytes.data(), kSignature.data(), kSignature.size()) != 0;
}

void refuse_global_heap(const fs::path& path) {
  constexpr std::array<char, 8> kHeader = {'G', 'C', 'O', 'L', '\1', '\0', '\0', '\0'};
  constexpr std::size_t kBlock = std::size_t{1} << 20, kOverlap = kHeader.size() - 1;
  const FileDescriptor file = open_regular_file(path);
  std::vector<char> block(kBlock);
  for (off_t at = 0;; at += static_cast<off_t>(kBlock - kOverlap)) {
    const ssize_t count = ::pread(file.get(), block.data(), block.size(), at);
    if (count < 0) throw file_failure(path, kNotRead, errno);
    const auto end = block.begin() + count;
    if (std::search(block.begin(), end, kHeader.begin(), kHeader.end()) != end) {
      throw InputError(path.string() + ": " + kViewFault);
    }
    if (count < static_cast<ssize_t>(kBlock)) return;
  }
}

void seal_image(const SealLabel& label, std::span<std::byte> image) {
  const std::string text = render(
      {label.kind.name, label.lines, image.size(), to_hex(calc_sha256(image.subspan(kSealBytes)))});
  std::memcpy(image.data(), text.data(), text.size());
}

void seal_file(const SealLabel& label, const fs::path& path, const fs::path& shown) {
  const FileDescriptor file = open_file(path, O_RDWR);
  const std::optional<std::string> sha256 = hash_content(file);
  if (!sha256) throw file_failure(shown, "cannot be sealed", errno);
  const std::string text = render({label.kind.name, label.lines, fs::file_size(path), *sha256});
  write_all(file.get(), std::as_bytes(std::span(text)), shown);
}

}  // namespace strut
