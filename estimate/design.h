// Bounds of a sweep's parameters for several designs of its measurement: the request's snapshot,
// every instant along the way, the best one, two and three instants, the whole window, and fewer or
// more sensors. Explained in docs/identifiability.md.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "estimate/instants.h"

namespace strut {

/// Returns `base` with each axis at its middle, then with `at` ("axis=value") and `settings`
/// ("parameter=value") applied. Throws InputError.
Case make_base_point(const Case& base, const Grid& grid, const std::vector<std::string>& at,
                     const std::vector<std::string>& settings);

/// Integration accurate enough for differences, independent of how coarse the sweep's own is: RK4
/// with Newton closure, located contact events, and a step of 1 ms or the request's if shorter.
SolverOptions make_accurate(const SolverOptions& requested);

struct DesignChoice {
  std::vector<std::size_t> instants;  // of Sensitivity::instants
  Bounds bounds;
};

/// A set of channels and its bounds.
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
  /// All channels; all but one, for each of them; then all with further sensors, added one by one,
  /// each the most useful at the request's instant.
  std::vector<SensorSet> sensors;
};

/// Calculates the bounds of all designs. Throws InputError for a channel without noise, and for
/// fewer than three instants.
Design calc_design(const Sensitivity& s, const std::vector<int>& channels,
                   const SensorNoise& noise);

/// First and last instant around the best one between which the rms of the bounds is less than 10 %
/// above its minimum.
std::pair<std::size_t, std::size_t> find_good_range(const Design& design);

/// The largest half-step error among the curves of `channels`.
struct WorstCurve {
  double error = 0.0;
  int channel = 0;
  std::size_t parameter = 0;
};
WorstCurve find_worst_curve(const Sensitivity& s, const std::vector<int>& channels);

}  // namespace strut
