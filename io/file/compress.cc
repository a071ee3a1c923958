#include "io/file/compress.h"

#include <zlib.h>

#include <algorithm>

#include "base/error/input_error.h"

namespace strut {

std::vector<std::byte> shuffle_bytes(std::span<const std::byte> bytes, std::size_t element_size) {
  const std::size_t count = bytes.size() / element_size;
  std::vector<std::byte> shuffled(bytes.size());
  for (std::size_t b = 0; b < element_size; ++b) {
    std::byte* const plane = shuffled.data() + b * count;
    for (std::size_t i = 0; i < count; ++i) plane[i] = bytes[i * element_size + b];
  }
  return shuffled;
}

std::size_t calc_chunk_rows(std::size_t rows, std::size_t row_bytes) {
  constexpr std::size_t kMaxChunkBytes = std::size_t{1} << 20;
  const std::size_t max_rows = std::max<std::size_t>(kMaxChunkBytes / row_bytes, 1);
  const std::size_t chunks = std::max<std::size_t>((rows + max_rows - 1) / max_rows, 1);
  return std::max<std::size_t>((rows + chunks - 1) / chunks, 1);
}

std::vector<std::byte> compress_chunk(std::span<const std::byte> bytes, std::size_t element_size) {
  const std::vector<std::byte> shuffled = shuffle_bytes(bytes, element_size);
  uLongf size = ::compressBound(static_cast<uLong>(shuffled.size()));
  std::vector<std::byte> deflated(size);
  const int status = ::compress2(reinterpret_cast<Bytef*>(deflated.data()), &size,
                                 reinterpret_cast<const Bytef*>(shuffled.data()),
                                 static_cast<uLong>(shuffled.size()), kDeflateLevel);
  if (status != Z_OK) throw EnvironmentError("zlib: out of memory");
  deflated.resize(size);
  return deflated;
}

}  // namespace strut
