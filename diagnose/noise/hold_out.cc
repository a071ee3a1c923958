#include "diagnose/noise/hold_out.h"

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "estimate/fit.h"
#include "model/error/model_error.h"

namespace strut {
namespace {

/// The color of a channel's sensor in the runs of a fit; white where none of them has the channel.
SensorColor find_color(const std::vector<NoiseSpectrum>& fitted, int channel) {
  for (const NoiseSpectrum& s : fitted) {
    for (const SensorColor& color : s.color) {
      if (color.channel == channel) return color;
    }
  }
  return {};
}

/// What a run kept apart has in common with those of a fit.
void share_noise(const std::vector<NoiseSpectrum>& fitted,
                 const std::vector<MeasuredChannel>& channels, NoiseSpectrum& kept) {
  for (const MeasuredChannel& c : channels) kept.color.push_back(find_color(fitted, c.channel));
  kept.level = fitted.front().level;
  kept.response_error = fitted.front().response_error;
  for (std::size_t b = 0; b < kept.excess.size(); ++b) {
    double sum = 0.0;
    for (const NoiseSpectrum& s : fitted) sum += s.excess[b];
    kept.excess[b] = sum / static_cast<double>(fitted.size());
  }
}

}  // namespace

HoldOutJudge::HoldOutJudge(const CampaignData& data, const WhitenedFit& base, int threads)
    : data_(data), threads_(threads), runs_(data.list_runs(RunUse::kHoldOut)) {
  noise_.resize(runs_.size());
  const SharedValues shared = base.shared();
  share_items(threads, runs_.size(), [&](std::size_t i, int /*thread*/) {
    const CampaignData one = pin_run(data, runs_[i], shared);
    const std::vector<Unknown> unknowns = make_run_unknowns(one, {0}, shared.unknowns);
    noise_[i] = make_noise_spectra(one, {0}, unknowns, list_starts(unknowns)).front();
    share_noise(base.spectra, one.channels(0), noise_[i]);
  });
}

std::vector<HoldOutRun> HoldOutJudge::judge(const SharedValues& shared) const {
  std::vector<HoldOutRun> judged(runs_.size());
  // Each alone on a thread: its few unknowns do not fill several.
  share_items(threads_, runs_.size(), [&](std::size_t i, int /*thread*/) {
    try {
      judged[i] = judge_run(i, shared);
    } catch (const InputError& e) {
      judged[i].failure = e.what();
    } catch (const ModelError& e) {
      judged[i].failure = e.what();
    }
    judged[i].run = runs_[i];
  });
  return judged;
}

HoldOutRun HoldOutJudge::judge_run(std::size_t i, const SharedValues& shared) const {
  const CampaignData one = pin_run(data_, runs_[i], shared);
  const auto model = make_reading_model(one, {0}, make_run_unknowns(one, {0}, shared.unknowns));
  const Whitener whitener(*model, {noise_[i]});
  WhitenedModel whitened(*model, whitener);
  const FitResult fit = fit_readings(whitened);
  HoldOutRun run;
  run.chi2 = fit.chi2;
  run.count = whitener.whitened_count();
  run.expected = static_cast<double>(run.count) * whitener.get_share(0);
  // Priors weigh what is unknown about the run.
  run.log_likelihood = -0.5 * fit.chi2 - whitener.get_log_determinant(0);
  return run;
}

}  // namespace strut
