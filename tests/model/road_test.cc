// The road under a wheel against closed forms, brute force and the laws it has to obey.
#include "model/scenario/road.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/math/xsimd_backend.h"
#include "model/scenario/envelope.h"

namespace strut {
namespace {

constexpr double kRadius = 0.467;    // m, the paper's wheel
constexpr double kFootprint = 0.12;  // m
const ContactGeometry kDisc{ContactKind::kEnvelope, kRadius, 0.0};
const ContactGeometry kTire{ContactKind::kEnvelope, kRadius, kFootprint};
const ContactGeometry kPointContact{ContactKind::kPoint, kRadius, kFootprint};

RoadSpec make_spec(BumpShape shape, double height = 0.05, double length = 0.4) {
  RoadSpec spec;
  spec.shape = shape;
  spec.height = height;
  spec.length = length;
  return spec;
}

/// Lopsided bump given by points.
RoadSpec make_table_spec() {
  RoadSpec spec = make_spec(BumpShape::kTable);
  for (int i = 0; i <= 40; ++i) {
    const double x = -0.2 + 0.01 * i;
    spec.table_x.push_back(x);
    const bool end = i == 0 || i == 40;
    spec.table_z.push_back(end ? 0.0
                               : 0.05 * (1.0 - 25.0 * x * x) * (1.0 + 0.1 * std::sin(60 * x)));
  }
  return spec;
}

std::vector<RoadSpec> make_all_specs() {
  return {make_spec(BumpShape::kArc), make_spec(BumpShape::kHalfSine),
          make_spec(BumpShape::kCosine), make_spec(BumpShape::kTrapezoid), make_table_spec()};
}

Road<double> make_scalar_road(const Surface& surface, double center = 0.0) {
  const Surface* const surfaces[] = {&surface};
  return make_road<double>(surfaces, &center);
}

RoadPoint<double> calc_point(const Road<double>& road, double x) {
  return calc_road_point(road, x, find_segment(road, x));
}

/// Center of a disc on a circular arc of chord w and height H runs on a circle of radius R + R_b.
struct ArcEnvelope {
  double arc_radius, depth, center_radius, kink;
  ArcEnvelope(double height, double length)
      : arc_radius((0.25 * length * length + height * height) / (2.0 * height)),
        depth(arc_radius - height),
        center_radius(kRadius + arc_radius),
        kink(std::sqrt(center_radius * center_radius - (depth + kRadius) * (depth + kRadius))) {}
  double calc_height(double x) const {
    if (std::fabs(x) >= kink) return 0.0;
    return std::sqrt(center_radius * center_radius - x * x) - depth - kRadius;
  }
  double calc_slope(double x) const {
    if (std::fabs(x) >= kink) return 0.0;
    return -x / std::sqrt(center_radius * center_radius - x * x);
  }
};

/// Cubic B-spline of support 4 a from truncated powers.
long double calc_kernel_by_powers(long double y, long double a) {
  constexpr long double kBinomial[] = {1, -4, 6, -4, 1};
  long double sum = 0;
  for (int k = 0; k <= 4; ++k) {
    const long double reach = y + (2 - k) * a;
    if (reach > 0) sum += kBinomial[k] * reach * reach * reach;
  }
  return sum / (6 * a * a * a * a);
}

/// Average of f over the contact patch at x by Simpson's rule between the kernel's knots and the
/// kinks of f at +-kink.
template <class Function>
double calc_patch_average(const Function& f, double kink, double x) {
  const double a = 0.25 * kFootprint;
  std::vector<double> ends{x - 2 * a, x - a, x, x + a, x + 2 * a};
  for (const double at : {-kink, kink}) {
    if (at > ends.front() && at < ends.back()) ends.push_back(at);
  }
  std::sort(ends.begin(), ends.end());
  long double sum = 0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    constexpr int kSteps = 200;
    // Just inside the ends, where f is one-sided.
    const long double begin = ends[i] + 1e-15, step = (ends[i + 1] - 1e-15 - begin) / kSteps;
    for (int k = 0; k <= kSteps; ++k) {
      const int weight = k == 0 || k == kSteps ? 1 : (k % 2 == 1 ? 4 : 2);
      const long double u = begin + k * step;
      sum += weight * step / 3 * f(static_cast<double>(u)) * calc_kernel_by_powers(x - u, a);
    }
  }
  return static_cast<double>(sum);
}

/// Profile heights on a grid of `step` from -0.2 m.
std::vector<double> sample_profile(const RoadSpec& spec, double step) {
  std::vector<double> heights;
  for (double u = -0.2; u <= 0.2; u = -0.2 + step * static_cast<double>(heights.size())) {
    heights.push_back(calc_profile_height(spec, u));
  }
  return heights;
}

/// max over s of z(x + s) + sqrt(R^2 - s^2) - R on that grid, the road outside of it flat.
double calc_envelope_by_search(const std::vector<double>& heights, double step, double x) {
  double highest = std::fabs(x) > 0.2 ? 0.0 : -1.0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double s = -0.2 + step * static_cast<double>(i) - x;
    if (std::fabs(s) >= kRadius) continue;
    highest = std::max(highest, heights[i] + std::sqrt(kRadius * kRadius - s * s) - kRadius);
  }
  return highest;
}

std::string get_message(const RoadSpec& spec, const ContactGeometry& contact) {
  try {
    make_surface(spec, contact);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

// --- profiles -------------------------------------------------------------------------------

TEST_CASE("The arc is a circle through its ends and its crown", "[unit][road]") {
  for (const double height : {0.2, 0.05, 1e-4}) {
    const RoadSpec spec = make_spec(BumpShape::kArc, height);
    const double radius = (0.04 + height * height) / (2.0 * height);
    for (double x = -0.199; x < 0.2; x += 0.01) {
      const double z = calc_profile_height(spec, x) + radius - height;
      CHECK(std::fabs(std::hypot(x, z) - radius) < 4e-16 * radius);  // 2 eps: hypot and the sum
    }
    CHECK(calc_profile_height(spec, 0.0) == height);
    CHECK(calc_profile_height(spec, 0.2) == 0.0);
    CHECK(calc_profile_height(spec, -0.3) == 0.0);
  }
}

TEST_CASE("Sines and trapezoid follow their formulas", "[unit][road]") {
  RoadSpec trapezoid = make_spec(BumpShape::kTrapezoid);
  trapezoid.ramp = 0.08;
  for (double x = -0.1995; x < 0.2; x += 0.007) {
    const double pi = 3.14159265358979323846;
    const double half_sine = 0.05 * std::sin(pi * (x + 0.2) / 0.4);
    const double cosine = 0.025 * (1.0 + std::cos(2.0 * pi * x / 0.4));
    const double flank = std::min({1.0, (x + 0.2) / 0.08, (0.2 - x) / 0.08});
    // A few roundings of numbers below 0.05, and of pi x / w.
    CHECK(std::fabs(calc_profile_height(make_spec(BumpShape::kHalfSine), x) - half_sine) < 1e-16);
    CHECK(std::fabs(calc_profile_height(make_spec(BumpShape::kCosine), x) - cosine) < 1e-16);
    CHECK(std::fabs(calc_profile_height(trapezoid, x) - 0.05 * flank) < 1e-16);
  }
}

TEST_CASE("A tabulated half sine converges with order four", "[unit][road]") {
  const RoadSpec sine = make_spec(BumpShape::kHalfSine);
  double error[2] = {0.0, 0.0};
  for (int k = 0; k < 2; ++k) {
    RoadSpec table = make_spec(BumpShape::kTable);
    const int n = k == 0 ? 20 : 40;
    for (int i = 0; i <= n; ++i) {
      table.table_x.push_back(-0.2 + 0.4 * i / n);
      table.table_z.push_back(calc_profile_height(sine, table.table_x.back()));
    }
    for (std::size_t i = 0; i < table.table_x.size(); ++i) {
      CHECK(std::fabs(calc_profile_height(table, table.table_x[i]) - table.table_z[i]) < 1e-16);
    }
    for (double x = -0.1999; x < 0.2; x += 0.0011) {
      const double miss = calc_profile_height(table, x) - calc_profile_height(sine, x);
      error[k] = std::max(error[k], std::fabs(miss));
    }
  }
  // Natural ends are right for a half sine, so the order is that of the spline; 0.1 for h^6.
  CHECK(std::fabs(std::log2(error[0] / error[1]) - 4.0) < 0.1);
}

// --- disc envelope --------------------------------------------------------------------------

TEST_CASE("A disc on an arc moves on a circle", "[reference][road]") {
  for (const double height : {0.02, 0.05, 0.2}) {
    const ArcEnvelope truth(height, 0.4);
    const Road<double> road =
        make_scalar_road(make_surface(make_spec(BumpShape::kArc, height), kDisc));
    REQUIRE(road.segment_count == 3);
    // The crossing of two curves that meet at a slope: eps * height / slope.
    CHECK(std::fabs(calc_segment_end(road, 0.0) + truth.kink) < 1e-14);
    CHECK(std::fabs(calc_segment_end(road, 1.0) - truth.kink) < 1e-14);
    for (double x = -0.6; x < 0.6; x += 0.00137) {
      const RoadPoint<double> point = calc_point(road, x);
      CHECK(std::fabs(point.height - truth.calc_height(x)) < 2e-12);  // tabulated to 1e-12
      CHECK(std::fabs(point.slope - truth.calc_slope(x)) < 2e-9);     // tabulated to 1e-9
    }
  }
}

TEST_CASE("A disc turns about the edge of a trapezoid", "[reference][road]") {
  const Road<double> road = make_scalar_road(make_surface(make_spec(BumpShape::kTrapezoid), kDisc));
  // Edge at (-0.1, 0.05): touched until the disc stands above it, from where it left the flank.
  const double flank_angle = std::atan2(0.05, 0.1);
  const double leaves_flank = -0.1 - kRadius * std::sin(flank_angle);
  for (double x = leaves_flank + 1e-6; x < -0.1; x += 0.001) {
    const double s = x + 0.1;
    const double truth = 0.05 + std::sqrt(kRadius * kRadius - s * s) - kRadius;
    const RoadPoint<double> point = calc_point(road, x);
    CHECK(std::fabs(point.height - truth) < 2e-12);
    CHECK(std::fabs(point.slope + s / std::sqrt(kRadius * kRadius - s * s)) < 2e-9);
  }
  CHECK(calc_point(road, 0.03).height == 0.05);
  // The flank's parallel R higher meets the flat road's where R tan(angle / 2) before the foot.
  CHECK(std::fabs(calc_segment_end(road, 0.0) - (-0.2 - kRadius * std::tan(0.5 * flank_angle))) <
        1e-14);
}

TEST_CASE("A disc bridges a pothole on its two edges", "[reference][road]") {
  RoadSpec pothole = make_spec(BumpShape::kTable);
  pothole.table_x = {-0.1, -0.05, 0.0, 0.05, 0.1};
  pothole.table_z = {0.0, -0.2, -0.3, -0.2, 0.0};
  const Road<double> road = make_scalar_road(make_surface(pothole, kDisc));
  for (double x = -0.12; x < 0.12; x += 0.001) {
    const double s = std::max(0.1 - std::fabs(x), 0.0);
    const double truth = std::sqrt(kRadius * kRadius - s * s) - kRadius;
    CHECK(std::fabs(calc_point(road, x).height - truth) < 2e-12);
  }
}

TEST_CASE("The disc envelope is the highest of all contacts", "[reference][road]") {
  for (const RoadSpec& spec : make_all_specs()) {
    const bool table = spec.shape == BumpShape::kTable;  // slow to sample
    const double step = table ? 2e-5 : 5e-6;
    const std::vector<double> heights = sample_profile(spec, step);
    const Road<double> road = make_scalar_road(make_surface(spec, kDisc));
    for (double x = -0.35; x < 0.35; x += 0.0237) {
      const double found = calc_envelope_by_search(heights, step, x);
      const double height = calc_point(road, x).height;
      // Between grid points the search misses at most slope jump * step (a corner off the grid).
      CHECK(height > found - 2e-12);
      CHECK(height < found + step);
      // At a smooth contact it misses curvature * step^2 / 8, curvature below 30 / m.
      if (spec.shape != BumpShape::kTrapezoid) CHECK(height < found + 4.0 * step * step + 2e-12);
    }
  }
}

/// Straight lines through points that begin and end on the flat road.
Profile make_line_profile(const std::vector<double>& x, const std::vector<double>& z) {
  return {x, [=](std::size_t piece, double at) -> Jet {
            const double slope = (z[piece + 1] - z[piece]) / (x[piece + 1] - x[piece]);
            return {z[piece] + slope * (at - x[piece]), slope, 0.0};
          }};
}

TEST_CASE("A peak that carries the disc for a fraction of a millimeter is found",
          "[reference][road]") {
  // Three peaks 50 mm apart; the middle one reaches by `excess` below a disc on the outer two.
  const double outer = 0.03, apart = 0.05;
  const auto calc_arc = [](double s) { return std::sqrt(kRadius * kRadius - s * s) - kRadius; };
  for (int i = 0; i < 10; ++i) {
    const double center = 0.1 + 3e-4 * i, excess = 2e-5;
    const double middle = outer + calc_arc(apart) + excess;
    const std::vector<double> x = {0.0,    center - apart,       center - 0.5 * apart,
                                   center, center + 0.5 * apart, center + apart,
                                   0.25};
    const Profile profile = make_line_profile(x, {0.0, outer, 0.01, middle, 0.01, outer, 0.0});
    const std::vector<Branch> branches = make_disc_envelope(profile, kRadius);
    for (double at = center - 5e-4; at < center + 5e-4; at += 2e-5) {
      const double truth =
          std::max({outer + calc_arc(at - center + apart), outer + calc_arc(at - center - apart),
                    middle + calc_arc(at - center)});
      const auto branch = std::find_if(branches.begin(), branches.end(),
                                       [&](const Branch& b) { return at < b.end; });
      REQUIRE(branch != branches.end());
      CHECK(branch->calc(at).value == Approx(truth).margin(1e-14));
    }
  }
}

// --- average over the contact patch ---------------------------------------------------------

TEST_CASE("The surface is the patch average of the disc envelope", "[reference][road]") {
  const ArcEnvelope truth(0.05, 0.4);
  const Road<double> road = make_scalar_road(make_surface(make_spec(BumpShape::kArc), kTire));
  REQUIRE(road.segment_count == 1);
  double height_error = 0.0, slope_error = 0.0;
  for (double x = -0.36; x < 0.36; x += 0.000317) {
    const RoadPoint<double> point = calc_point(road, x);
    const auto height = [&](double u) { return truth.calc_height(u); };
    const auto slope = [&](double u) { return truth.calc_slope(u); };
    height_error =
        std::max(height_error, std::fabs(point.height - calc_patch_average(height, truth.kink, x)));
    slope_error =
        std::max(slope_error, std::fabs(point.slope - calc_patch_average(slope, truth.kink, x)));
  }
  INFO("height error " << height_error << " m, slope error " << slope_error);
  CHECK(height_error < 1e-10);  // the accuracy the page docs/design/0003 promises
  CHECK(slope_error < 1e-8);
}

TEST_CASE("Averaging keeps a plateau, a ramp and the area", "[property][road]") {
  RoadSpec spec = make_spec(BumpShape::kTrapezoid, 0.1, 3.0);
  spec.ramp = 1.0;
  const Road<double> road = make_scalar_road(make_surface(spec, kTire));
  for (double x = -0.4; x < 0.4; x += 0.01) {
    CHECK(std::fabs(calc_point(road, x).height - 0.1) < 1e-15);  // sum of weights, some eps
    CHECK(std::fabs(calc_point(road, x).slope) < 1e-13);         // eps * height / cell
  }
  for (double x = -1.2; x < -0.8; x += 0.01) {
    CHECK(std::fabs(calc_point(road, x).slope - 0.1) < 1e-13);
  }
  const ArcEnvelope arc(0.05, 0.4);
  const Surface surface = make_surface(make_spec(BumpShape::kArc), kTire);
  double area = 0.0;
  for (const RoadCell& cell : surface.cells) {
    for (int k = 0; k < 6; ++k) area += cell.coefficient[static_cast<std::size_t>(k)] / (k + 1);
  }
  area /= surface.segments[0].inverse_cell;
  const double half = std::asin(arc.kink / arc.center_radius);
  const double truth = arc.center_radius * arc.center_radius * (half - 0.5 * std::sin(2.0 * half));
  CHECK(std::fabs(area - truth) < 1e-12);  // height error 1e-11 m over 0.7 m, of either sign
}

TEST_CASE("Neighboring cells share height, slope and curvature", "[property][road]") {
  for (const RoadSpec& spec : make_all_specs()) {
    for (const ContactGeometry& contact : {kTire, kDisc, kPointContact}) {
      const Surface surface = make_surface(spec, contact);
      for (const RoadSegment& segment : surface.segments) {
        const auto first = static_cast<std::size_t>(segment.first_cell);
        const auto last = first + static_cast<std::size_t>(segment.last_cell);
        for (std::size_t i = first; i < last; ++i) {
          double sums[3] = {0.0, 0.0, 0.0};
          for (int k = 0; k < 6; ++k) {
            const double c = surface.cells[i].coefficient[static_cast<std::size_t>(k)];
            sums[0] += c;
            sums[1] += k * c;
            sums[2] += 0.5 * k * (k - 1) * c;
          }
          const auto& next = surface.cells[i + 1].coefficient;
          // In units of the cell; coefficients below 0.05, sums of six with factors up to 150.
          for (std::size_t k = 0; k < 3; ++k) CHECK(std::fabs(sums[k] - next[k]) < 2e-15);
        }
      }
    }
  }
}

TEST_CASE("The slope is the derivative of the height", "[property][road]") {
  for (const RoadSpec& spec : make_all_specs()) {
    for (const ContactGeometry& contact : {kTire, kDisc, kPointContact}) {
      const Road<double> road = make_scalar_road(make_surface(spec, contact), 3.0);
      for (double x = 2.4; x < 3.6; x += 0.00313) {
        const double segment = find_segment(road, x);
        constexpr double kStep = 1e-5;
        const auto height = [&](double at) { return calc_road_point(road, at, segment).height; };
        const double slope = (8.0 * (height(x + kStep) - height(x - kStep)) -
                              (height(x + 2 * kStep) - height(x - 2 * kStep))) /
                             (12.0 * kStep);
        // Rounding of x near 3 moves it by 4e-16 / 1e-5; third derivatives jump by < 1 / m^2.
        CHECK(std::fabs(calc_road_point(road, x, segment).slope - slope) < 1e-9);
      }
    }
  }
}

TEST_CASE("A mirrored bump gives a mirrored surface", "[property][road]") {
  RoadSpec mirrored = make_table_spec();
  std::reverse(mirrored.table_z.begin(), mirrored.table_z.end());
  for (const ContactGeometry& contact : {kTire, kDisc, kPointContact}) {
    for (const RoadSpec& spec : make_all_specs()) {
      const bool table = spec.shape == BumpShape::kTable;
      const Road<double> road = make_scalar_road(make_surface(spec, contact));
      const Road<double> mirror = make_scalar_road(make_surface(table ? mirrored : spec, contact));
      for (double x = -0.4; x < 0.4; x += 0.00311) {
        const RoadPoint<double> a = calc_point(road, x), b = calc_point(mirror, -x);
        CHECK(std::fabs(a.height - b.height) < 2e-11);  // twice the tabulation's accuracy
        CHECK(std::fabs(a.slope + b.slope) < 1e-8);
      }
    }
  }
}

// --- segments and lanes ---------------------------------------------------------------------

TEST_CASE("A segment goes on beyond its kink", "[unit][road]") {
  const ArcEnvelope truth(0.05, 0.4);
  const Road<double> road = make_scalar_road(make_surface(make_spec(BumpShape::kArc), kDisc), 10.0);
  const double kink = calc_segment_end(road, 1.0);
  CHECK(find_segment(road, kink - 1e-9) == 1.0);
  CHECK(find_segment(road, kink + 1e-9) == 2.0);
  CHECK(calc_segment_end(road, 2.0) == 1e300);
  const double x = kink + 0.01;  // half a millisecond at 20 m/s
  const double circle = std::sqrt(truth.center_radius * truth.center_radius - (x - 10) * (x - 10)) -
                        truth.depth - kRadius;
  // Two thirds of a cell beyond the end the quintic's error has grown some hundredfold.
  CHECK(std::fabs(calc_road_point(road, x, 1.0).height - circle) < 1e-9);
  CHECK(calc_road_point(road, x, 2.0).height == 0.0);
  CHECK(calc_road_point(road, kink - 0.01, 2.0).height == 0.0);
  CHECK(calc_road_point(road, kink - 0.01, 0.0).height == 0.0);
}

TEST_CASE("A smooth surface and a flat road need no events", "[unit][road]") {
  for (const RoadSpec& spec :
       {make_spec(BumpShape::kArc), make_spec(BumpShape::kNone), make_spec(BumpShape::kArc, 0.0)}) {
    const Road<double> road = make_scalar_road(make_surface(spec, kTire), 10.0);
    CHECK(road.segment_count == 1);
    CHECK(find_segment(road, 11.0) == 0.0);
    CHECK(calc_segment_end(road, 0.0) == 1e300);
    CHECK(calc_point(road, 9.0).height == 0.0);
    CHECK(calc_point(road, -1e9).slope == 0.0);
    CHECK((calc_point(road, 10.0).height > 0.04) ==
          (spec.shape == BumpShape::kArc && spec.height > 0));
  }
  CHECK(calc_road_point(Road<double>{}, 1.0, 0.0).height == 0.0);
}

TEST_CASE("Every lane equals its own scalar road", "[unit][road][lanes]") {
  constexpr int kWidth = NativeLanes::kWidth;
  std::vector<Surface> different{Surface{}, Surface{}, Surface{}, Surface{}, Surface{}};
  different[0] = make_surface(make_spec(BumpShape::kTrapezoid), kDisc);
  different[1] = make_surface(make_spec(BumpShape::kArc), kTire);
  different[2] = make_surface(make_spec(BumpShape::kNone), kTire);
  different[3] = make_surface(make_table_spec(), kDisc);
  different[4] = make_surface(make_spec(BumpShape::kCosine), kPointContact);
  for (std::size_t shift = 0; shift < different.size(); ++shift) {
    const Surface* surfaces[kWidth];
    double centers[kWidth];
    std::vector<Road<double>> scalar;
    for (int lane = 0; lane < kWidth; ++lane) {
      surfaces[lane] = &different[(static_cast<std::size_t>(lane) + shift) % different.size()];
      centers[lane] = 10.0 + 0.3 * lane;
      scalar.push_back(make_scalar_road(*surfaces[lane], centers[lane]));
    }
    const auto road = make_road<NativeLanes>(surfaces, centers);
    for (double at = 9.3; at < 10.7 + 0.3 * kWidth; at += 0.0041) {
      NativeLanes x(at);
      for (int lane = 0; lane < kWidth; ++lane) set_lane(x, lane, at + 0.11 * lane);
      const NativeLanes segment = find_segment(road, x);
      const NativeLanes end = calc_segment_end(road, segment);
      const auto point = calc_road_point(road, x, segment);
      for (int lane = 0; lane < kWidth; ++lane) {
        const Road<double>& own = scalar[static_cast<std::size_t>(lane)];
        const double own_x = at + 0.11 * lane, own_segment = find_segment(own, own_x);
        CHECK(get_lane(segment, lane) == own_segment);
        CHECK(get_lane(end, lane) == calc_segment_end(own, own_segment));
        const RoadPoint<double> truth = calc_road_point(own, own_x, own_segment);
        // Contraction to fused multiply-adds may differ: eps * height, and over the cell length.
        CHECK(std::fabs(get_lane(point.height, lane) - truth.height) < 1e-15);
        CHECK(std::fabs(get_lane(point.slope, lane) - truth.slope) < 1e-12);
      }
    }
  }
}

TEST_CASE("A diverged lane reads inside the table and disturbs no other", "[unit][road][lanes]") {
  for (const ContactGeometry& contact : {kTire, kDisc}) {
    const Surface surface = make_surface(make_spec(BumpShape::kArc), contact);
    std::vector<const Surface*> surfaces(NativeLanes::kWidth, &surface);
    const std::vector<double> centers(NativeLanes::kWidth, 10.0);
    const auto road = make_road<NativeLanes>(surfaces.data(), centers.data());
    const NativeLanes good(10.05);
    const auto truth = calc_road_point(road, good, find_segment(road, good));
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e300, -1e300}) {
      NativeLanes x = good;
      set_lane(x, 0, bad);
      const auto point = calc_road_point(road, x, find_segment(road, x));
      for (int lane = 1; lane < NativeLanes::kWidth; ++lane) {
        CHECK(get_lane(point.height, lane) == get_lane(truth.height, lane));
        CHECK(get_lane(point.slope, lane) == get_lane(truth.slope, lane));
      }
    }
  }
}

TEST_CASE("Equal surfaces are stored once", "[unit][road][lanes]") {
  const Surface one = make_surface(make_spec(BumpShape::kArc), kTire);
  const Surface same = make_surface(make_spec(BumpShape::kArc), kTire);
  std::vector<const Surface*> surfaces(NativeLanes::kWidth, &one);
  surfaces.back() = &same;
  const std::vector<double> centers(NativeLanes::kWidth, 10.0);
  CHECK(make_road<NativeLanes>(surfaces.data(), centers.data()).cells.size() == one.cells.size());
}

// --- bad input ------------------------------------------------------------------------------

TEST_CASE("A bad road names field, value and range", "[unit][road]") {
  using Catch::Contains;
  RoadSpec spec = make_spec(BumpShape::kArc, 0.3);
  CHECK_THAT(get_message(spec, kTire), Contains("road.height = 0.3") && Contains("0.2"));
  spec.height = -0.01;
  CHECK_THAT(get_message(spec, kTire), Contains("road.height = -0.01") && Contains("[0, 0.5]"));
  spec.height = std::numeric_limits<double>::quiet_NaN();
  CHECK_THAT(get_message(spec, kTire), Contains("road.height"));
  spec = make_spec(BumpShape::kCosine, 0.05, 0.0);
  CHECK_THAT(get_message(spec, kTire), Contains("road.length = 0 ") && Contains("[0.001, 20]"));
  spec = make_spec(BumpShape::kTrapezoid);
  spec.ramp = 0.25;
  CHECK_THAT(get_message(spec, kTire), Contains("road.ramp = 0.25") && Contains("0.2]"));
  spec = make_spec(BumpShape::kArc, 0.2);
  CHECK(get_message(spec, kTire) == "accepted");
  CHECK_THAT(get_message(spec, kPointContact), Contains("road.height = 0.2"));
  spec = make_table_spec();
  spec.table_z[0] = 0.01;
  CHECK_THAT(get_message(spec, kTire), Contains("road.table_z[0] = 0.01"));
  spec = make_table_spec();
  spec.table_x[7] = spec.table_x[6];
  CHECK_THAT(get_message(spec, kTire), Contains("road.table_x[7]"));
  spec.table_z.pop_back();
  CHECK_THAT(get_message(spec, kTire), Contains("road.table_z") && Contains("41"));
  ContactGeometry contact = kTire;
  contact.footprint = 0.005;
  CHECK_THAT(get_message(make_spec(BumpShape::kArc), contact), Contains("tire.footprint = 0.005"));
  contact.radius = 0.0;
  CHECK_THAT(get_message(make_spec(BumpShape::kArc), contact), Contains("tire.radius = 0 "));
}

}  // namespace
}  // namespace strut
