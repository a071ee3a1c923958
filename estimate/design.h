// Bounds of a sweep's parameters by its snapshots, and by measurements that tell more: the
// request's instant, every instant along the way, the best one, two and three, the whole window,
// and what each sensor is worth. docs/identifiability.md explains it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "estimate/instants.h"

namespace strut {

/// The middle of each axis, other parameters as in `base`; then `at` ("axis=value"), then
/// `settings` ("parameter=value"). Throws InputError.
Case make_base_point(const Case& base, const Grid& grid, const std::vector<std::string>& at,
                     const std::vector<std::string>& settings);

/// RK4 with Newton closure, contact events located, and a step of 1 ms or the request's where that
/// is shorter: what differences need, however coarse the sweep itself is.
SolverOptions make_accurate(const SolverOptions& requested);

struct DesignChoice {
  std::vector<std::size_t> instants;  // of Sensitivity::instants
  Bounds bounds;
};

/// A set of channels and what it reaches.
struct SensorSet {
  std::string label;
  std::vector<int> channels;
  Bounds snapshot;    // at the request's instant
  DesignChoice best;  // at this set's own best instant
  Bounds window;
};

struct Design {
  Bounds snapshot;                 // the request's instant
  std::vector<Bounds> scan;        // every instant alone
  std::vector<DesignChoice> best;  // of 1, 2, 3 instants
  Bounds window;                   // all instants together
  std::vector<SensorSet> sensors;  // the channels, then less one each, then with the most useful
                                   // others at the request's instant added one after the other
};

/// Throws InputError for a channel without noise, and where there are fewer than three instants.
Design calc_design(const Sensitivity& s, const std::vector<int>& channels,
                   const SensorNoise& noise);

/// First and last instant around the best one between which the rms of the bounds is less than a
/// tenth above its.
std::pair<std::size_t, std::size_t> find_good_range(const Design& design);

/// The largest half-step error among the curves of `channels`.
struct WorstCurve {
  double error = 0.0;
  int channel = 0;
  std::size_t parameter = 0;
};
WorstCurve find_worst_curve(const Sensitivity& s, const std::vector<int>& channels);

}  // namespace strut
