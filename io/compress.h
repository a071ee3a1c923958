// Chunks as HDF5's filters shuffle and deflate store them, made without the HDF5 library: its one
// lock covers its own compression, so threads that used it would wait for each other.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace strut {

/// By measurement, see docs/design: higher levels cost more time than they save bytes.
inline constexpr int kDeflateLevel = 1;

/// Bytes of elements regrouped: all first bytes, all second bytes, ... so that equal exponents of
/// neighbors stand together. bytes.size() must be a multiple of `element_size`.
std::vector<std::byte> shuffle_bytes(std::span<const std::byte> bytes, std::size_t element_size);

/// Shuffled, then deflated (zlib). Thread-safe.
std::vector<std::byte> compress_chunk(std::span<const std::byte> bytes, std::size_t element_size);

}  // namespace strut
