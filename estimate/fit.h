// Identification by fitting the simulation itself: the unknowns that make the simulated readings
// agree with the measured ones in the least-squares sense, and how well they are known.
//
//   minimize  chi2(p) = sum ((y_sim(t + t0; p) + b - y) / sigma)^2 + sum ((p - mean) / sigma_p)^2
//
// by Levenberg-Marquardt (base/least_squares/levenberg_marquardt.h), one batch of lanes a Jacobian.
// Equations and measured accuracy: docs/fit.md.
#pragma once

#include <string>
#include <vector>

#include "estimate/linearize.h"
#include "estimate/uncertainty.h"

namespace strut {

/// Distances from the minimum, in standard deviations. An estimate that is off by d of them has a
/// root mean square error sqrt(1 + d^2) times as large: by 0.5 % more, at a kink 12 %.
inline constexpr double kFitTolerance = 0.1, kKinkTolerance = 0.5;
/// Standard deviations by which chi2 may miss its expectation.
inline constexpr double kFitSigmas = 4.0;

struct FitOptions {
  LinearizeOptions linearize;
  int iterations = 50;  // accepted steps at most
  /// First mu relative to the diagonal of J'J: starts are near, worn springs and dampers, not other
  /// cars.
  double first_damping = 1e-5;
  std::vector<double> start;  // values where the search begins; empty: the unknowns' own
};

/// The fit of one channel of one run.
struct ChannelFit {
  int run = 0, channel = 0;  // of the model: CarChannel, or of list_rig_channels
  long count = 0;            // readings
  double chi2 = 0.0;         // their share of chi2
  /// Correlation of neighboring residuals: within 2 / sqrt(count) of 0 where they are white; else
  /// the model lacks something, or the noise is not white.
  double neighbor_correlation = 0.0;
};

struct FitResult {
  std::vector<Unknown> unknowns;
  std::vector<double> values;  // in their units
  std::vector<bool> at_bound;  // held there by a bound
  Uncertainty uncertainty;     // at `values`
  /// The same for a noise that explains what is left: readings count max(1, chi2 / degrees) times
  /// less, priors as they are.
  Uncertainty widened;
  double chi2 = 0.0;  // readings and priors
  long degrees = 0;   // readings and priors less rank
  std::vector<ChannelFit> channels;
  /// Distance to the minimum that the linear model sees, in standard deviations; those of a model
  /// that leaves more than noise are sqrt(chi2 / degrees) times as large.
  double distance = 0.0;
  /// No step of any length lowers chi2 any more: a kink of it, where a contact event passes a
  /// reading and the linear model holds on one side only.
  bool at_kink = false;
  bool converged = false;  // distance below kFitTolerance, at a kink below kKinkTolerance
  int iterations = 0;
  long simulations = 0;
  long outside = 0;  // readings outside of what is simulated, left aside

  double chi2_per_degree() const;
  /// Standard deviations by which chi2 exceeds its expectation, the degrees of freedom.
  double calc_excess() const;
  /// chi2 is not larger, not smaller than noise alone makes it.
  bool is_adequate() const { return calc_excess() <= kFitSigmas; }
  bool is_quiet() const { return calc_excess() < -kFitSigmas; }
};

/// Fits what can be fitted. `options.linearize` is the model's own affair. Throws InputError where
/// the start cannot be simulated.
FitResult fit_readings(ReadingModel& model, const FitOptions& options = {});

/// The normal equations without the unknowns that a bound holds.
NormalEquations free_unknowns(NormalEquations normal, const std::vector<bool>& at_bound);

/// sqrt(g' H^-1 g): how far the linear model sees its minimum, in standard deviations.
double calc_distance(const NormalEquations& normal);

/// By how much what the model leaves beyond noise widens standard deviations: sqrt(chi2 / degrees),
/// at least 1.
double calc_widening(const ReadingModel& model, const Linearization& at);

/// The result of a search that ended at `values`, where the model is linearized.
FitResult describe_fit(const ReadingModel& model, const Linearization& at,
                       std::vector<double> values, std::vector<bool> at_bound, bool at_kink);

/// Fits. Simulations that fail on the way are steps not taken. Deterministic for any number of
/// threads. Throws InputError for unusable runs or unknowns, and where the start cannot be
/// simulated.
FitResult fit_simulation(const std::vector<MeasuredRun>& runs, const std::vector<Unknown>& unknowns,
                         const FitOptions& options = {});

/// The Cramer-Rao bound of such a fit at the unknowns' start; only times, channels and sigmas of
/// the runs matter, not their readings (make_planned_run). Throws as fit_simulation.
Uncertainty calc_fit_bounds(const std::vector<MeasuredRun>& runs,
                            const std::vector<Unknown>& unknowns,
                            const LinearizeOptions& options = {});

}  // namespace strut
