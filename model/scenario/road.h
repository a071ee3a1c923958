// The road: a speed bump or a row of equal ones, in the form in which it acts on each wheel.
//
// A tire does not follow the profile point by point. The default contact (kEnvelope) rolls a rigid
// disc of the free tire radius over the profile and averages the height of its center over the
// contact patch; the result has four continuous derivatives and costs the integrator no event.
// The expensive computation is in `make_surface`, once per tire and bump; a run evaluates quintic
// polynomials (`calc_road_point`). Numbers: docs/design/0003-road-contact.md.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "base/math/lanes.h"
#include "model/scenario/rough_track.h"

namespace strut {

enum class BumpShape { kNone, kArc, kHalfSine, kCosine, kTrapezoid, kTable };
enum class BumpSide { kBoth, kLeft, kRight };

/// One bump, or a row of equal bumps, on a flat road; x runs forward from the center of the first
/// bump, z up from the road.
struct RoadSpec {
  BumpShape shape = BumpShape::kArc;
  double height = 0.05;                  // m, [0, 0.5]; an arc at most length / 2
  double length = 0.4;                   // m, [0.001, 20]
  double ramp = 0.1;                     // m, length of each flank of a trapezoid, (0, length / 2]
  BumpSide side = BumpSide::kBoth;       // the wheels that cross it; evaluated by the caller
  int count = 1;                         // bumps in the row, [1, 20]
  double spacing = 2.0;                  // m from one bump's center to the next, (0, 200]
  std::vector<double> table_x, table_z;  // m, kTable: natural cubic spline, flat road outside
  bool operator==(const RoadSpec&) const = default;
  /// Whether height, length and ramp describe the bump.
  bool has_formula() const { return shape != BumpShape::kNone && shape != BumpShape::kTable; }
};

enum class ContactKind { kEnvelope, kPoint };

/// m, of a contact patch that averages the road.
inline constexpr double kShortestFootprint = 0.02;

/// The properties of the tire that determine its effective road.
struct ContactGeometry {
  ContactKind kind = ContactKind::kEnvelope;
  double radius = 0.0;     // m, free tire radius, [0.05, 2]
  double footprint = 0.0;  // m, averaging length, 0 or [0.02, 1]; 0: disc without averaging, kinks
};

/// Throws ModelError with field, value and allowed range.
void validate(const RoadSpec& spec);
void validate(const ContactGeometry& contact);

/// Height [m] of the bump's profile at x [m] from its center. Builds a table's spline in every
/// call: for plots and tests, not for simulations. Throws as `validate` does.
double calc_profile_height(const RoadSpec& spec, double x);

/// Quintic over one cell, sum of coefficient[k] t^k with t in [0, 1]; one cache line.
struct alignas(64) RoadCell {
  std::array<double, 8> coefficient{};
  bool operator==(const RoadCell&) const = default;
};
static_assert(sizeof(RoadCell) == 8 * sizeof(double));

/// Smooth stretch of road, divided into equal cells; whole numbers are stored as doubles for
/// `gather`.
struct alignas(64) RoadSegment {
  double end = 1e300;         // m from the bump's center; 1e300 after the last
  double origin = 0.0;        // m, start of the first cell
  double inverse_cell = 1.0;  // 1/m
  double first_cell = 0.0;    // index of its first cell in the list of all cells
  double last_cell = 0.0;     // number of cells - 1
  bool operator==(const RoadSegment&) const = default;
};
static_assert(sizeof(RoadSegment) == 8 * sizeof(double));

/// The effective road under one wheel: smooth segments, at whose ends slope or curvature jump. The
/// first and the last segment are flat, or the only segment starts and ends flat.
struct Surface {
  std::vector<RoadSegment> segments;
  std::vector<RoadCell> cells;
  double reach_begin = 1e300, reach_end = -1e300;  // m, outside of it height and slope are zero
  bool operator==(const Surface&) const = default;
};

/// Builds the effective road of a tire (a few milliseconds): the disc envelope
/// z_e(x) = max over s of z(x + s) + sqrt(R^2 - s^2) - R, then averaged with the cubic B-spline
/// kernel of total support `footprint` (four boxcars of a quarter of it); kPoint: the profile
/// itself. Throws ModelError for an invalid specification, and where more than 65 kinks would need
/// events.
Surface make_surface(const RoadSpec& spec, const ContactGeometry& contact);

/// The roads of the lanes: one surface per lane and the position of its bump.
template <class T>
struct Road {
  std::vector<RoadSegment> segments;  // those of all distinct surfaces, one after the other
  std::vector<RoadCell> cells;
  int segment_count = 0;     // maximum over the lanes; 0 or 1: no events
  T center = T(0.0);         // m, world x of the bump's center
  T reach_begin = T(1e300);  // m from the center
  T reach_end = T(-1e300);   // m from the center
  T first_segment = T(0.0);  // offset of the lane's first segment in `segments`, in doubles
  T last_segment = T(0.0);   // number of the lane's segments - 1
  T origin = T(0.0), inverse_cell = T(1.0), first_cell = T(0.0), last_cell = T(0.0);  // if only one
  std::array<RoughTracks<T>, 2> rough;                                                // left, right
  bool is_rough() const { return rough[0].is_rough || rough[1].is_rough; }
};

/// Two roads on both sides of another along a parameter, their bumps at the same place.
template <class T>
struct RoadNeighbors {
  Road<T> above, below;
  T inverse_distance;  // 1 over the parameter's unit
};

/// Along N directions; null where the road does not change.
template <class T, std::size_t N>
using RoadSlopes = std::array<std::unique_ptr<RoadNeighbors<T>>, N>;

template <class T>
struct RoadPoint {
  T height;  // m
  T slope;   // dz/dx
};

/// Appends `surface` to the lists unless they have an equal one; returns its first segment.
/// `surfaces` are those appended so far, `starts` their first segments.
std::size_t add_surface(const Surface& surface, std::vector<RoadSegment>& segments,
                        std::vector<RoadCell>& cells, std::vector<const Surface*>& surfaces,
                        std::vector<std::size_t>& starts);

/// Road of W lanes from W surfaces and W bump centers [m]; does not refer to the surfaces.
template <class T>
Road<T> make_road(const Surface* const surfaces[], const double centers[]) {
  Road<T> road;
  std::vector<const Surface*> added;
  std::vector<std::size_t> starts;
  for (int lane = 0; lane < kLaneCount<T>; ++lane) {
    const Surface& surface = *surfaces[lane];
    const std::size_t start = add_surface(surface, road.segments, road.cells, added, starts);
    const RoadSegment& first = road.segments[start];
    const int count = static_cast<int>(surface.segments.size());
    road.segment_count = count > road.segment_count ? count : road.segment_count;
    set_lane(road.center, lane, centers[lane]);
    set_lane(road.reach_begin, lane, surface.reach_begin);
    set_lane(road.reach_end, lane, surface.reach_end);
    set_lane(road.first_segment, lane, 8.0 * static_cast<double>(start));
    set_lane(road.last_segment, lane, static_cast<double>(count - 1));
    set_lane(road.origin, lane, first.origin);
    set_lane(road.inverse_cell, lane, first.inverse_cell);
    set_lane(road.first_cell, lane, first.first_cell);
    set_lane(road.last_cell, lane, first.last_cell);
  }
  return road;
}

/// Height and slope by cell floor((x - origin) * inverse_cell); the end cells extend to infinity.
template <class T>
RoadPoint<T> calc_cell_point(const std::vector<RoadCell>& cells, const T& x, const T& origin,
                             const T& inverse_cell, const T& first_cell, const T& last_cell) {
  const T place = (x - origin) * inverse_cell;
  // Comparisons instead of min and max: the NaN of a diverged lane must select cell 0, not an index
  // outside the table.
  T cell = floor(place);
  cell = select(cell > T(0.0), cell, T(0.0));
  cell = select(cell < last_cell, cell, last_cell);
  const T t = place - cell;
  const T at = T(8.0) * (first_cell + cell);
  const auto* table = reinterpret_cast<const double*>(cells.data());
  const T c0 = gather(table, at), c1 = gather(table + 1, at), c2 = gather(table + 2, at);
  const T c3 = gather(table + 3, at), c4 = gather(table + 4, at), c5 = gather(table + 5, at);
  const T height = c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5))));
  const T slope = c1 + t * (2.0 * c2 + t * (3.0 * c3 + t * (4.0 * c4 + t * (5.0 * c5))));
  return {height, inverse_cell * slope};
}

/// One entry of the segment of each lane; `field` points to that entry in the first segment.
template <class T>
T get_segment_field(const Road<T>& road, double RoadSegment::*field, const T& segment) {
  return gather(&(road.segments.data()->*field), road.first_segment + T(8.0) * segment);
}

/// Height [m] and slope of the road at world x [m]. `segment` is the polynomial to use, also beyond
/// its ends: a step that ends at a kink must not depend on the road behind it. Exactly zero, at the
/// cost of two comparisons, if no lane is at its bump.
template <class T>
RoadPoint<T> calc_road_point(const Road<T>& road, const T& x_world, const T& segment) {
  const T x = x_world - road.center;
  const auto in_reach = (x > road.reach_begin) & (x < road.reach_end);
  if (road.segment_count <= 1) {
    if (!any(in_reach)) return {T(0.0), T(0.0)};
    return calc_cell_point(road.cells, x, road.origin, road.inverse_cell, road.first_cell,
                           road.last_cell);
  }
  const auto on_bump = (segment > T(0.5)) & (segment < road.last_segment - T(0.5));
  if (!any(in_reach | on_bump)) return {T(0.0), T(0.0)};
  return calc_cell_point(road.cells, x, get_segment_field(road, &RoadSegment::origin, segment),
                         get_segment_field(road, &RoadSegment::inverse_cell, segment),
                         get_segment_field(road, &RoadSegment::first_cell, segment),
                         get_segment_field(road, &RoadSegment::last_cell, segment));
}

/// Number (whole, from 0) of the segment at world x [m]; a segment's end belongs to the next one.
template <class T>
T find_segment(const Road<T>& road, const T& x_world) {
  const T x = x_world - road.center;
  T segment(0.0);
  for (int i = 0; i + 1 < road.segment_count; ++i) {
    const T candidate = min(T(static_cast<double>(i)), road.last_segment);
    const T end = get_segment_field(road, &RoadSegment::end, candidate);
    segment += select(x >= end, T(1.0), T(0.0));
  }
  return segment;
}

/// World x [m] at which the segment ends, 1e300 after the last.
template <class T>
T calc_segment_end(const Road<T>& road, const T& segment) {
  if (road.segment_count <= 1) return T(1e300);
  return road.center + get_segment_field(road, &RoadSegment::end, segment);
}

}  // namespace strut
