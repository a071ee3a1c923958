// The residual of a fitted model beyond noise: whether there is one, its size, and its place.
#pragma once

#include <string>
#include <vector>

#include "diagnose/baseline/residuals.h"
#include "diagnose/hypothesis/test_bench.h"

namespace strut {

/// A place whose readings hold what is left, and how well that place alone explains it.
struct LeftoverPlace {
  std::string name;  // "front", "rear_left", "body", "road", a channel; "" for a rig's strut
  std::string kind;  // "strut", "body", "sensor"
  /// chi2 along the responses to whatever acts there, less what as many directions of no meaning
  /// would hold; and the standard deviation of that where there is nothing but noise.
  double energy = 0.0, sigma = 0.0;
};

struct Leftover {
  /// Largest excess of chi2 in standard deviations of noise, the uncertainty of the noise's own
  /// level taken off: in a band of a run, in a band or a narrow line of all runs, in everything.
  double significance = 0.0;
  FrequencyBand band;                 // where that is
  double energy = 0.0;                // chi2 beyond noise, of all that stands out
  std::vector<LeftoverPlace> places;  // best first
};

struct LeftoverOptions {
  /// A residual stands out by this many standard deviations ...
  double significant = 6.0;
  /// ... beyond what the noise's own level may be off, relative, of chi2,
  double noise_tolerance = 0.05;
  /// and beyond this share of the power of a rough road: records begin and end on it, and the
  /// response of a nonlinear car to it is not that of a linear one. Measured on hidden trials.
  double road_tolerance = 0.1;
};

/// Power of the road over that of the sensor in a band of a run, mean over the channels.
double calc_road_ratio(const NoiseSpectrum& spectrum, std::size_t band);

/// Measures the residual of the bench's model. Lists places only where some cell stands out.
Leftover measure_leftover(const CampaignData& data, TestBench& bench,
                          const LeftoverOptions& options = {});

}  // namespace strut
