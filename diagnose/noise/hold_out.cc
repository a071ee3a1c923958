#include "diagnose/noise/hold_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "diagnose/campaign/campaign_unknowns.h"
#include "diagnose/noise/noise_floor.h"
#include "estimate/fit.h"
#include "model/error/model_error.h"

namespace strut {
namespace {

/// Throws InputError where a fit of a run does not have finite results.
void check_finite(const CampaignData& data, const HoldOutRun& run) {
  if (std::isfinite(run.chi2) && std::isfinite(run.log_likelihood)) return;
  throw InputError(fmt::format("{}: its chi2 is {}, its log-likelihood {}; expected finite numbers",
                               data.campaign.runs[run.run].name, run.chi2, run.log_likelihood));
}

/// The values that were found for these unknowns, else their own initial guess.
std::vector<double> make_start(const std::vector<Unknown>& unknowns, const SharedValues& found) {
  std::vector<double> start = list_starts(unknowns);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    for (std::size_t k = 0; k < found.unknowns.size(); ++k) {
      if (found.unknowns[k].name == unknowns[i].name) start[i] = found.values[k];
    }
  }
  return start;
}

}  // namespace

bool HoldOutFall::is_possible() const {
  constexpr double kSigmas = 3.0;
  return fall >= std::min(0.0, expected - kSigmas * 2.0 * std::sqrt(misfit * expected));
}

HoldOutFall calc_fall(const std::vector<HoldOutRun>& before, const std::vector<HoldOutRun>& after,
                      double misfit) {
  HoldOutFall sum;
  sum.misfit = misfit;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const HoldOutRun &b = before[i], &a = after[i];
    if (!b.failure.empty() || !a.failure.empty()) continue;
    sum.fall += b.chi2 - a.chi2;
    // An effect may make one of a run's own unknowns, and its prior, one of all runs.
    const bool are_alike = b.residual.size() == a.residual.size();
    const auto count = are_alike ? a.residual.size() : static_cast<Eigen::Index>(a.count);
    sum.expected += (b.residual.head(count) - a.residual.head(count)).squaredNorm();
  }
  return sum;
}

HoldOutJudge::HoldOutJudge(const CampaignData& data, const WhitenedFit& base, int threads)
    : data_(data), threads_(threads), runs_(data.list_runs(RunUse::kHoldOut)) {
  noise_.resize(runs_.size());
  roads_.resize(runs_.size());
  starts_.resize(runs_.size());
  const SharedValues shared = base.shared();
  share_large_items(threads, runs_.size(), [&](std::size_t i, int inside) {
    noise_[i] = make_spectrum_of_run(data, runs_[i], base.spectra, shared);
    if (base.roads.empty()) return;
    const CampaignData one = pin_run(data, runs_[i], shared);
    const std::vector<Unknown> own = make_run_unknowns(one, {0}, shared.unknowns);
    const RoughStart start =
        search_without_roads(one, {0}, {noise_[i]}, own, list_starts(own), inside);
    const RunNoise noise{{noise_[i]}, make_smooth_roads(one, {0}), true};
    WhitenedFit found = fit_whitened(one, {0}, noise, own, start.values, 0, inside);
    roads_[i] = std::move(found.roads);
    starts_[i] = {own, std::move(found.fit.values)};
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
  const std::vector<Unknown> own = make_run_unknowns(one, {0}, shared.unknowns);
  const auto model = make_reading_model(one, {0}, roads_[i], own);
  const Whitener whitener(*model, {noise_[i]}, roads_[i]);
  WhitenedModel whitened(*model, whitener);
  FitOptions options;
  options.start = make_start(own, starts_[i]);
  const FitResult fit = fit_readings(whitened, options);
  HoldOutRun run;
  run.run = runs_[i];
  run.chi2 = fit.chi2;
  run.count = whitener.whitened_count();
  run.residual = whitened.evaluate(fit.values).residual;
  run.expected = static_cast<double>(run.count) * whitener.get_share(0);
  // Priors weigh what is unknown about the run.
  run.log_likelihood = -0.5 * fit.chi2 - whitener.get_log_determinant(0);
  check_finite(data_, run);
  return run;
}

}  // namespace strut
