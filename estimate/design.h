// Bounds of a sweep's parameters for several designs of its measurement: the request's snapshot,
// every instant along the way, the best one, two and three instants, the whole window, and fewer or
// more sensors. Explained in docs/identifiability.md.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "estimate/instants.h"

namespace strut {

/// Sets in `base` each axis to its middle; then `at` ("axis=value"), then `settings`
/// ("parameter=value"). Throws InputError.
Case make_base_point(const Case& base, const Grid& grid, const std::vector<std::string>& at,
                     const std::vector<std::string>& settings);

/// The integration that differences need, however coarse the sweep's own: RK4 with Newton closure,
/// contact events located, and a step of 1 ms or the request's where that is shorter.
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
  /// All channels; all but one of them, for each; then with the most useful other sensors at the
  /// request's instant, added one by one.
  std::vector<SensorSet> sensors;
};

/// Throws InputError for a channel without noise, and for fewer than three instants.
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
