// Rolling disc: the candidates of contact (smooth stretches that the disc fits, convex corners),
// the highest candidate at each position, and the crossings between them.
#include "model/scenario/envelope.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace strut {
namespace {

// --- candidates of contact ------------------------------------------------------------------

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

/// Position of the center of a disc of radius R that touches the profile at u with slope z':
/// x = u - R sin(theta), tan(theta) = z'.
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

/// Adds the contact of the disc with a convex corner of the profile, about which it rotates.
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

/// All candidates of the disc envelope; beyond the first and the last the road is flat.
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

/// Appends the highest branches between a and b, where no branch begins or ends, to `runs`.
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
  const std::size_t highest = find_highest(branches, crossing);
  const double higher =
      std::max(branches[left].calc(crossing).value, branches[right].calc(crossing).value);
  if (depth > 0 && branches[highest].calc(crossing).value > higher + 1e-14) {
    add_runs(branches, a, crossing, depth - 1, runs);
    add_runs(branches, crossing, b, depth - 1, runs);
    return;
  }
  runs.push_back({crossing, right});
}

/// The highest of the branches and of the flat road on both sides, without the parts that are flat
/// road.
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

}  // namespace

std::vector<Branch> make_disc_envelope(const Profile& profile, double radius) {
  if (profile.ends.empty()) return {};
  return calc_upper_envelope(make_disc_branches(profile, radius), profile.ends.front(),
                             profile.ends.back());
}

std::vector<Branch> make_point_branches(const Profile& profile) {
  std::vector<Branch> branches;
  for (std::size_t i = 0; i < profile.get_piece_count(); ++i) {
    branches.push_back({profile.ends[i], profile.ends[i + 1],
                        [&profile, i](double x) { return profile.calc(i, x); }});
  }
  return branches;
}

}  // namespace strut
