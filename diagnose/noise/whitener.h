// Whitens the readings of all runs to independent numbers of variance 1: a Fourier transform over
// time, and at every frequency multiplication by the inverse Cholesky factor of the noise's
// covariance over the channels.
//
//   w_k = sqrt(2) C_k^-1 Y_k,  C_k C_k^* = S(f_k),  Y_k: unitary transforms of the channels
//
// Joint motion of the channels that roughness can cause has a small weight; motion that it cannot
// cause has the full weight of the sensors (Whittle's likelihood, P. Whittle, J. R. Stat. Soc. B 15
// (1953)). Where a run's road is an unknown of its own (latent_road.h), C_k has the sensors alone,
// and the road's part is taken out of the numbers of the run together:
//
//   w - H X H' w
//
// Readings of a landing wheel (landings.h) are excluded: the whitened readings are projected onto
// what is orthogonal to them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/noise/latent_road.h"
#include "diagnose/noise/noise_spectrum.h"
#include "estimate/reading_model.h"

namespace strut {

struct WhitenerOptions {
  /// Hz; higher frequencies are ignored, since no effect of the catalogue acts there.
  double highest = 100.0;
  /// Hz; lower frequencies are ignored in tapered runs whose road is noise, where they are offset,
  /// not motion.
  double lowest = 0.6;
  /// Hz; the highest where the road is a run's unknown: shorter waves than its tracks hold.
  double highest_of_road = 33.0;
};

class Whitener {
 public:
  /// Whitens the readings of `model`; its priors stay as they are. `roads`: those in the model's
  /// runs; empty where no run has one. Without a response, they are left to the sensors.
  Whitener(const ReadingModel& model, std::vector<NoiseSpectrum> spectra, LatentRoads roads = {},
           const WhitenerOptions& options = {});

  /// Columns of readings, in units of each channel's sigma, then priors -> whitened, then priors.
  /// For differences of readings and derivatives; see apply_residual for residuals. The same for
  /// any number of threads.
  Eigen::MatrixXd apply(const Eigen::MatrixXd& columns, int threads = 1) const;
  /// The residuals, about the road whose weights are zero, its prior mean.
  Eigen::VectorXd apply_residual(const Eigen::VectorXd& residual) const;
  /// Columns of one run's readings, by its sensors alone.
  Eigen::MatrixXd whiten_run(std::size_t run, const Eigen::MatrixXd& columns_of_run,
                             int threads = 1) const;
  /// Whitens by its sensors alone columns of one run that `before` has whitened by its own. Both
  /// have the same readings, landings and road.
  Eigen::MatrixXd rewhiten_run(std::size_t run, Eigen::MatrixXd columns,
                               const Whitener& before) const;
  /// Residuals whitened by the sensors alone, with the road as it is in the model's run.
  Eigen::VectorXd apply_sensors(std::size_t run, const Eigen::VectorXd& residual) const;
  /// Whitens a linearization without failure.
  Linearization apply(const Linearization& at, int threads = 1) const;

  std::size_t whitened_count() const { return places_.size(); }
  /// Run, frequency (as `time`) and channel of each whitened number, which combines the channels up
  /// to this one.
  const std::vector<ReadingPlace>& places() const { return places_; }
  /// First whitened number of each run, and the end.
  const std::vector<std::size_t>& run_begin() const { return run_begin_; }
  double get_frequency(const ReadingPlace& place) const;
  /// Expected mean square of a run's whitened noise: less than 1 where it is tapered, and where
  /// readings are missing or excluded.
  double get_share(std::size_t run) const { return runs_[run].share; }
  const std::vector<NoiseSpectrum>& spectra() const { return spectra_; }
  const LatentRoads& roads() const { return roads_; }

  /// Whitened image of a disturbance of 1 sigma in one channel at one frequency: C_k^-1 e.
  Eigen::VectorXcd get_sensor_direction(const ReadingPlace& place, std::size_t channel) const;

  /// Log likelihood of the whitened readings of one run, -chi2 / 2 - sum log |C_k|, up to a
  /// constant that does not depend on the spectra.
  double calc_log_likelihood(const Eigen::VectorXd& whitened, std::size_t run) const;
  /// Returns sum log |C_k| for one run.
  double get_log_determinant(std::size_t run) const { return runs_[run].log_determinant; }

 private:
  struct Run {
    std::size_t begin = 0, count = 0;            // readings
    std::vector<std::vector<std::size_t>> rows;  // [channel][sample]: from `begin`; kMissing
    std::vector<double> fade;
    double share = 1.0;                    // see get_share
    Eigen::Index first = 0;                // lowest frequency
    std::vector<Eigen::MatrixXcd> factor;  // [frequency - first]: C_k, lower
    double log_determinant = 0.0;
    /// Orthonormal basis of the whitened landing readings. Empty: none.
    Eigen::MatrixXd landing_basis;
  };
  /// Amplitude of the sensors' noise over their white one, by whitened reading of a run with a road
  /// of its own.
  Eigen::VectorXd list_sensor_noise(std::size_t run) const;
  Eigen::MatrixXd calc_landing_basis(std::size_t run,
                                     const std::vector<LandingReading>& readings) const;
  void apply_run(std::size_t run, const Eigen::Ref<const Eigen::VectorXd>& column,
                 Eigen::Ref<Eigen::VectorXd> out) const;
  bool has_road(std::size_t run) const { return !roads_.empty() && roads_[run] != nullptr; }
  /// nullptr: the run has no road, or its response is not known.
  const WhitenedRoad* find_road(std::size_t run) const {
    return has_road(run) ? roads_[run]->whitened.get() : nullptr;
  }
  void remove_roads(Eigen::MatrixXd& whitened, int threads) const;
  void remove_landings(std::size_t run, Eigen::MatrixXd& whitened) const;

  std::vector<NoiseSpectrum> spectra_;
  LatentRoads roads_;
  std::vector<Run> runs_;
  std::size_t reading_count_ = 0;
  std::vector<ReadingPlace> places_;
  std::vector<std::size_t> run_begin_;
};

/// A model with whitened readings.
class WhitenedModel : public ReadingModel {
 public:
  /// Both must outlive it.
  WhitenedModel(ReadingModel& model, const Whitener& whitener);

  Linearization linearize(const std::vector<double>& values) override;
  using ReadingModel::evaluate;
  std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) override;
  std::vector<double> align(const std::vector<double>& values) override;
  bool has_independent_residuals() const override { return true; }
  double calc_independent_count() const override;

 private:
  ReadingModel& model_;
  const Whitener& whitener_;
};

/// Factor on the variance of noise whose mean square over `count` independent readings is `ratio`
/// times what is expected, at least 1. The deviation from 1, of variance 2 / count, is shrunk
/// (positive part of James and Stein, 4th Berkeley Symp. 1 (1961), with two standard deviations):
/// where each chance deviation counted, noise would on average be stated too large.
double shrink_excess(double ratio, double count);

/// Sets the excess of `spectra`, by run and kNoiseBands, to that of the whitener's spectra times
/// the mean square of the whitened readings, shrunk. A band with few readings in a run uses those
/// of all runs.
void count_excess(const Whitener& whitener, const Eigen::VectorXd& whitened,
                  std::vector<NoiseSpectrum>& spectra);

}  // namespace strut
