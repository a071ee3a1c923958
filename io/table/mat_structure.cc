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
constexpr std::size_t kMaxInflated = std::size_t{1} << 31U;
constexpr int kMaxDepth = 32;

enum Type : std::uint32_t { kInt8 = 1, kInt32 = 5, kUint32 = 6, kMatrix = 14, kCompressed = 15 };
enum Class : std::uint32_t { kCell = 1, kStruct = 2, kObject = 3, kSparse = 5, kUint64 = 15 };

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
        if (structure.whole_count > 0) break;
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

  /// Takes the first element off `rest`, which must be of this type.
  Bytes take(Bytes& rest, std::uint32_t type, const char* what) const {
    const Element element = take_element(rest);
    if (element.type != type) throw refuse(fmt::format("an array without {}", what));
    rest = rest.subspan(element.length);
    return element.body;
  }

  void check_matrix(Bytes body, int depth) const {
    if (depth > kMaxDepth) throw refuse("arrays are nested too deeply");
    if (body.empty() && depth > 0) return;  // an empty cell
    Bytes rest = body;
    const Bytes flags = take(rest, kUint32, "flags");
    if (flags.size() != 8) throw refuse("an array without flags");
    const std::uint32_t array_class = read_word(flags, 0) & 0xffU;
    if (array_class >= kCell && array_class <= kUint64) check_head(rest, array_class, body.size());
    while (!rest.empty()) {
      const Element element = take_element(rest);
      if (element.type == kMatrix) check_matrix(element.body, depth + 1);
      rest = rest.subspan(element.length);
    }
  }

  /// Dimensions and name; of structs the names of fields, too. Each value has a byte or more, each
  /// cell and each field of each struct a tag; sparse arrays store some of their values.
  void check_head(Bytes& rest, std::uint32_t array_class, std::size_t bytes) const {
    double least = count_values(take(rest, kInt32, "dimensions"));
    take(rest, kInt8, "a name");
    if (array_class == kObject) take(rest, kInt8, "a class");
    if (array_class == kStruct || array_class == kObject) {
      const Bytes length = take(rest, kInt32, "a length of field names");
      const Bytes names = take(rest, kInt8, "field names");
      const std::size_t each = length.size() == 4 ? read_word(length, 0) : 0;
      if (each == 0) throw refuse("fields without a length of their names");
      const std::size_t fields = names.size() / each;
      least *= static_cast<double>(kTag * fields);
    }
    if (array_class == kCell) least *= static_cast<double>(kTag);
    if (array_class != kSparse && least > static_cast<double>(bytes)) {
      throw refuse(fmt::format("an array of at least {:g} bytes within {}", least, bytes));
    }
  }

  double count_values(Bytes dimensions) const {
    constexpr std::size_t kMaxRank = 32;
    if (dimensions.size() < 8 || dimensions.size() > 4 * kMaxRank || dimensions.size() % 4 != 0) {
      throw refuse("an array with too few or too many dimensions");
    }
    double count = 1.0;
    for (std::size_t at = 0; at + 4 <= dimensions.size(); at += 4) {
      const std::uint32_t dimension = read_word(dimensions, at);
      if (dimension > INT32_MAX) throw refuse("an array with a negative dimension");
      count *= dimension;
    }
    return count;
  }

  void check_compressed(Bytes packed) const {
    const std::vector<std::byte> tag = inflate(packed, kTag);
    if (tag.size() < kTag) throw refuse("a compressed element cannot be read");
    const std::size_t size = read_word(tag, 4);
    if (read_word(tag, 0) != kMatrix) throw refuse("a compressed element is no array");
    if (size / kMaxPacking > packed.size() || size > kMaxInflated) {
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
