// Separation of two hypotheses by a run that could be recorded.
#pragma once

#include <optional>
#include <string>

#include "diagnose/campaign/campaign_data.h"
#include "diagnose/decide/select.h"

namespace strut {

/// Two hypotheses as fitted in one round to the existing runs, of which `a` is the better; `plain`:
/// the model of `a` with its effect off.
struct Rivals {
  SharedValues a, b, plain;
  double misfit = 1.0;  // SelectRound::misfit
  /// Shared unknowns of the fit without both, with priors from the existing runs.
  std::vector<Unknown> shared;
  std::vector<double> values;  // at `a`
};

/// The rivals `a` and `b` of a round. Nothing where it did not fit both.
std::optional<Rivals> find_rivals(const CampaignData& data, const Selection& selection,
                                  const std::string& effect_a, const std::string& place_a,
                                  const std::string& effect_b, const std::string& place_b);

/// Upper bound of calc_chi2_between for a and b, which adjusts nothing and takes two simulations.
double bound_chi2_between(const CampaignData& one, const NoiseSpectrum& noise,
                          const Rivals& rivals);

/// chi2 that the model at `from` leaves of the readings, free of noise, that the model at `to`
/// would give in the single run of `one`, after everything that a fit adjusts is adjusted to first
/// order. `noise`: of that run. NaN where one of them cannot be simulated.
double calc_chi2_between(const CampaignData& one, const NoiseSpectrum& noise, const Rivals& rivals,
                         const SharedValues& from, const SharedValues& to);

/// Standard deviations by which a run separates the rivals, as the probabilities count them
/// (probability.h):
///
///   s^2 = d_ab / (m t),   t = 1 + kappa d_a / m
///
/// d_ab: chi2 between a and b, d_a: between a and the model without it, m: misfit, kappa: form
/// error of the effects. NaN as above.
double calc_separation(const CampaignData& one, const NoiseSpectrum& noise, const Rivals& rivals);

}  // namespace strut
