// Compresses chunks into the format of HDF5's shuffle and deflate filters without calling the HDF5
// library, whose global lock covers compression and would serialize the threads.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace strut {

/// zlib level. Measured on shards of 512 cases: level 6 saves 4 % of the bytes of snapshots at 1.8
/// times the time, and 3 % of those of histories at 1.4 times.
inline constexpr int kDeflateLevel = 1;

/// Regroups the bytes of elements: all first bytes, all second bytes, ..., so that the similar
/// exponents of neighbors become adjacent. bytes.size() must be a multiple of `element_size`.
std::vector<std::byte> shuffle_bytes(std::span<const std::byte> bytes, std::size_t element_size);

/// Returns the rows per chunk, at most 1 MiB (or one row), such that all chunks are about equally
/// long.
std::size_t calc_chunk_rows(std::size_t rows, std::size_t row_bytes);

/// Shuffles, then deflates (zlib). Thread-safe. Throws EnvironmentError if memory runs out.
std::vector<std::byte> compress_chunk(std::span<const std::byte> bytes, std::size_t element_size);

}  // namespace strut
