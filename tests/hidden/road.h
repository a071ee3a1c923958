// The generator's own road: a bump under a rolling disc, and ISO 8608 roughness in two tracks.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace strut::hidden {

/// Curve through equally spaced heights, cubic between them, level outside.
struct Curve {
  double begin = 0.0, spacing = 1.0;
  std::vector<double> height, slope;

  /// Height [m] and its derivative at x [m].
  void evaluate(double x, double& z, double& z_x) const;
};

/// Slopes by the differences of fourth order.
Curve make_curve(double begin, double spacing, std::vector<double> height);

enum class BumpForm { kArc, kCosine, kTrapezoid, kParabola, kHalfSine, kTruncated };

struct Bump {
  BumpForm form = BumpForm::kCosine;
  double height = 0.08;  // m
  double length = 0.9;   // m
  double ramp = 0.0;     // m, each flank of the trapezoid; kTruncated: flat middle third
};

/// Height of the profile x [m] from the bump's center.
double calc_bump_height(const Bump& bump, double x);

/// The bump as a tire follows it: the height of a rolling disc of this radius over it, averaged
/// over the footprint by four boxcars of a quarter of it. Brute force on a grid of 0.5 mm.
Curve make_felt_bump(const Bump& bump, double radius, double footprint);

/// The bump itself.
Curve make_bare_bump(const Bump& bump);

/// A curve under two cams, a half of `spread` [m] before and behind the center: the mean of both.
Curve spread_cams(const Curve& curve, double spread);

/// ISO 8608: G(n) = G(n0) (n / n0)^-2 [m^3], n0 = 0.1 cycles/m, and the coherence exp(-n / n_c) of
/// left and right; longer waves than 1 / lowest and shorter than 1 / highest are absent.
struct Roughness {
  double degree = 16e-6;    // m^3, G(n0); class A: 16e-6
  double lowest = 0.02;     // cycles/m
  double highest = 6.0;     // cycles/m
  double coherence = 0.35;  // cycles/m, n_c
};

double calc_roughness_density(const Roughness& roughness, double wave_number);

/// Left and right track from x = begin on: a sum of harmonics of 1 / length with the density's
/// amplitudes and random phases, averaged over the tire's footprint (0: the bare road).
struct RoughTracks {
  Curve left, right;
};
RoughTracks make_rough_tracks(const Roughness& roughness, double begin, double length,
                              double footprint, std::uint64_t seed);

}  // namespace strut::hidden
