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
  // A line has a space and an end beside its words.
  for (const auto& [key, value] : seal.lines) length += key.size() + value.size() + 2;
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

/// The bytes of a file that its seal covers.
struct SealedRange {
  std::size_t begin = 0, end = 0;
};

SealedRange get_sealed_range(std::size_t size, bool is_last) {
  return is_last ? SealedRange{0, size - kSealBytes} : SealedRange{kSealBytes, size};
}

/// Returns the SHA-256 of a range of bytes; nullopt, with errno, if the file cannot be read.
std::optional<std::string> hash_content(const FileDescriptor& file, const SealedRange& range) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  if (!file.is_open()) return std::nullopt;
  std::vector<std::byte> block(kBlock);
  Sha256 hash;
  for (std::size_t at = range.begin; at < range.end;) {
    const std::size_t wanted = std::min(block.size(), range.end - at);
    const ssize_t count = ::pread(file.get(), block.data(), wanted, static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return std::nullopt;
    if (count == 0) break;
    hash.update(std::span(block).first(static_cast<std::size_t>(count)));
    at += static_cast<std::size_t>(count);
  }
  return to_hex(hash.finish());
}

/// The last bytes of a file, at most as many as a seal has.
std::vector<std::byte> read_last_bytes(const FileDescriptor& file, const fs::path& path) {
  const std::size_t size = read_size(file, path), count = std::min(size, kSealBytes);
  std::vector<std::byte> bytes(count);
  const ssize_t done = ::pread(file.get(), bytes.data(), count, static_cast<off_t>(size - count));
  if (done < 0) throw file_failure(path, kNotRead, errno);
  bytes.resize(static_cast<std::size_t>(done));
  return bytes;
}

/// Whether the bytes were a seal before one of them changed, or one was added or lost.
bool resembles_seal(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  constexpr std::array<std::string_view, 3> kMarks = {"\nsize ", "\nsha256 ", "\nseal "};
  return std::any_of(kMarks.begin(), kMarks.end(), [&](std::string_view mark) {
    return text.find(mark) != std::string_view::npos;
  });
}

/// Whether a file's seal is in its last bytes. Merged files that end with it began with it once; of
/// other kinds a seal at the end only says what else the file is.
bool is_seal_last(std::span<const std::byte> first, std::span<const std::byte> last,
                  const SealKind& kind) {
  if (parse(first)) return false;
  const std::optional<FileSeal> seal = parse(last);
  if (seal) return kind.is_last || seal->kind != kind.name;
  return kind.is_last && !resembles_seal(first);
}

}  // namespace

std::string FileSeal::get(const std::string& key) const {
  const auto found =
      std::find_if(lines.begin(), lines.end(), [&](const auto& line) { return line.first == key; });
  return found == lines.end() ? "" : found->second;
}

SealCheck check_seal(std::span<const std::byte> seal_bytes, std::uint64_t size,
                     const SealKind& kind) {
  const std::string name = kind.name;
  const std::optional<FileSeal> seal = parse(seal_bytes);
  if (!seal) {
    return {{},
            fmt::format("damaged, or not a {} file: no valid seal in its {} {} bytes", name,
                        kind.is_last ? "last" : "first", kSealBytes),
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

namespace {

/// The bytes of a file where its seal is.
struct SealBytes {
  std::vector<std::byte> bytes;
  bool is_last = false;
};

/// A file is opened once, since a file system on a network answers late.
SealBytes read_seal_bytes(const FileDescriptor& file, const fs::path& path, const SealKind& kind) {
  std::vector<std::byte> first = read_from(file, path, kSealBytes);
  if (parse(first)) return {std::move(first), false};
  std::vector<std::byte> last = read_last_bytes(file, path);
  const bool is_last = is_seal_last(first, last, kind);
  return {std::move(is_last ? last : first), is_last};
}

SealCheck check_seal(const FileDescriptor& file, const fs::path& path, const SealKind& kind) {
  return check_seal(read_seal_bytes(file, path, kind).bytes, read_size(file, path), kind);
}

}  // namespace

SealCheck check_seal(const fs::path& path, const SealKind& kind) {
  return check_seal(open_regular_file(path), path, kind);
}

SealCheck check_sealed_file(const fs::path& path, const SealKind& kind) {
  const FileDescriptor file = open_regular_file(path);
  const SealBytes found = read_seal_bytes(file, path, kind);
  const std::size_t size = read_size(file, path);
  SealCheck check = check_seal(found.bytes, size, kind);
  if (!check.fault.empty()) return check;
  const std::optional<std::string> sha256 =
      hash_content(file, get_sealed_range(size, found.is_last));
  if (!sha256) throw file_failure(path, kNotRead, errno);
  compare_hash(check, *sha256, kind);
  return check;
}

SealCheck check_sealed_bytes(std::span<const std::byte> bytes, const SealKind& kind) {
  const std::size_t length = std::min(bytes.size(), kSealBytes);
  const auto first = bytes.first(length), last = bytes.last(length);
  const bool is_last = is_seal_last(first, last, kind);
  SealCheck check = check_seal(is_last ? last : first, bytes.size(), kind);
  if (!check.fault.empty()) return check;
  const SealedRange range = get_sealed_range(bytes.size(), is_last);
  const auto covered = bytes.subspan(range.begin, range.end - range.begin);
  compare_hash(check, to_hex(calc_sha256(covered)), kind);
  return check;
}

FileSeal require_intact(const fs::path& path, SealCheck check) {
  if (check.fault.empty()) return std::move(check.seal);
  throw InputError(fmt::format("{}: {}{}{}", path.string(), check.fault,
                               check.remedy.empty() ? "" : "; ", check.remedy));
}

SealedBytes read_sealed(const fs::path& path, const SealKind& kind) {
  const FileDescriptor file = open_regular_file(path);
  require_intact(path, check_seal(file, path, kind));
  if (::lseek(file.get(), 0, SEEK_SET) < 0) throw file_failure(path, kNotRead, errno);
  SealedBytes sealed;
  sealed.bytes = read_from(file, path, read_size(file, path));
  sealed.seal = require_intact(path, check_sealed_bytes(sealed.bytes, kind));
  return sealed;
}

std::string find_seal_kind(const fs::path& path) {
  const FileDescriptor file = open_regular_file(path);
  std::optional<FileSeal> seal = parse(read_from(file, path, kSealBytes));
  if (!seal) seal = parse(read_last_bytes(file, path));
  return seal ? seal->kind : "";
}

bool is_sealed(const fs::path& path) {
  constexpr std::array<char, 8> kSignature = {'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  const FileDescriptor file = open_regular_file(path);
  const std::vector<std::byte> bytes = read_from(file, path, kSignature.size());
  return bytes.size() < kSignature.size() ||
         std::memcmp(bytes.data(), kSignature.data(), kSignature.size()) != 0 ||
         resembles_seal(read_last_bytes(file, path));
}

void refuse_global_heap(const fs::path& path) {
  constexpr std::string_view kHeap("GCOL\1\0\0\0", 8), kAxis = "DIMENSION_SCALE";
  constexpr std::size_t kBlock = std::size_t{1} << 20, kOverlap = kAxis.size() - 1;
  const FileDescriptor file = open_regular_file(path);
  std::vector<char> block(kBlock);
  bool has_heap = false, has_axis = false;
  for (off_t at = 0;; at += static_cast<off_t>(kBlock - kOverlap)) {
    const ssize_t count = ::pread(file.get(), block.data(), block.size(), at);
    if (count < 0) throw file_failure(path, kNotRead, errno);
    const std::string_view text(block.data(), static_cast<std::size_t>(count));
    has_heap = has_heap || text.find(kHeap) != std::string_view::npos;
    has_axis = has_axis || text.find(kAxis) != std::string_view::npos;
    if (text.size() < kBlock) break;
  }
  if (!has_heap) return;
  throw InputError(path.string() + ": " + (has_axis ? kLostSealFault : kViewFault));
}

void seal_image(const SealLabel& label, std::vector<std::byte>& image) {
  const bool is_last = label.kind.is_last;
  if (is_last) image.resize(image.size() + kSealBytes);
  const SealedRange range = get_sealed_range(image.size(), is_last);
  const auto covered = std::span(image).subspan(range.begin, range.end - range.begin);
  const std::string text =
      render({label.kind.name, label.lines, image.size(), to_hex(calc_sha256(covered))});
  std::memcpy(image.data() + (is_last ? range.end : 0), text.data(), text.size());
}

void seal_file(const SealLabel& label, const fs::path& path, const fs::path& shown) {
  const FileDescriptor file = open_file(path, O_RDWR);
  const bool is_last = label.kind.is_last;
  const std::size_t size = fs::file_size(path) + (is_last ? kSealBytes : 0);
  const SealedRange range = get_sealed_range(size, is_last);
  const std::optional<std::string> sha256 = hash_content(file, range);
  const bool can_write =
      sha256 && ::lseek(file.get(), static_cast<off_t>(is_last ? range.end : 0), SEEK_SET) >= 0;
  if (!can_write) throw file_failure(shown, "cannot be sealed", errno);
  const std::string text = render({label.kind.name, label.lines, size, *sha256});
  write_all(file.get(), std::as_bytes(std::span(text)), shown);
}

}  // namespace strut
