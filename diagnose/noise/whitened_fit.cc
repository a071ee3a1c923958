#include "diagnose/noise/whitened_fit.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error/input_error.h"
#include "diagnose/noise/chord_search.h"
#include "diagnose/noise/measure_color.h"
#include "diagnose/noise/road_search.h"
#include "diagnose/noise/roughness.h"

namespace strut {

SharedValues WhitenedFit::shared() const {
  const auto count = static_cast<std::ptrdiff_t>(shared_count);
  return {{fit.unknowns.begin(), fit.unknowns.begin() + count},
          {fit.values.begin(), fit.values.begin() + count}};
}

std::vector<NoiseSpectrum> measure_noise(const CampaignData& data, const Baseline& baseline,
                                         int threads) {
  std::vector<NoiseSpectrum> spectra =
      make_noise_spectra(data, baseline.runs, baseline.fit.unknowns, baseline.fit.values,
                         RoadRecord::kCutOff, threads);
  const auto model = make_reading_model(data, baseline.runs, baseline.fit.unknowns, threads);
  const Evaluation at = model->evaluate(baseline.fit.values);
  if (!at.failure.empty()) throw InputError(at.failure);
  if (!data.has_inputs()) {
    const Roughness roughness =
        measure_roughness(data, baseline.runs, *model, spectra, at.residual);
    for (NoiseSpectrum& s : spectra) {
      s.level = roughness.level;
      s.response_error = roughness.response_error;
    }
  }
  measure_color(*model, at.residual, spectra);
  return spectra;
}

namespace {

/// Where the inputs are recorded, what is beyond the sensors' noise is what is looked for: nothing
/// of it counts as noise.
void fit_driven(ReadingModel& model, const std::vector<double>& start, WhitenedFit& result) {
  FitOptions options;
  options.start = start;
  const Whitener whitener(model, result.spectra);
  WhitenedModel whitened(model, whitener);
  result.fit = fit_readings(whitened, options);
  result.is_dominated = result.fit.chi2_per_degree() > kDominated;
}

/// The fit where the search stands, with derivatives of there; searches on where they see more of
/// a way than it should be.
void conclude(ChordSearch& search, ReadingModel& model, const Whitener& whitener,
              WhitenedFit& result) {
  constexpr int kTries = 3;
  const WhitenedModel whitened(model, whitener);
  for (int i = 0; i < kTries; ++i) {
    if (i > 0) search.search(whitener);
    search.renew();
    result.linearization = search.linearization();
    const Linearization at = {"", whitener.apply_residual(search.residual()),
                              whitener.apply(result.linearization->jacobian)};
    result.fit =
        describe_fit(whitened, at, search.values(), search.list_at_bound(), search.at_kink());
    if (result.fit.converged || search.at_kink()) break;
  }
  result.fit.iterations = search.steps();
  result.fit.simulations = model.simulation_count();
}

/// Searches with the weights of `whitener`; whether the model's error dominates where that ends.
bool is_dominated_after(ChordSearch& search, const Whitener& whitener) {
  search.search(whitener);
  const Eigen::VectorXd residual = whitener.apply_residual(search.residual());
  return residual.squaredNorm() > kDominated * static_cast<double>(residual.size());
}

/// By the road's spectrum. A rough road excites what is not linear, too: what a band has beyond its
/// noise counts as noise. It is known only once the fit is there, and moves it.
void fit_crossing(ReadingModel& model, const std::vector<double>& start, WhitenedFit& result) {
  ChordSearch search(model, start);
  const Whitener of_noise(model, result.spectra);
  result.is_dominated = is_dominated_after(search, of_noise);
  if (result.is_dominated) {
    conclude(search, model, of_noise, result);
    return;
  }
  count_excess(of_noise, of_noise.apply_residual(search.residual()), result.spectra);
  const Whitener with_excess(model, result.spectra);
  search.search(with_excess);
  conclude(search, model, with_excess, result);
}

/// Throws InputError where chi2 is not finite, with the run and the channel of the first residual
/// that is not.
void check_finite(const CampaignData& data, ReadingModel& model, const WhitenedFit& result) {
  if (std::isfinite(result.fit.chi2)) return;
  const Evaluation at = model.evaluate(result.fit.values);
  if (!at.failure.empty()) throw InputError(at.failure);
  for (std::size_t i = 0; i < model.reading_count(); ++i) {
    if (std::isfinite(at.residual(static_cast<Eigen::Index>(i)))) continue;
    const ReadingPlace& place = model.readings()[i];
    const std::size_t run = result.runs[place.run];
    throw InputError(fmt::format(
        "{}: {}: the residual at {:.6g} s is not finite", data.campaign.runs[run].name,
        data.info(data.channels(run)[place.channel].channel).name, data.times(run)[place.time]));
  }
  throw InputError(fmt::format("{}: chi2 of the fit is not finite", data.campaign.path.string()));
}

}  // namespace

RoughStart search_without_roads(const CampaignData& data, const std::vector<std::size_t>& runs,
                                const std::vector<NoiseSpectrum>& spectra,
                                const std::vector<Unknown>& unknowns,
                                const std::vector<double>& start, int threads) {
  const auto model = make_reading_model(data, runs, unknowns, threads);
  ChordSearch search(*model, start);
  const bool is_dominated = is_dominated_after(search, Whitener(*model, spectra));
  return {search.values(), is_dominated};
}

WhitenedFit fit_whitened(const CampaignData& data, const std::vector<std::size_t>& runs,
                         const RunNoise& noise, const std::vector<Unknown>& unknowns,
                         const std::vector<double>& start, std::size_t shared_count, int threads) {
  WhitenedFit result;
  result.runs = runs;
  result.spectra = noise.spectra;
  result.roads = noise.roads;
  result.shared_count = shared_count;
  if (!result.roads.empty() &&
      !search_roads(data, unknowns, start, noise.is_noise_known, threads, result)) {
    result.spectra = noise.spectra;
    result.roads.clear();
  }
  const auto model = make_reading_model(data, runs, result.roads, unknowns, threads);
  if (data.has_inputs()) {
    fit_driven(*model, start, result);
  } else if (result.roads.empty()) {
    fit_crossing(*model, start, result);
  }
  check_finite(data, *model, result);
  return result;
}

}  // namespace strut
