#include "diagnose/hold_out.h"

#include "diagnose/fit.h"
#include "io/input_error.h"

namespace strut {
std::vector<HoldOutRun> judge_hold_out(const CampaignData& data, const SharedValues& shared,
                                       double level, int threads) {
  std::vector<HoldOutRun> judged;
  for (const std::size_t r : data.list_runs(RunUse::kHoldOut)) {
    HoldOutRun run;
    run.run = r;
    const CampaignData one = pin_run(data, r, shared);
    const std::vector<Unknown> unknowns = make_run_unknowns(one, {0}, shared.unknowns);
    std::vector<NoiseSpectrum> spectra =
        make_noise_spectra(one, {0}, unknowns, list_starts(unknowns));
    if (!data.is_rig()) spectra.front().level = level;
    const auto model = make_reading_model(one, {0}, unknowns, threads);
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
    judged.push_back(std::move(run));
  }
  return judged;
}

}  // namespace strut
