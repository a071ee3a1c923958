#include "diagnose/hold_out.h"

#include "diagnose/fit.h"
#include "io/input_error.h"
#include "model/parallel/team.h"

namespace strut {
std::vector<HoldOutRun> judge_hold_out(const CampaignData& data, const SharedValues& shared,
                                       double level, int threads) {
  const std::vector<std::size_t> runs = data.list_runs(RunUse::kHoldOut);
  std::vector<HoldOutRun> judged(runs.size());
  // Each alone on a thread: its few unknowns do not fill several.
  share_items(threads, runs.size(), [&](std::size_t i, int /*thread*/) {
    const std::size_t r = runs[i];
    HoldOutRun& run = judged[i];
    run.run = r;
    const CampaignData one = pin_run(data, r, shared);
    const std::vector<Unknown> unknowns = make_run_unknowns(one, {0}, shared.unknowns);
    std::vector<NoiseSpectrum> spectra =
        make_noise_spectra(one, {0}, unknowns, list_starts(unknowns));
    if (!data.is_rig()) spectra.front().level = level;
    const auto model = make_reading_model(one, {0}, unknowns);
    const Whitener whitener(*model, spectra);
    WhitenedModel whitened(*model, whitener);
    try {
      const FitResult fit = fit_readings(whitened);
      run.chi2 = fit.chi2;
      run.count = whitener.whitened_count();
      // Priors weigh what is unknown about the run.
      run.log_likelihood = -0.5 * fit.chi2 - whitener.get_log_determinant(0);
    } catch (const InputError& e) {
      run.failure = e.what();
    }
  });
  return judged;
}

}  // namespace strut
