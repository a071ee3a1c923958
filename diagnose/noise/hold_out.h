// Runs that were kept apart, as the judge of a model.
#pragma once

#include <string>
#include <vector>

#include "diagnose/noise/whitened_fit.h"

namespace strut {

struct HoldOutRun {
  std::size_t run = 0;  // of the campaign
  std::string failure;  // empty: it could be simulated
  double chi2 = 0.0;    // whitened, and of the priors
  double log_likelihood = 0.0;
  std::size_t count = 0;  // of whitened readings
  double expected = 0.0;  // chi2 of a perfect model
};

/// All models are judged by one noise, that of the model they started from: else one that answers
/// more to noise would do better by that alone.
class HoldOutJudge {
 public:
  /// The noise of the runs held out: `base`'s, and what its bands have in excess, mean over the
  /// runs it was fitted to. `data` must outlive it. Throws InputError where a run cannot be
  /// simulated with `base`.
  HoldOutJudge(const CampaignData& data, const WhitenedFit& base, int threads);

  /// Each run that is held out at these shared values, what is unknown about it alone fitted to it.
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
};

}  // namespace strut
