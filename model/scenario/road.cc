// Steps from a bump to a surface: profile -> envelope (contact height of the tire) -> average over
// the contact patch -> cells. This file validates roads and assembles the surface from its
// segments.
#include "model/scenario/road.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "model/scenario/envelope.h"
#include "model/scenario/footprint.h"
#include "model/scenario/profile.h"
#include "model/scenario/road_cells.h"
#include "model/scenario/road_fault.h"

namespace strut {
namespace {

// --- validation -----------------------------------------------------------------------------

void validate_table_point(const RoadSpec& spec, std::size_t i) {
  const double x = spec.table_x[i], z = spec.table_z[i];
  const bool ahead = i == 0 || x - spec.table_x[i - 1] >= 1e-4;
  if (std::fabs(x) <= 20.0 && std::fabs(z) <= 0.5 && ahead) return;
  require_road_range(fmt::format("road.table_x[{}]", i), x, -20.0, 20.0);
  require_road_range(fmt::format("road.table_z[{}]", i), z, -0.5, 0.5);
  require_road(ahead, fmt::format("road.table_x[{}]", i), x,
               "must exceed the previous point by at least 0.0001 m");
}

void validate_table(const RoadSpec& spec) {
  const std::vector<double>&x = spec.table_x, &z = spec.table_z;
  require_road(x.size() >= 3, "road.table_x, number of points", static_cast<double>(x.size()),
               "a profile must have at least 3");
  require_road(z.size() == x.size(), "road.table_z, number of points",
               static_cast<double>(z.size()),
               fmt::format("must equal the {} of road.table_x", x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) validate_table_point(spec, i);
  require_road(std::fabs(z.front()) <= 1e-6, "road.table_z[0]", z.front(),
               "a profile must start on the flat road, within 1e-6 m of 0");
  require_road(std::fabs(z.back()) <= 1e-6, "road.table_z, last", z.back(),
               "a profile must end on the flat road, within 1e-6 m of 0");
}

// --- segments of a surface ------------------------------------------------------------------

/// Appends a segment with its cells to the surface.
void add_segment(const std::vector<RoadCell>& cells, double begin, double cell_length, double end,
                 Surface& surface) {
  RoadSegment segment;
  segment.end = end;
  segment.origin = begin;
  segment.inverse_cell = 1.0 / cell_length;
  segment.first_cell = static_cast<double>(surface.cells.size());
  segment.last_cell = static_cast<double>(cells.size() - 1);
  surface.segments.push_back(segment);
  surface.cells.insert(surface.cells.end(), cells.begin(), cells.end());
}

bool is_smooth_joint(const Branch& before, const Branch& after) {
  const Jet a = before.calc(before.end), b = after.calc(before.end);
  return std::fabs(a.slope - b.slope) < 1e-7 &&
         std::fabs(a.curvature - b.curvature) < 1e-5 * (1.0 + std::fabs(a.curvature));
}

/// Adds one segment for the branches first .. last, which join smoothly.
void add_kinked_segment(const std::vector<Branch>& branches, std::size_t first, std::size_t last,
                        Surface& surface) {
  const double begin = branches[first].begin, end = branches[last].end;
  const std::size_t count = last - first + 1;
  bool even = true;  // cells that end at the joints of equally long branches are exact for a spline
  for (std::size_t i = first; i <= last; ++i) {
    const double scaled = (branches[i].end - branches[i].begin) * static_cast<double>(count);
    even = even && std::fabs(scaled / (end - begin) - 1.0) < 1e-9;
  }
  const auto f = [&](double x) {
    std::size_t i = first;
    while (i < last && x > branches[i].end) ++i;
    return branches[i].calc(x);
  };
  const std::vector<RoadCell> cells =
      tabulate_cells(f, begin, end, even ? count : 1, {1e-12, 1e-9});
  add_segment(cells, begin, (end - begin) / static_cast<double>(cells.size()), end, surface);
}

void require_few_segments(const Surface& surface) {
  require_road(
      surface.segments.size() <= 66, "road, number of kinks",
      static_cast<double>(surface.segments.size() - 1),
      "at most 65 events per crossing; set a footprint above 0, which needs none, or fewer bumps");
}

Surface make_kinked_surface(const std::vector<Branch>& branches) {
  Surface surface;
  surface.reach_begin = branches.front().begin;
  surface.reach_end = branches.back().end;
  add_segment({RoadCell{}}, surface.reach_begin - 1.0, 1.0, surface.reach_begin, surface);
  for (std::size_t first = 0, last = 0; first < branches.size(); first = ++last) {
    while (last + 1 < branches.size() && is_smooth_joint(branches[last], branches[last + 1])) {
      ++last;
    }
    add_kinked_segment(branches, first, last, surface);
  }
  add_segment({RoadCell{}}, surface.reach_end, 1.0, 1e300, surface);
  require_few_segments(surface);
  return surface;
}

/// Surface of one smooth segment; a zero cell at each end represents the flat road.
Surface make_smooth_surface(const std::vector<Branch>& branches, double footprint) {
  const Patchwork patches = make_patchwork(branches);
  const double a = 0.25 * footprint;
  const double begin = branches.front().begin - 2.0 * a, end = branches.back().end + 2.0 * a;
  const auto f = [&](double x) {
    return x <= begin || x >= end ? Jet{} : calc_average(patches, a, x);
  };
  const auto count = static_cast<std::size_t>(std::ceil(8.0 * (end - begin) / a));
  std::vector<RoadCell> cells = tabulate_cells(f, begin, end, count, {1e-11, 5e-9});
  const double length = (end - begin) / static_cast<double>(cells.size());
  cells.insert(cells.begin(), RoadCell{});
  cells.push_back(RoadCell{});
  Surface surface;
  surface.reach_begin = begin;
  surface.reach_end = end;
  add_segment(cells, begin - length, length, 1e300, surface);
  return surface;
}

/// The surface of one bump again and again; all have the same cells.
Surface repeat_surface(const Surface& one, const RoadSpec& spec) {
  const double reach = one.reach_end - one.reach_begin;
  require_road(
      spec.spacing >= reach, "road.spacing", spec.spacing,
      fmt::format("the tire touches one bump over {:.3f} m, and the next must begin behind it; "
                  "give closer bumps as a table",
                  reach));
  Surface row;
  row.cells = one.cells;
  row.reach_begin = one.reach_begin;
  RoadSegment flat = one.segments.front();
  flat.last_cell = 0.0;  // level before the bump, kinked or smooth
  for (int i = 0; i < spec.count; ++i) {
    const double shift = i * spec.spacing;
    flat.end = one.reach_begin + shift;
    row.segments.push_back(flat);
    for (RoadSegment segment : one.segments) {
      if (segment.end <= one.reach_begin || segment.origin >= one.reach_end) continue;
      segment.origin += shift;
      segment.end = std::min(segment.end, one.reach_end) + shift;
      row.segments.push_back(segment);
      row.reach_end = segment.end;
    }
  }
  flat.end = 1e300;
  row.segments.push_back(flat);
  require_few_segments(row);
  return row;
}

Surface make_flat_surface() {
  Surface surface;
  add_segment({RoadCell{}}, 0.0, 1.0, 1e300, surface);
  return surface;
}

}  // namespace

void validate(const RoadSpec& spec) {
  if (spec.shape == BumpShape::kNone) return;
  require_road(spec.count >= 1 && spec.count <= 20, "road.count", spec.count,
               "must lie in [1, 20]");
  if (spec.count > 1) require_road_range("road.spacing", spec.spacing, 0.01, 200.0);
  if (spec.shape == BumpShape::kTable) return validate_table(spec);
  require_road_range("road.length", spec.length, 0.001, 20.0);
  require_road_range("road.height", spec.height, 0.0, 0.5);
  if (spec.shape == BumpShape::kArc) {
    require_road(spec.height <= 0.5 * spec.length, "road.height", spec.height,
                 fmt::format("the height of an arc must be at most half its length, {:f} m",
                             0.5 * spec.length));
  }
  if (spec.shape == BumpShape::kTrapezoid) {
    require_road_range("road.ramp", spec.ramp, 1e-4, 0.5 * spec.length);
  }
}

void validate(const ContactGeometry& contact) {
  if (contact.kind == ContactKind::kPoint) return;
  require_road_range("tire.radius", contact.radius, 0.05, 2.0);
  if (contact.footprint == 0.0) return;
  require_road_range("tire.footprint", contact.footprint, kShortestFootprint, 1.0);
}

double calc_profile_height(const RoadSpec& spec, double x) {
  validate(spec);
  const Profile profile = make_profile(spec);
  const std::vector<double>& ends = profile.ends;
  if (spec.count > 1 && !ends.empty()) {
    const double bumps_before = std::floor((x - ends.front()) / spec.spacing);
    x -= spec.spacing * std::clamp(bumps_before, 0.0, spec.count - 1.0);
  }
  if (ends.empty() || x <= ends.front() || x >= ends.back()) return 0.0;
  const auto above = std::upper_bound(ends.begin(), ends.end(), x);
  return profile.calc(static_cast<std::size_t>(above - ends.begin()) - 1, x).value;
}

namespace {

/// The surface of the first bump.
Surface make_one_surface(const RoadSpec& spec, const ContactGeometry& contact) {
  const Profile profile = make_profile(spec);
  if (profile.ends.empty()) return make_flat_surface();
  if (contact.kind == ContactKind::kPoint) {
    const bool upright = spec.shape == BumpShape::kArc && spec.height > 0.45 * spec.length;
    require_road(!upright, "road.height", spec.height,
                 "with point contact the height of an arc must be at most 0.45 times its length");
    return make_kinked_surface(make_point_branches(profile));
  }
  const std::vector<Branch> branches = make_disc_envelope(profile, contact.radius);
  if (branches.empty()) return make_flat_surface();
  return contact.footprint > 0.0 ? make_smooth_surface(branches, contact.footprint)
                                 : make_kinked_surface(branches);
}

}  // namespace

Surface make_surface(const RoadSpec& spec, const ContactGeometry& contact) {
  validate(spec);
  validate(contact);
  const Surface one = make_one_surface(spec, contact);
  return spec.count > 1 && one.reach_end > one.reach_begin ? repeat_surface(one, spec) : one;
}

std::size_t add_surface(const Surface& surface, std::vector<RoadSegment>& segments,
                        std::vector<RoadCell>& cells, std::vector<const Surface*>& surfaces,
                        std::vector<std::size_t>& starts) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i] == &surface || *surfaces[i] == surface) return starts[i];
  }
  const std::size_t start = segments.size();
  const auto shift = static_cast<double>(cells.size());
  for (RoadSegment segment : surface.segments) {
    segment.first_cell += shift;
    segments.push_back(segment);
  }
  cells.insert(cells.end(), surface.cells.begin(), surface.cells.end());
  surfaces.push_back(&surface);
  starts.push_back(start);
  return start;
}

}  // namespace strut
