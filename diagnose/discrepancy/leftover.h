// The residual of a fitted model beyond noise: its significance, size and location.
#pragma once

#include <string>
#include <vector>

#include "diagnose/baseline/residuals.h"
#include "diagnose/hypothesis/test_bench.h"

namespace strut {

/// A location, and how well a disturbance there explains the residual.
struct LeftoverPlace {
  std::string name;  // "front", "rear_left", "body", "road", a channel; "" for a rig's strut
  std::string kind;  // "strut", "body", "sensor"
  /// chi2 along the responses to any disturbance there, less its expectation along equally many
  /// arbitrary directions; and the standard deviation of that difference under noise alone.
  double energy = 0.0, sigma = 0.0;
};

struct Leftover {
  /// Largest excess of chi2 in standard deviations of noise, less the uncertainty of the noise
  /// level: in a band of a run, in a band or a narrow line of all runs, or in all readings.
  double significance = 0.0;
  FrequencyBand band;                 // of the largest excess
  double energy = 0.0;                // chi2 beyond noise, summed over all significant cells
  std::vector<LeftoverPlace> places;  // best first
};

struct LeftoverOptions {
  /// Standard deviations by which a significant residual exceeds the tolerances below.
  double significant = 6.0;
  /// Relative tolerance of chi2 for the level of the noise.
  double noise_tolerance = 0.05;
  /// Tolerance as a fraction of the power of a rough road: records are cut off on it, and the
  /// response of a car to it is nonlinear. Measured on hidden trials.
  double road_tolerance = 0.1;
};

/// The best location that clearly explains the residual, with five standard deviations of its
/// energy or more; null if there is none.
const LeftoverPlace* find_clear_place(const Leftover& left);

/// Excess of chi2 of `count` degrees of freedom in standard deviations of noise, where its mean may
/// be `allowed`: the cube root of chi2 is nearly normal (E. B. Wilson and M. M. Hilferty, Proc.
/// Natl. Acad. Sci. 17 (1931)). 0 for less than one degree.
double calc_chi2_significance(double chi2, double allowed, double count);

/// Ratio of the power of the road to that of the sensors in a band of a run, mean over the
/// channels.
double calc_road_ratio(const NoiseSpectrum& spectrum, std::size_t band);

/// Whether the residual exceeds noise.
bool is_significant(const Leftover& left, const LeftoverOptions& options = {});

/// Measures the residual of the bench's model. Lists locations only if a cell is significant.
Leftover measure_leftover(const CampaignData& data, TestBench& bench,
                          const LeftoverOptions& options = {});

}  // namespace strut
