#include "base/math/grid.h"

#include <fmt/format.h>

#include <limits>

#include "base/error/input_error.h"

namespace strut {

Grid::Grid(std::vector<Axis> axes) : axes_(std::move(axes)), size_(1) {
  constexpr std::int64_t kMaxSize = std::numeric_limits<std::int64_t>::max();
  for (const Axis& axis : axes_) {
    if (axis.count > kMaxSize / size_) {
      throw InputError(fmt::format(
          "the grid has more than {} points, the maximum; use fewer axes or larger steps",
          kMaxSize));
    }
    size_ *= axis.count;
  }
}

void Grid::calc_levels(std::int64_t id, std::span<std::int64_t> levels) const {
  for (std::size_t a = axes_.size(); a-- > 0;) {
    levels[a] = id % axes_[a].count;
    id /= axes_[a].count;
  }
}

std::int64_t Grid::calc_id(std::span<const std::int64_t> levels) const {
  std::int64_t id = 0;
  for (std::size_t a = 0; a < axes_.size(); ++a) id = id * axes_[a].count + levels[a];
  return id;
}

}  // namespace strut
