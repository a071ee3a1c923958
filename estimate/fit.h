// Identification by fitting the simulation itself: the unknowns that make the simulated readings
// agree with the measured ones in the least-squares sense, and their uncertainty.
//
//   minimize  chi2(p) = sum ((y_sim(t + t0; p) + b - y) / sigma)^2 + sum ((p - mean) / sigma_p)^2
//
// by Levenberg-Marquardt (base/least_squares/levenberg_marquardt.h), one batch of lanes per
// Jacobian. Equations and measured accuracy: docs/fit.md.
#pragma once

#include <string>
#include <vector>

#include "estimate/linearize_options.h"
#include "estimate/reading_model.h"
#include "estimate/uncertainty.h"

namespace strut {

/// Maximum distances from the minimum of a converged fit, in standard deviations. A distance d
/// enlarges the root mean square error of an estimate by the factor sqrt(1 + d^2): by 0.5 %, at a
/// kink by 12 %.
inline constexpr double kFitTolerance = 0.1, kKinkTolerance = 0.5;
/// Tolerance of chi2 about its expectation, in standard deviations.
inline constexpr double kFitSigmas = 4.0;

struct FitOptions {
  LinearizeOptions linearize;
  int iterations = 50;  // max accepted steps
  /// First mu relative to the diagonal of J'J. Small, since initial guesses are close: worn springs
  /// and dampers, not other cars.
  double first_damping = 1e-5;
  std::vector<double> start;  // initial guess; empty: the unknowns' own
};

/// The fit of one channel of one run.
struct ChannelFit {
  int run = 0, channel = 0;  // the latter in ModelInfo::channels
  long count = 0;            // number of readings
  double chi2 = 0.0;         // of these readings
  /// Correlation of neighboring residuals. Within 2 / sqrt(count) of 0 if they are white; otherwise
  /// the model lacks something or the noise is not white.
  double neighbor_correlation = 0.0;
};

struct FitResult {
  std::vector<Unknown> unknowns;
  std::vector<double> values;  // in their units
  std::vector<bool> at_bound;  // held by a bound
  Uncertainty uncertainty;     // at `values`
  /// The uncertainty for noise as large as the residuals: the weight of the readings is divided by
  /// max(1, chi2 / degrees), that of the priors unchanged; wider where the residual stands in the
  /// readings that decide an unknown (uneven_residual.h).
  Uncertainty widened;
  double chi2 = 0.0;  // of readings and priors
  long degrees = 0;   // of freedom: number of readings and priors less the rank
  std::vector<ChannelFit> channels;
  /// Distance to the minimum of the linear model, in standard deviations (widened by
  /// calc_widening).
  double distance = 0.0;
  /// No step of any length lowers chi2: it has a kink here, where a contact event passes a reading
  /// and the linear model holds on one side only.
  bool at_kink = false;
  bool converged = false;  // distance below kFitTolerance, at a kink below kKinkTolerance
  int iterations = 0;
  long simulations = 0;
  long outside = 0;  // number of readings outside of the simulated time, left out

  double chi2_per_degree() const;
  /// Excess of chi2 over its expectation, the degrees of freedom, in standard deviations.
  double calc_excess() const;
  /// Whether chi2 is at most that of noise alone; and whether it is smaller, so the assumed noise
  /// is too large.
  bool is_adequate() const { return calc_excess() <= kFitSigmas; }
  bool is_quiet() const { return calc_excess() < -kFitSigmas; }
};

/// Fits the unknowns of `model`, whose own options replace `options.linearize`. Throws InputError
/// where the initial guess cannot be simulated.
FitResult fit_readings(ReadingModel& model, const FitOptions& options = {});

/// Removes the unknowns at a bound from the normal equations.
NormalEquations free_unknowns(NormalEquations normal, const std::vector<bool>& at_bound);

/// sqrt(g' H^-1 g): distance to the minimum of the linear model, in standard deviations.
double calc_distance(const NormalEquations& normal);

/// Factor by which residuals larger than noise widen standard deviations: sqrt(chi2 / degrees), at
/// least 1.
double calc_widening(const ReadingModel& model, const Linearization& at);

/// Makes the result of a search that ended at `values`, from the linearization there.
FitResult describe_fit(const ReadingModel& model, const Linearization& at,
                       std::vector<double> values, std::vector<bool> at_bound, bool at_kink);

/// Fits `unknowns` to `runs`. A step to a point that cannot be simulated is rejected. Deterministic
/// for any number of threads. Throws InputError for unusable runs or unknowns, and where the
/// initial guess cannot be simulated.
FitResult fit_simulation(const std::vector<MeasuredRun>& runs, const std::vector<Unknown>& unknowns,
                         const FitOptions& options = {});

/// The Cramer-Rao bound of such a fit at the initial guess. It depends on the times, channels and
/// sigmas of the runs, not on their readings (make_planned_run). Throws as fit_simulation.
Uncertainty calc_fit_bounds(const std::vector<MeasuredRun>& runs,
                            const std::vector<Unknown>& unknowns,
                            const LinearizeOptions& options = {});

}  // namespace strut
