// Readings of all runs as independent numbers of variance 1: transformed by time, and at every
// frequency divided by the square root of the noise's covariance over the channels.
//
//   w_k = sqrt(2) C_k^-1 Y_k,  C_k C_k^* = S(f_k),  Y_k: unitary transforms of the channels
//
// Motion that roughness causes in all channels alike then weighs little, and motion that it cannot
// cause weighs as much as the sensors allow: the balance of the body needs no road (Whittle's
// likelihood, P. Whittle, J. R. Stat. Soc. B 15 (1953)).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/noise/noise_spectrum.h"
#include "estimate/reading_model.h"

namespace strut {

struct WhitenerOptions {
  /// Hz; what is faster is left aside: no effect of the catalogue lives there.
  double highest = 100.0;
  /// Hz, where runs are faded: what is slower than a record or two is offset, not motion.
  double lowest = 0.6;
};

class Whitener {
 public:
  /// Whitens the readings of this model, and as many priors.
  Whitener(const ReadingModel& model, std::vector<NoiseSpectrum> spectra,
           const WhitenerOptions& options = {});

  /// Columns of readings, in units of each channel's sigma, then priors -> whitened, then priors.
  Eigen::MatrixXd apply(const Eigen::MatrixXd& columns) const;
  /// Whitens a linearization of a model that could be simulated there.
  Linearization apply(const Linearization& at) const;

  std::size_t whitened_count() const { return places_.size(); }
  /// Run, frequency (as `time`) and channel of each whitened number, the channel the last of those
  /// that it mixes.
  const std::vector<ReadingPlace>& places() const { return places_; }
  /// First whitened number of each run, and the end.
  const std::vector<std::size_t>& run_begin() const { return run_begin_; }
  double get_frequency(const ReadingPlace& place) const;
  /// Expected mean square of a run's whitened noise: less than 1 where it is faded or readings are
  /// missing.
  double get_share(std::size_t run) const { return runs_[run].share; }
  const std::vector<NoiseSpectrum>& spectra() const { return spectra_; }

  /// The whitened 1 sigma of one channel alone at one frequency: C_k^-1 e, complex.
  Eigen::VectorXcd get_sensor_direction(const ReadingPlace& place, std::size_t channel) const;

  /// log of the likelihood of whitened readings, up to a constant that does not depend on the
  /// spectra: -chi2 / 2 - sum log |C_k|, of one run.
  double calc_log_likelihood(const Eigen::VectorXd& whitened, std::size_t run) const;
  /// sum log |C_k| of one run.
  double get_log_determinant(std::size_t run) const { return runs_[run].log_determinant; }

 private:
  struct Run {
    std::vector<std::vector<std::size_t>> rows;  // [channel][sample]: the reading; kMissing
    std::vector<double> fade;
    double share = 1.0;                    // mean square of the fade, missing readings as 0
    Eigen::Index first = 0;                // frequency that is kept
    std::vector<Eigen::MatrixXcd> factor;  // [frequency - first]: C_k, lower
    double log_determinant = 0.0;
  };
  void apply_run(std::size_t run, const Eigen::VectorXd& column,
                 Eigen::Ref<Eigen::VectorXd> out) const;

  std::vector<NoiseSpectrum> spectra_;
  std::vector<Run> runs_;
  std::size_t reading_count_ = 0;
  std::vector<ReadingPlace> places_;
  std::vector<std::size_t> run_begin_;
};

/// A model seen through a whitener: its readings are the whitened numbers.
class WhitenedModel : public ReadingModel {
 public:
  /// Both must outlive it.
  WhitenedModel(ReadingModel& model, const Whitener& whitener);

  Linearization linearize(const std::vector<double>& values) override;
  using ReadingModel::evaluate;
  std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) override;
  std::vector<double> align(const std::vector<double>& values) override;

 private:
  ReadingModel& model_;
  const Whitener& whitener_;
};

/// Sets the spectra's excess, by run and kNoiseBands, to the mean square of whitened readings, at
/// least 1: times the excess that the whitener's spectra have already. Few readings of a run count
/// with those of all runs.
void count_excess(const Whitener& whitener, const Eigen::VectorXd& whitened,
                  std::vector<NoiseSpectrum>& spectra);

/// Roughness as it is seen in residuals.
struct Roughness {
  double level = 0.0;           // G0, m^3
  double response_error = 0.0;  // NoiseSpectrum::response_error
};

/// The roughness under which the whitened residuals of the runs over level ground are most likely.
/// `residual`: of the model's readings. Levels are tried from 1e-7 to 1e-3 m^3.
Roughness fit_roughness(const ReadingModel& model, const std::vector<NoiseSpectrum>& spectra,
                        const std::vector<bool>& is_level, const Eigen::VectorXd& residual);

}  // namespace strut
