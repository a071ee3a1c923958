// Chunks as HDF5's filters shuffle and deflate store them, made without the HDF5 library: its one
// lock covers its own compression, so threads that used it would wait for each other.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace strut {

/// Measured on shards of 512 cases: level 6 saves 4 % of the snapshots' bytes for 1.8 times the
/// time, 3 % of the histories' for 1.4 times.
inline constexpr int kDeflateLevel = 1;

/// Bytes of elements regrouped: all first bytes, all second bytes, ... so that equal exponents of
/// neighbors stand together. bytes.size() must be a multiple of `element_size`.
std::vector<std::byte> shuffle_bytes(std::span<const std::byte> bytes, std::size_t element_size);

/// Rows of a chunk of at most 1 MiB (or one row), such that all chunks are about as long.
std::size_t calc_chunk_rows(std::size_t rows, std::size_t row_bytes);

/// Shuffled, then deflated (zlib). Thread-safe.
std::vector<std::byte> compress_chunk(std::span<const std::byte> bytes, std::size_t element_size);

}  // namespace strut
