// The corners and axles of a car: their order and their names.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace strut {

/// Corners in the order of every array and channel.
enum Corner : int { kFrontLeft = 0, kFrontRight = 1, kRearLeft = 2, kRearRight = 3 };
inline constexpr int kCorners = 4;
enum Axle : int { kFront = 0, kRear = 1 };
inline constexpr int kAxles = 2;
constexpr int axle_of(int corner) { return corner / 2; }
constexpr bool is_right(int corner) { return corner % 2 == 1; }

/// Names in Corner order, the prefixes of channels and parameters of a corner.
inline constexpr std::array<const char*, kCorners> kCornerNames = {"front_left", "front_right",
                                                                   "rear_left", "rear_right"};
/// Names in Axle order, the prefixes of parameters of an axle.
inline constexpr std::array<const char*, kAxles> kAxleNames = {"front", "rear"};

/// The corner of this name; -1 where `name` is not a corner.
constexpr int find_corner(std::string_view name) {
  for (int corner = 0; corner < kCorners; ++corner) {
    if (name == kCornerNames[static_cast<std::size_t>(corner)]) return corner;
  }
  return -1;
}

}  // namespace strut
