// Who draws from which stream of a sweep's seed (base/math/random.h).
#pragma once

#include <cstddef>
#include <cstdint>

namespace strut {

enum class RandomStream : std::uint64_t {
  kDraw = 1,      // which cases of the grid
  kRunOrder = 2,  // in which order they run
  kCell = 3,      // Latin hypercube: the cell of a sample along an axis
  kPlace = 4,     // Latin hypercube: the place within its cell
  kShift = 5,     // Sobol: the digital shift of an axis
};

constexpr std::uint64_t get_stream(RandomStream stream, std::size_t axis = 0) {
  return static_cast<std::uint64_t>(stream) << 32 | axis;
}

}  // namespace strut
