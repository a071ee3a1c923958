// Validates models on the held-out runs.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/noise/whitened_fit.h"

namespace strut {

struct HoldOutRun {
  std::size_t run = 0;  // of the campaign
  std::string failure;  // empty: it could be simulated
  double chi2 = 0.0;    // of the whitened readings and the priors
  double log_likelihood = 0.0;
  std::size_t count = 0;       // of whitened readings
  double expected = 0.0;       // chi2 of a perfect model
  Eigen::VectorXd residual{};  // of the whitened readings, then of the priors
};

/// Fall of the held-out runs' chi2 from one model to another, and its expectation if the other is
/// true: s = |w - w'|^2 over their whitened residuals w. Runs that one of them cannot simulate do
/// not count.
struct HoldOutFall {
  double fall = 0.0, expected = 0.0;
  double misfit = 1.0;  // factor on the variance of the noise

  /// Whether chi2 does not rise, or only as noise makes it rise where the other model is true: the
  /// fall's standard deviation is then 2 sqrt(misfit s), and three of them are allowed. Runs that
  /// hardly respond neither confirm a cause nor contradict it.
  bool is_possible() const;
};

HoldOutFall calc_fall(const std::vector<HoldOutRun>& before, const std::vector<HoldOutRun>& after,
                      double misfit);

/// Validates all models with the same noise, that of the base model: otherwise a model with a
/// larger response to noise would have the higher likelihood for that alone.
class HoldOutJudge {
 public:
  /// Sets the noise of the held-out runs to that of `base`, with the excess of its bands averaged
  /// over the fitted runs, and estimates their roads where those of `base` are estimated. `data`
  /// must outlive it. Throws InputError where a run cannot be simulated with `base`.
  HoldOutJudge(const CampaignData& data, const WhitenedFit& base, int threads);

  /// Evaluates each held-out run at these shared values; only its own unknowns are fitted to it.
  std::vector<HoldOutRun> judge(const SharedValues& shared) const;

  const std::vector<std::size_t>& runs() const { return runs_; }
  /// The noise of runs()[i].
  const NoiseSpectrum& get_noise(std::size_t i) const { return noise_[i]; }

 private:
  HoldOutRun judge_run(std::size_t i, const SharedValues& shared) const;

  const CampaignData& data_;
  int threads_;
  std::vector<std::size_t> runs_;
  std::vector<NoiseSpectrum> noise_;
  std::vector<LatentRoads> roads_;    // of each run; empty where the road is noise
  std::vector<SharedValues> starts_;  // of each run's own unknowns; empty: their own
};

}  // namespace strut
