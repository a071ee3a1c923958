// Rough tracks: lines through the heights (a spline would overshoot beside the edges of a hole),
// disc envelope on a fine grid, average over the footprint, interpolation by cubic B-splines.
#include "model/scenario/road_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "model/scenario/road_fault.h"

namespace strut {
namespace {

/// A disc of 0.3 m touches the road at most half a step from a point of the grid and is then
/// (1 mm)^2 / (2 x 0.3 m) = 1.7 um too low.
constexpr double kFineStep = 2e-3;  // m

/// Equally spaced numbers; zero outside.
struct Samples {
  double begin = 0.0, spacing = 1.0;  // m
  std::vector<double> values;         // m
  double get_or_zero(std::ptrdiff_t i) const {
    return i < 0 || i >= std::ssize(values) ? 0.0 : values[static_cast<std::size_t>(i)];
  }
};

/// Coefficients c of the cubic B-splines whose sum is values[i] at the knots, (c[i-1] + 4 c[i] +
/// c[i+1]) / 6, with c = 0 outside (Thomas algorithm).
std::vector<double> interpolate_splines(const std::vector<double>& values) {
  const std::size_t n = values.size();
  std::vector<double> c(n), ratio(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double pivot = 4.0 - (i > 0 ? ratio[i - 1] : 0.0);
    ratio[i] = 1.0 / pivot;
    c[i] = (6.0 * values[i] - (i > 0 ? c[i - 1] : 0.0)) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 0;) c[i] -= ratio[i] * c[i + 1];
  return c;
}

/// A track whose B-spline of coefficient i peaks at sample i.
RoughTrack make_track(const Samples& samples, std::vector<double> coefficients,
                      double bump_distance) {
  return {samples.begin - 2.0 * samples.spacing - bump_distance, samples.spacing,
          std::move(coefficients)};
}

/// Lines between the samples, which they keep, at about `spacing`.
Samples refine(const Samples& road, double spacing) {
  const double parts = std::max(1.0, std::round(road.spacing / spacing));
  Samples fine{road.begin, road.spacing / parts, {}};
  for (std::size_t i = 0; i + 1 < road.values.size(); ++i) {
    for (double part = 0.0; part < parts; ++part) {
      fine.values.push_back(std::lerp(road.values[i], road.values[i + 1], part / parts));
    }
  }
  fine.values.push_back(road.values.back());
  return fine;
}

double find_steepest(const Samples& road) {
  double steepest = 0.0;
  for (std::ptrdiff_t i = 0; i <= std::ssize(road.values); ++i) {
    steepest = std::max(steepest, std::fabs(road.get_or_zero(i) - road.get_or_zero(i - 1)));
  }
  return steepest / road.spacing;
}

/// Height of the center of a disc over the road, less its radius, on the same grid and one radius
/// before and behind it. A contact s beside the center gains at most s times the steepest slope and
/// loses at least s^2 / (2 R).
Samples roll_disc(const Samples& road, double radius) {
  const double reach = std::min(0.999 * radius, 2.0 * radius * find_steepest(road));
  const auto width = static_cast<std::ptrdiff_t>(reach / road.spacing);
  std::vector<double> drop;  // of the disc's rim above its lowest point
  for (std::ptrdiff_t j = 0; j <= width; ++j) {
    const double s = road.spacing * static_cast<double>(j);
    drop.push_back(s * s / (radius + std::sqrt(radius * radius - s * s)));
  }
  Samples disc{road.begin - road.spacing * static_cast<double>(width), road.spacing, {}};
  for (std::ptrdiff_t i = -width; i < std::ssize(road.values) + width; ++i) {
    double height = road.get_or_zero(i);
    for (std::ptrdiff_t j = 1; j <= width; ++j) {
      const double higher = std::max(road.get_or_zero(i - j), road.get_or_zero(i + j));
      height = std::max(height, higher - drop[static_cast<std::size_t>(j)]);
    }
    disc.values.push_back(height);
  }
  return disc;
}

/// Cubic B-spline with support [-2, 2] and integral 1.
double calc_kernel(double x) {
  const double u = std::fabs(x);
  if (u >= 2.0) return 0.0;
  if (u >= 1.0) return (2.0 - u) * (2.0 - u) * (2.0 - u) / 6.0;
  return 2.0 / 3.0 - u * u + 0.5 * u * u * u;
}

/// Average with the kernel of total support `footprint`, at every eighth of it. The weights of the
/// grid's points are normalized, so that a level road stays level.
Samples average(const Samples& road, double footprint) {
  const double quarter = 0.25 * footprint, spacing = 0.5 * quarter;
  Samples out{road.begin - 0.5 * footprint, spacing, {}};
  const double end = road.begin + road.spacing * static_cast<double>(road.values.size() - 1);
  for (double x = out.begin; x < end + 0.5 * footprint + spacing; x += spacing) {
    const double middle = (x - road.begin) / road.spacing;
    const double half = 0.5 * footprint / road.spacing;
    double sum = 0.0, weights = 0.0;
    for (auto i = static_cast<std::ptrdiff_t>(std::ceil(middle - half));
         static_cast<double>(i) <= middle + half; ++i) {
      const double weight = calc_kernel((static_cast<double>(i) - middle) * road.spacing / quarter);
      sum += weight * road.get_or_zero(i);
      weights += weight;
    }
    out.values.push_back(sum / weights);
  }
  return out;
}

RoughTrack follow_track(const Samples& road, const ContactGeometry& contact, double bump_distance) {
  // The heights themselves as coefficients round off what is shorter than two of them.
  if (contact.kind == ContactKind::kPoint) {
    const Samples fine = refine(road, 0.25 * road.spacing);
    return make_track(fine, fine.values, bump_distance);
  }
  const Samples disc = roll_disc(refine(road, kFineStep), contact.radius);
  if (!(contact.footprint > 0.0)) return make_track(disc, disc.values, bump_distance);
  const Samples smooth = average(disc, contact.footprint);
  return make_track(smooth, interpolate_splines(smooth.values), bump_distance);
}

}  // namespace

void validate(const RoadProfile& profile) {
  const std::vector<double>& left = profile.height[0];
  require_road(profile.begin >= 0.0 && profile.begin <= kMaxRoadBegin, "road.begin", profile.begin,
               "must lie in [0, 10000] m: the car starts on level road");
  require_road(profile.spacing > 0.0 && profile.spacing <= 0.5, "road.spacing", profile.spacing,
               "must lie in (0, 0.5] m");
  require_road(left.size() >= 3 && left.size() <= kMaxRoadPoints, "road, number of heights",
               static_cast<double>(left.size()),
               fmt::format("must lie in [3, {}]", kMaxRoadPoints));
  require_road(profile.height[1].size() == left.size(), "road, number of heights on the right",
               static_cast<double>(profile.height[1].size()), "must be the number on the left");
  for (const std::vector<double>& track : profile.height) {
    for (const double height : track) {
      require_road(std::fabs(height) <= kMaxRoadHeight, "road, height", height,
                   fmt::format("must lie in [{:g}, {:g}] m", -kMaxRoadHeight, kMaxRoadHeight));
    }
  }
}

void fade_ends(RoadProfile& profile, double length) {
  for (std::vector<double>& track : profile.height) {
    const double points = length / profile.spacing;
    const std::size_t n = track.size();
    for (std::size_t i = 0; i < n; ++i) {
      const auto from_end = static_cast<double>(std::min(i, n - 1 - i));
      if (from_end >= points) continue;
      track[i] *= 0.5 - 0.5 * std::cos(std::numbers::pi * from_end / points);
    }
  }
}

std::array<RoughTrack, 2> follow_profile(const RoadProfile& profile, const ContactGeometry& contact,
                                         double bump_distance) {
  validate(profile);
  validate(contact);
  std::array<RoughTrack, 2> tracks;
  for (std::size_t side = 0; side < 2; ++side) {
    if (side == 1 && profile.height[1] == profile.height[0]) {
      tracks[1] = tracks[0];
      continue;
    }
    tracks[side] = follow_track({profile.begin, profile.spacing, profile.height[side]}, contact,
                                bump_distance);
  }
  return tracks;
}

}  // namespace strut
