// How a bump becomes a surface: profile -> branches (what the tire touches, and where) -> upper
// envelope -> averaged over the contact patch -> cells.
#include "model/scenario/road.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>

namespace strut {
namespace {

constexpr double kPi = std::numbers::pi;

/// Function value with its first two derivatives.
struct Jet {
  double value = 0.0, slope = 0.0, curvature = 0.0;
};

// --- validation -----------------------------------------------------------------------------

void require(bool ok, const std::string& field, double value, const std::string& allowed) {
  if (ok) return;
  std::ostringstream message;
  message << field << " = " << value << " is not allowed: " << allowed;
  throw std::invalid_argument(message.str());
}

void require_range(const std::string& field, double value, double lowest, double highest) {
  std::ostringstream allowed;
  allowed << "must lie in [" << lowest << ", " << highest << "] m";
  require(value >= lowest && value <= highest, field, value, allowed.str());
}

void validate_table(const RoadSpec& spec) {
  const std::vector<double>&x = spec.table_x, &z = spec.table_z;
  require(x.size() >= 3, "road.table_x, number of points", static_cast<double>(x.size()),
          "a profile needs at least 3");
  require(z.size() == x.size(), "road.table_z, number of points", static_cast<double>(z.size()),
          "must equal the " + std::to_string(x.size()) + " of road.table_x");
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::string at = "[" + std::to_string(i) + "]";
    require_range("road.table_x" + at, x[i], -20.0, 20.0);
    require_range("road.table_z" + at, z[i], -0.5, 0.5);
    require(i == 0 || x[i] - x[i - 1] >= 1e-4, "road.table_x" + at, x[i],
            "must exceed the point before by 0.0001 m or more");
  }
  require(std::fabs(z.front()) <= 1e-6, "road.table_z[0]", z.front(),
          "a profile begins at the flat road, within 1e-6 m of 0");
  require(std::fabs(z.back()) <= 1e-6, "road.table_z, last", z.back(),
          "a profile ends at the flat road, within 1e-6 m of 0");
}

// --- profile: smooth pieces -----------------------------------------------------------------

/// z(x) of one bump as smooth pieces; piece i spans ends[i] .. ends[i + 1].
struct Profile {
  std::vector<double> ends;
  std::function<Jet(std::size_t piece, double x)> calc;
  std::size_t get_piece_count() const { return ends.empty() ? 0 : ends.size() - 1; }
};

Jet calc_arc(double height, double length, double x) {
  const double radius = (0.25 * length * length + height * height) / (2.0 * height);
  // A semicircle stands upright at its ends; the bound keeps the slope a number.
  const double rise = std::max(std::sqrt(std::max(radius * radius - x * x, 0.0)), 1e-9 * radius);
  return {height - x * x / (radius + rise), -x / rise, -radius * radius / (rise * rise * rise)};
}

Jet calc_half_sine(double height, double length, double x) {
  const double k = kPi / length;
  const double c = std::cos(k * x), s = std::sin(k * x);
  return {height * c, -height * k * s, -height * k * k * c};
}

Jet calc_cosine(double height, double length, double x) {
  const double k = kPi / length;  // H/2 (1 + cos 2kx) = H cos^2 kx, without cancellation
  const double c = std::cos(k * x), s = std::sin(k * x);
  return {height * c * c, -2.0 * height * k * s * c, 2.0 * height * k * k * (s * s - c * c)};
}

Profile make_smooth_profile(const RoadSpec& spec, Jet (*shape)(double, double, double)) {
  const double height = spec.height, length = spec.length;
  return {{-0.5 * length, 0.5 * length},
          [=](std::size_t, double x) { return shape(height, length, x); }};
}

Profile make_trapezoid(const RoadSpec& spec) {
  const double height = spec.height, half = 0.5 * spec.length, ramp = spec.ramp;
  const double slope = height / ramp;
  std::vector<double> ends{-half, -half + ramp, half - ramp, half};
  if (half - ramp < 1e-9) ends = {-half, 0.0, half};
  const std::size_t last = ends.size() - 2;
  return {ends, [=](std::size_t piece, double x) -> Jet {
            if (piece == 0) return {slope * (x + half), slope, 0.0};
            if (piece == last) return {slope * (half - x), -slope, 0.0};
            return {height, 0.0, 0.0};
          }};
}

/// Second derivatives at the points of the natural cubic spline (Thomas algorithm).
std::vector<double> solve_spline(const std::vector<double>& x, const std::vector<double>& z) {
  const std::size_t n = x.size();
  std::vector<double> moment(n, 0.0), ratio(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = x[i] - x[i - 1], after = x[i + 1] - x[i];
    const double bend = (z[i + 1] - z[i]) / after - (z[i] - z[i - 1]) / before;
    const double pivot = 2.0 * (before + after) - before * ratio[i - 1];
    ratio[i] = after / pivot;
    moment[i] = (6.0 * bend - before * moment[i - 1]) / pivot;
  }
  for (std::size_t i = n - 2; i > 0; --i) moment[i] -= ratio[i] * moment[i + 1];
  return moment;
}

Profile make_table_profile(const RoadSpec& spec) {
  std::vector<double> x = spec.table_x, z = spec.table_z;
  z.front() = z.back() = 0.0;
  const std::vector<double> moment = solve_spline(x, z);
  return {x, [x, z, moment](std::size_t i, double at) -> Jet {
            const double h = x[i + 1] - x[i], b = (at - x[i]) / h, a = 1.0 - b;
            const double left = moment[i] * h * h / 6.0, right = moment[i + 1] * h * h / 6.0;
            const double bend = (a * a * a - a) * left + (b * b * b - b) * right;
            const double tilt = (1.0 - 3.0 * a * a) * left + (3.0 * b * b - 1.0) * right;
            return {a * z[i] + b * z[i + 1] + bend, (z[i + 1] - z[i] + tilt) / h,
                    a * moment[i] + b * moment[i + 1]};
          }};
}

Profile make_profile(const RoadSpec& spec) {
  if (spec.shape == BumpShape::kTable) return make_table_profile(spec);
  if (spec.shape == BumpShape::kNone || spec.height == 0.0) return {};
  if (spec.shape == BumpShape::kArc) return make_smooth_profile(spec, calc_arc);
  if (spec.shape == BumpShape::kHalfSine) return make_smooth_profile(spec, calc_half_sine);
  if (spec.shape == BumpShape::kCosine) return make_smooth_profile(spec, calc_cosine);
  return make_trapezoid(spec);
}

// --- branches: what the tire touches --------------------------------------------------------

/// Smooth candidate for the height of the road, valid between begin and end. Its function refers to
/// the profile, which has to live as long.
struct Branch {
  double begin = 0.0, end = 0.0;
  std::function<Jet(double x)> calc;
};

/// Root of f between a and b, f(a) and f(b) of different sign, to the last bit.
template <class Function>
double bisect(const Function& f, double a, double b) {
  const bool rising = f(a) < 0.0;
  while (true) {
    const double middle = 0.5 * (a + b);
    if (middle <= a || middle >= b) return middle;
    ((f(middle) < 0.0) == rising ? a : b) = middle;
  }
}

/// Where a disc of radius R that touches the profile at u with slope z' has its center: x = u -
/// R sin(theta), tan(theta) = z'.
double calc_disc_center(double u, double slope, double radius) {
  return u - radius * slope / std::sqrt(1.0 + slope * slope);
}

/// 1 - R kappa: positive where a disc of radius R fits the profile.
double calc_fit(const Jet& z, double radius) {
  const double stretch = 1.0 + z.slope * z.slope;
  return 1.0 - radius * z.curvature / (stretch * std::sqrt(stretch));
}

/// Lowest point of a disc that touches the smooth profile between u_begin and u_end, center at x.
/// The contact solves u - R sin(theta(u)) = x, rising where the disc fits: Newton in a bracket.
Jet calc_smooth_contact(const std::function<Jet(double)>& profile, double u_begin, double u_end,
                        double radius, double x) {
  double low = u_begin, high = u_end;
  double u = std::clamp(x, low, high);
  Jet z = profile(u);
  for (int i = 0; i < 200; ++i) {
    const double miss = calc_disc_center(u, z.slope, radius) - x;
    (miss < 0.0 ? low : high) = u;
    const double fit = calc_fit(z, radius);
    double next = u - miss / fit;
    if (!(fit > 0.0 && next > low && next < high)) next = 0.5 * (low + high);
    const double step = std::fabs(next - u);
    u = next;
    z = profile(u);
    if (step <= 4e-16 * (1.0 + std::fabs(u))) break;
  }
  const double root = std::sqrt(1.0 + z.slope * z.slope);
  const double drop = radius * z.slope * z.slope / (root * (1.0 + root));
  return {z.value - drop, z.slope, z.curvature / calc_fit(z, radius)};
}

/// Adds the stretches of one smooth piece that a disc of this radius can touch.
void add_smooth_branches(const Profile& profile, std::size_t piece, double radius,
                         std::vector<Branch>& branches) {
  const double begin = profile.ends[piece], end = profile.ends[piece + 1];
  const std::function<Jet(double)> z = [&profile, piece](double u) {
    return profile.calc(piece, u);
  };
  const auto fit = [&](double u) { return calc_fit(z(u), radius); };
  const int samples = profile.get_piece_count() > 8 ? 8 : 128;
  std::vector<double> edges{begin};
  for (int i = 0; i < samples; ++i) {
    const double a = begin + (end - begin) * i / samples;
    const double b = i + 1 == samples ? end : begin + (end - begin) * (i + 1) / samples;
    if ((fit(a) > 0.0) != (fit(b) > 0.0)) edges.push_back(bisect(fit, a, b));
  }
  edges.push_back(end);
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double a = edges[i], b = edges[i + 1];
    if (b - a < 1e-12 || fit(0.5 * (a + b)) <= 0.0) continue;
    branches.push_back({calc_disc_center(a, z(a).slope, radius),
                        calc_disc_center(b, z(b).slope, radius),
                        [=](double x) { return calc_smooth_contact(z, a, b, radius, x); }});
  }
}

/// The disc turns about a corner of the profile that points upwards.
void add_corner_branch(double u, double height, double slope_before, double slope_after,
                       double radius, std::vector<Branch>& branches) {
  if (slope_before - slope_after < 1e-9) return;
  branches.push_back({calc_disc_center(u, slope_before, radius),
                      calc_disc_center(u, slope_after, radius), [=](double x) -> Jet {
                        const double s = u - x;
                        const double rise = std::sqrt(radius * radius - s * s);
                        return {height - s * s / (radius + rise), s / rise,
                                -radius * radius / (rise * rise * rise)};
                      }});
}

Jet calc_flat(double /*x*/) { return {}; }

/// All candidates of the disc envelope; outside of the first and last lies the flat road.
std::vector<Branch> make_disc_branches(const Profile& profile, double radius) {
  std::vector<Branch> branches;
  const std::size_t pieces = profile.get_piece_count();
  double slope_before = 0.0;
  for (std::size_t i = 0; i < pieces; ++i) {
    const Jet z = profile.calc(i, profile.ends[i]);
    add_corner_branch(profile.ends[i], z.value, slope_before, z.slope, radius, branches);
    add_smooth_branches(profile, i, radius, branches);
    slope_before = profile.calc(i, profile.ends[i + 1]).slope;
  }
  add_corner_branch(profile.ends.back(), 0.0, slope_before, 0.0, radius, branches);
  return branches;
}

std::vector<Branch> make_point_branches(const Profile& profile) {
  std::vector<Branch> branches;
  for (std::size_t i = 0; i < profile.get_piece_count(); ++i) {
    branches.push_back({profile.ends[i], profile.ends[i + 1],
                        [&profile, i](double x) { return profile.calc(i, x); }});
  }
  return branches;
}

// --- upper envelope -------------------------------------------------------------------------

/// Highest branch at x; branches that meet at a point differ there by rounding only.
std::size_t find_highest(const std::vector<Branch>& branches, double x) {
  std::size_t best = branches.size();
  double highest = -1e300;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    if (x < branches[i].begin - 1e-12 || x > branches[i].end + 1e-12) continue;
    const double value = branches[i].calc(x).value;
    if (value > highest) {
      highest = value;
      best = i;
    }
  }
  return best;
}

struct Run {
  double begin;
  std::size_t branch;
};

/// Appends to `runs` who is highest between a and b, where no branch begins or ends.
void add_runs(const std::vector<Branch>& branches, double a, double b, int depth,
              std::vector<Run>& runs) {
  const double inset = 1e-3 * (b - a);
  const std::size_t left = find_highest(branches, a + inset);
  const std::size_t right = find_highest(branches, b - inset);
  if (runs.empty() || runs.back().branch != left) runs.push_back({a, left});
  if (left == right) return;
  const auto lead = [&](double x) {
    return branches[left].calc(x).value - branches[right].calc(x).value;
  };
  const double crossing = bisect(lead, a + inset, b - inset);
  const std::size_t there = find_highest(branches, crossing);
  const double most =
      std::max(branches[left].calc(crossing).value, branches[right].calc(crossing).value);
  if (depth > 0 && branches[there].calc(crossing).value > most + 1e-14) {
    add_runs(branches, a, crossing, depth - 1, runs);
    add_runs(branches, crossing, b, depth - 1, runs);
    return;
  }
  runs.push_back({crossing, right});
}

/// The highest of the branches and the flat road on both sides, without those sides.
std::vector<Branch> calc_upper_envelope(std::vector<Branch> branches, double begin, double end) {
  double first = begin, last = end;
  for (const Branch& branch : branches) {
    first = std::min(first, branch.begin);
    last = std::max(last, branch.end);
  }
  branches.push_back({first - 1.0, begin, calc_flat});
  branches.push_back({end, last + 1.0, calc_flat});
  constexpr int kSamples = 512;
  std::vector<double> edges;
  for (int i = 0; i <= kSamples; ++i) {
    edges.push_back(first - 1e-3 + (last - first + 2e-3) * i / kSamples);
  }
  for (const Branch& branch : branches) {
    edges.push_back(branch.begin);
    edges.push_back(branch.end);
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Run> runs;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    if (edges[i + 1] - edges[i] > 1e-11) add_runs(branches, edges[i], edges[i + 1], 8, runs);
  }
  std::vector<Branch> envelope;
  for (std::size_t i = 1; i + 1 < runs.size(); ++i) {
    envelope.push_back({runs[i].begin, runs[i + 1].begin, branches[runs[i].branch].calc});
  }
  return envelope;
}

// --- cells ----------------------------------------------------------------------------------

/// Quintic through value, slope and curvature at both ends of a cell.
RoadCell make_cell(const Jet& a, const Jet& b, double h) {
  const double c0 = a.value, c1 = h * a.slope, c2 = 0.5 * h * h * a.curvature;
  const double d = b.value - c0 - c1 - c2;
  const double e = h * b.slope - c1 - 2.0 * c2;
  const double g = h * h * b.curvature - 2.0 * c2;
  return {{c0, c1, c2, 10.0 * d - 4.0 * e + 0.5 * g, -15.0 * d + 7.0 * e - g,
           6.0 * d - 3.0 * e + 0.5 * g, 0.0, 0.0}};
}

double calc_cell(const RoadCell& cell, double t) {
  const auto& c = cell.coefficient;
  return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
}

double calc_cell_slope(const RoadCell& cell, double t) {
  const auto& c = cell.coefficient;
  return c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * (4.0 * c[4] + t * 5.0 * c[5])));
}

/// How far a polynomial may be from the function it stands for.
struct Tolerance {
  double value;  // m
  double slope;
};

template <class Function>
bool is_accurate(const RoadCell& cell, const Function& f, double begin, double h,
                 const Tolerance& tolerance) {
  for (const double t : {0.5, 0.25, 0.75}) {
    const Jet truth = f(begin + t * h);
    if (std::fabs(calc_cell(cell, t) - truth.value) > tolerance.value) return false;
    if (std::fabs(calc_cell_slope(cell, t) / h - truth.slope) > tolerance.slope) return false;
  }
  return true;
}

/// `count` equal cells over [begin, end]; none at all if `checked` and one is not accurate.
template <class Function>
std::vector<RoadCell> fill_cells(const Function& f, double begin, double end, std::size_t count,
                                 const Tolerance& tolerance, bool checked) {
  const double h = (end - begin) / static_cast<double>(count);
  std::vector<RoadCell> cells;
  Jet left = f(begin);
  for (std::size_t i = 0; i < count; ++i) {
    const double a = begin + h * static_cast<double>(i);
    const Jet right = f(i + 1 == count ? end : begin + h * static_cast<double>(i + 1));
    cells.push_back(make_cell(left, right, h));
    if (checked && !is_accurate(cells.back(), f, a, h, tolerance)) return {};
    left = right;
  }
  return cells;
}

/// Equal cells over [begin, end], doubled from `count` until accurate, at most 4096.
template <class Function>
std::vector<RoadCell> tabulate(const Function& f, double begin, double end, std::size_t count,
                               const Tolerance& tolerance) {
  std::vector<RoadCell> cells;
  for (; cells.empty(); count *= 2) {
    cells = fill_cells(f, begin, end, count, tolerance, 2 * count <= 4096);
  }
  return cells;
}

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

// --- surface with kinks ---------------------------------------------------------------------

bool is_smooth_joint(const Branch& before, const Branch& after) {
  const Jet a = before.calc(before.end), b = after.calc(before.end);
  return std::fabs(a.slope - b.slope) < 1e-7 &&
         std::fabs(a.curvature - b.curvature) < 1e-5 * (1.0 + std::fabs(a.curvature));
}

/// One segment from the branches first .. last, which join smoothly.
void add_kinked_segment(const std::vector<Branch>& branches, std::size_t first, std::size_t last,
                        Surface& surface) {
  const double begin = branches[first].begin, end = branches[last].end;
  const std::size_t count = last - first + 1;
  bool even = true;  // cells that end where equal branches meet are exact for a spline
  for (std::size_t i = first; i <= last; ++i) {
    const double share = (branches[i].end - branches[i].begin) * static_cast<double>(count);
    even = even && std::fabs(share / (end - begin) - 1.0) < 1e-9;
  }
  const auto f = [&](double x) {
    std::size_t i = first;
    while (i < last && x > branches[i].end) ++i;
    return branches[i].calc(x);
  };
  const std::vector<RoadCell> cells = tabulate(f, begin, end, even ? count : 1, {1e-12, 1e-9});
  add_segment(cells, begin, (end - begin) / static_cast<double>(cells.size()), end, surface);
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
  require(surface.segments.size() <= 66, "road, number of kinks",
          static_cast<double>(surface.segments.size() - 1),
          "at most 65 events a crossing; use a contact with a footprint, which needs none");
  return surface;
}

// --- average over the contact patch ---------------------------------------------------------

/// Cells of different length that cover the disc envelope.
struct Patchwork {
  std::vector<double> begins;  // and the end of the last
  std::vector<RoadCell> cells;
};

/// Halves [begin, end] until a quintic is good to 1e-13 m.
void add_patches(const std::function<Jet(double)>& f, double begin, double end, int depth,
                 Patchwork& patches) {
  const double h = end - begin;
  const RoadCell cell = make_cell(f(begin), f(end), h);
  if (depth > 0 && !is_accurate(cell, f, begin, h, {1e-13, 1e300})) {
    const double middle = 0.5 * (begin + end);
    add_patches(f, begin, middle, depth - 1, patches);
    add_patches(f, middle, end, depth - 1, patches);
    return;
  }
  patches.begins.push_back(begin);
  patches.cells.push_back(cell);
}

/// Centered cubic B-spline of unit spacing and integral, with two derivatives.
Jet calc_kernel(double t) {
  const double side = t < 0.0 ? -1.0 : 1.0, a = std::fabs(t), b = 2.0 - a;
  if (a >= 2.0) return {};
  if (a >= 1.0) return {b * b * b / 6.0, -0.5 * side * b * b, b};
  return {2.0 / 3.0 + a * a * (0.5 * a - 1.0), side * a * (1.5 * a - 2.0), 3.0 * a - 2.0};
}

/// Gauss-Legendre on [0, 1], 5 points: exact to degree 9; quintic times cubic has 8.
constexpr std::array<double, 5> kGaussPoint{0.046910077030668004, 0.23076534494715845, 0.5,
                                            0.76923465505284155, 0.95308992296933200};
constexpr std::array<double, 5> kGaussWeight{0.11846344252809454, 0.23931433524968324,
                                             0.28444444444444444, 0.23931433524968324,
                                             0.11846344252809454};

/// Integral of patch(u) kernel((x - u) / a) / a over [begin, end], inside one patch and one span of
/// the kernel, and its derivatives by x.
void add_patch_integral(const RoadCell& cell, double cell_begin, double cell_length, double begin,
                        double end, double x, double a, Jet& sum) {
  for (std::size_t i = 0; i < kGaussPoint.size(); ++i) {
    const double u = begin + (end - begin) * kGaussPoint[i];
    const double weight = (end - begin) / a * kGaussWeight[i];
    const double part = weight * calc_cell(cell, (u - cell_begin) / cell_length);
    const Jet kernel = calc_kernel((x - u) / a);
    sum.value += part * kernel.value;
    sum.slope += part * kernel.slope / a;
    sum.curvature += part * kernel.curvature / (a * a);
  }
}

/// Average of the patchwork over the contact patch, exact but for rounding.
Jet calc_average(const Patchwork& patches, double a, double x) {
  Jet sum;
  const std::vector<double>& begins = patches.begins;
  const auto above = std::upper_bound(begins.begin(), begins.end(), x - 2.0 * a);
  std::size_t i =
      above == begins.begin() ? 0 : static_cast<std::size_t>(above - begins.begin()) - 1;
  for (; i < patches.cells.size() && begins[i] < x + 2.0 * a; ++i) {
    for (int span = -2; span < 2; ++span) {
      const double begin = std::max(begins[i], x + a * span);
      const double end = std::min(begins[i + 1], x + a * (span + 1));
      if (end <= begin) continue;
      add_patch_integral(patches.cells[i], begins[i], begins[i + 1] - begins[i], begin, end, x, a,
                         sum);
    }
  }
  return sum;
}

/// One smooth segment; a zero cell at each end stands for the flat road.
Surface make_smooth_surface(const std::vector<Branch>& branches, double footprint) {
  Patchwork patches;
  for (const Branch& branch : branches) {
    add_patches(branch.calc, branch.begin, branch.end, 14, patches);
  }
  patches.begins.push_back(branches.back().end);
  const double a = 0.25 * footprint;
  const double begin = branches.front().begin - 2.0 * a, end = branches.back().end + 2.0 * a;
  const auto f = [&](double x) {
    return x <= begin || x >= end ? Jet{} : calc_average(patches, a, x);
  };
  const auto count = static_cast<std::size_t>(std::ceil(8.0 * (end - begin) / a));
  std::vector<RoadCell> cells = tabulate(f, begin, end, count, {1e-11, 5e-9});
  const double length = (end - begin) / static_cast<double>(cells.size());
  cells.insert(cells.begin(), RoadCell{});
  cells.push_back(RoadCell{});
  Surface surface;
  surface.reach_begin = begin;
  surface.reach_end = end;
  add_segment(cells, begin - length, length, 1e300, surface);
  return surface;
}

Surface make_flat_surface() {
  Surface surface;
  add_segment({RoadCell{}}, 0.0, 1.0, 1e300, surface);
  return surface;
}

}  // namespace

void validate(const RoadSpec& spec) {
  if (spec.shape == BumpShape::kNone) return;
  if (spec.shape == BumpShape::kTable) return validate_table(spec);
  require_range("road.length", spec.length, 0.001, 20.0);
  require_range("road.height", spec.height, 0.0, 0.5);
  if (spec.shape == BumpShape::kArc) {
    require(spec.height <= 0.5 * spec.length, "road.height", spec.height,
            "an arc is at most half as high as long, " + std::to_string(0.5 * spec.length) + " m");
  }
  if (spec.shape == BumpShape::kTrapezoid) {
    require_range("road.ramp", spec.ramp, 1e-4, 0.5 * spec.length);
  }
}

void validate(const ContactGeometry& contact) {
  if (contact.kind == ContactKind::kPoint) return;
  require_range("tire.radius", contact.radius, 0.05, 2.0);
  if (contact.footprint != 0.0) require_range("tire.footprint", contact.footprint, 0.02, 1.0);
}

double calc_profile_height(const RoadSpec& spec, double x) {
  validate(spec);
  const Profile profile = make_profile(spec);
  const std::vector<double>& ends = profile.ends;
  if (ends.empty() || x <= ends.front() || x >= ends.back()) return 0.0;
  const auto above = std::upper_bound(ends.begin(), ends.end(), x);
  return profile.calc(static_cast<std::size_t>(above - ends.begin()) - 1, x).value;
}

Surface make_surface(const RoadSpec& spec, const ContactGeometry& contact) {
  validate(spec);
  validate(contact);
  const Profile profile = make_profile(spec);
  if (profile.ends.empty()) return make_flat_surface();
  if (contact.kind == ContactKind::kPoint) {
    const bool upright = spec.shape == BumpShape::kArc && spec.height > 0.45 * spec.length;
    require(!upright, "road.height", spec.height,
            "with point contact an arc is at most 0.45 of its length high");
    return make_kinked_surface(make_point_branches(profile));
  }
  const std::vector<Branch> branches = calc_upper_envelope(
      make_disc_branches(profile, contact.radius), profile.ends.front(), profile.ends.back());
  if (branches.empty()) return make_flat_surface();
  return contact.footprint > 0.0 ? make_smooth_surface(branches, contact.footprint)
                                 : make_kinked_surface(branches);
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
