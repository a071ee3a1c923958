#include "io/table/mat_structure.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/error/input_error.h"
#include "io/file/file_bytes.h"

namespace strut {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::size_t kHeader = 128, kEndianMark = 126, kTag = 8;
/// Deflate packs at most 1032 to 1.
constexpr std::size_t kMaxPacking = 1040;
constexpr int kMaxDepth = 32;

enum Type : std::uint32_t { kMatrix = 14, kCompressed = 15 };
enum Class : std::uint32_t { kCell = 1, kSparse = 5, kUint64 = 15 };

struct Element {
  std::uint32_t type = 0;
  Bytes body;
  std::size_t length = 0;  // with tag and padding
};

class Checker {
 public:
  Checker(const std::filesystem::path& path, bool is_little) : path_(path), is_little_(is_little) {}

  MatStructure check_file(Bytes rest) const {
    MatStructure structure;
    while (rest.size() >= kTag) {
      const std::uint32_t type = read_word(rest, 0);
      const std::size_t size = read_word(rest, 4);
      if (type != kMatrix && type != kCompressed) {
        throw refuse(fmt::format("an element of type {} is no variable", type));
      }
      rest = rest.subspan(kTag);
      if (size > rest.size()) break;
      if (type == kMatrix) {
        check_matrix(rest.first(size), 0);
      } else {
        check_compressed(rest.first(size));
      }
      rest = rest.subspan(size);
      ++structure.whole_count;
      if (rest.empty()) return structure;
    }
    structure.is_cut_off = true;
    return structure;
  }

 private:
  InputError refuse(const std::string& what) const {
    return InputError(fmt::format("{}: damaged: {}", path_.string(), what));
  }

  std::uint32_t read_word(Bytes bytes, std::size_t at) const {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      word = word << 8U | std::to_integer<std::uint32_t>(bytes[at + (is_little_ ? 3 - i : i)]);
    }
    return word;
  }

  /// The first element of `bytes`. Up to four bytes may stand in the tag itself.
  Element take_element(Bytes bytes) const {
    if (bytes.size() < kTag) throw refuse("an element is cut off");
    const std::uint32_t first = read_word(bytes, 0);
    if (first >> 16U != 0) {
      const std::size_t size = first >> 16U;
      if (size > 4) throw refuse("a small element has more than four bytes");
      return {first & 0xffffU, bytes.subspan(4, size), kTag};
    }
    const std::size_t size = read_word(bytes, 4);
    if (size > bytes.size() - kTag) {
      throw refuse(fmt::format("an element of {} bytes within {}", size, bytes.size() - kTag));
    }
    return {first, bytes.subspan(kTag, size), std::min(kTag + (size + 7) / 8 * 8, bytes.size())};
  }

  void check_matrix(Bytes body, int depth) const {
    if (depth > kMaxDepth) throw refuse("arrays are nested too deeply");
    if (body.empty()) return;  // an empty cell
    const Element flags = take_element(body);
    if (flags.body.size() < 4) throw refuse("an array without flags");
    const std::uint32_t array_class = read_word(flags.body, 0) & 0xffU;
    const bool has_dimensions = array_class >= kCell && array_class <= kUint64;
    Bytes rest = body.subspan(flags.length);
    for (int i = 0; !rest.empty(); ++i) {
      const Element element = take_element(rest);
      if (i == 0 && has_dimensions) check_dimensions(element.body, array_class, body.size());
      if (element.type == kMatrix) check_matrix(element.body, depth + 1);
      rest = rest.subspan(element.length);
    }
  }

  /// Each value has a byte or more; sparse arrays store some of theirs.
  void check_dimensions(Bytes dimensions, std::uint32_t array_class, std::size_t bytes) const {
    constexpr std::size_t kMaxRank = 32;
    if (dimensions.size() < 8 || dimensions.size() > 4 * kMaxRank) {
      throw refuse("an array with too few or too many dimensions");
    }
    double count = 1.0;
    for (std::size_t at = 0; at + 4 <= dimensions.size(); at += 4) {
      const std::uint32_t dimension = read_word(dimensions, at);
      if (dimension > INT32_MAX) throw refuse("an array with a negative dimension");
      count *= dimension;
    }
    if (array_class != kSparse && count > static_cast<double>(bytes)) {
      throw refuse(fmt::format("an array of {:g} values within {} bytes", count, bytes));
    }
  }

  void check_compressed(Bytes packed) const {
    const std::vector<std::byte> tag = inflate(packed, kTag);
    if (tag.size() < kTag) throw refuse("a compressed element cannot be read");
    const std::size_t size = read_word(tag, 4);
    if (read_word(tag, 0) != kMatrix) throw refuse("a compressed element is no array");
    if (size / kMaxPacking > packed.size()) {
      throw refuse(fmt::format("{} bytes packed into {}", size, packed.size()));
    }
    const std::vector<std::byte> whole = inflate(packed, kTag + size);
    if (whole.size() < kTag + size) throw refuse("a compressed element cannot be read");
    check_matrix(Bytes(whole).subspan(kTag), 0);
  }

  /// The first `count` bytes, or fewer where there are no more or they are damaged.
  static std::vector<std::byte> inflate(Bytes packed, std::size_t count) {
    std::vector<std::byte> bytes(count);
    z_stream stream{};
    if (::inflateInit(&stream) != Z_OK) throw EnvironmentError("zlib: out of memory");
    // zlib's input is not const, and not changed.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_out = static_cast<uInt>(count);
    ::inflate(&stream, Z_SYNC_FLUSH);
    bytes.resize(count - stream.avail_out);
    ::inflateEnd(&stream);
    return bytes;
  }

  const std::filesystem::path& path_;
  bool is_little_;
};

}  // namespace

MatStructure check_mat_structure(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  if (bytes.size() < kHeader) throw InputError(path.string() + ": damaged: no whole header");
  const bool is_little = bytes[kEndianMark] == std::byte{'I'};
  return Checker(path, is_little).check_file(Bytes(bytes).subspan(kHeader));
}

}  // namespace strut
