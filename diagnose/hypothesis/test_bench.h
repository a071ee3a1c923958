// The model of a campaign with all hypotheses within reach: a fitted baseline, whitened residuals
// and derivatives around it, and every effect switched off but ready to be switched on.
#pragma once

#include <Eigen/Cholesky>
#include <memory>
#include <string>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/hypothesis/evidence.h"
#include "diagnose/hypothesis/hypothesis_search.h"
#include "diagnose/noise/whitened_fit.h"

namespace strut {

class TestBench {
 public:
  /// Around a fit. `data` must outlive it. Throws InputError where the model cannot be simulated
  /// there.
  TestBench(const CampaignData& data, const WhitenedFit& fit, int threads);

  /// Changes of the whitened readings by the beginnings of hypotheses, a column each parameter that
  /// switches; 0 where they cannot be simulated. Appends to `trials` which is which.
  Eigen::MatrixXd simulate_columns(const std::vector<Hypothesis>& hypotheses,
                                   std::vector<HypothesisTrial>& trials);

  /// Changes of the whitened readings by values of further unknowns that all runs share: a column
  /// each point; 0 where it cannot be simulated. The unknowns have no priors.
  Eigen::MatrixXd simulate_columns(const std::vector<Unknown>& added,
                                   const std::vector<std::vector<double>>& points);

  /// Puts hypotheses within reach and simulates their beginnings.
  Evidence gather(const std::vector<Hypothesis>& hypotheses);

  /// Gauss-Newton from a beginning. Of a car with the baseline's derivatives as they are at its
  /// fit, and the hypothesis' own anew in every step; of a rig with all anew. One thread, and
  /// several fits may run at once.
  HypothesisFit fit(const Hypothesis& hypothesis, const std::vector<double>& beginning) const;

  const Whitener& whitener() const { return *whitener_; }
  const Eigen::VectorXd& residual() const { return residual_; }
  /// Derivatives of the residual by the unknowns, counted in their scale.
  const Eigen::MatrixXd& jacobian() const { return jacobian_; }
  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  const std::vector<double>& values() const { return values_; }
  std::size_t shared_count() const { return shared_count_; }
  long simulation_count() const { return simulations_; }
  std::size_t run_count() const { return runs_.size(); }
  /// Which of the campaign's runs it is.
  std::size_t get_run(std::size_t number) const { return runs_[number]; }

 private:
  std::unique_ptr<ReadingModel> make_model(const std::vector<Unknown>& added, int threads) const;

  const CampaignData& data_;
  std::vector<std::size_t> runs_;
  std::vector<Unknown> unknowns_;
  std::vector<double> values_;
  std::size_t shared_count_;
  int threads_;
  std::unique_ptr<Whitener> whitener_;
  Eigen::VectorXd residual_;  // whitened, then priors
  Eigen::MatrixXd jacobian_;  // by unknowns in their scale
  Eigen::MatrixXd normal_;    // its products
  Eigen::LDLT<Eigen::MatrixXd> regular_normal_;
  long simulations_ = 0;
};

}  // namespace strut
