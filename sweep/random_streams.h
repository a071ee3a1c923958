// Streams of a sweep's seed, one per use (base/math/random.h).
#pragma once

#include <cstddef>
#include <cstdint>

namespace strut {

enum class RandomStream : std::uint64_t {
  kDraw = 1,      // cases drawn from the grid
  kRunOrder = 2,  // order in which cases run
  kCell = 3,      // Latin hypercube: cell of a sample along an axis
  kOffset = 4,    // Latin hypercube: offset within the cell
  kShift = 5,     // Sobol: digital shift of an axis
};

constexpr std::uint64_t get_stream(RandomStream stream, std::size_t axis = 0) {
  return static_cast<std::uint64_t>(stream) << 32 | axis;
}

}  // namespace strut
