// The model of a campaign prepared for testing hypotheses: a fitted baseline, and the whitened
// residuals and derivatives there.
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
  /// Linearizes about a fit. `data` must outlive it. Throws InputError where the model cannot be
  /// simulated there.
  TestBench(const CampaignData& data, const WhitenedFit& fit, int threads);

  /// Changes of the whitened readings at the starts of the hypotheses, one column per switching
  /// parameter; 0 where they cannot be simulated. Appends the columns of each start to `trials`.
  Eigen::MatrixXd simulate_columns(const std::vector<Hypothesis>& hypotheses,
                                   std::vector<HypothesisTrial>& trials);

  /// Changes of the whitened readings at values of further unknowns that all runs share, one column
  /// per point; 0 where it cannot be simulated. The unknowns have no priors.
  Eigen::MatrixXd simulate_columns(const std::vector<Unknown>& added,
                                   const std::vector<std::vector<double>>& points);

  /// Simulates the starts of the hypotheses and gathers their products.
  Evidence gather(const std::vector<Hypothesis>& hypotheses);

  /// Fits a hypothesis (search_hypothesis). Several fits may run at once.
  HypothesisFit fit(const Hypothesis& hypothesis, const std::vector<double>& beginning,
                    const SearchEffort& effort = {}, const std::vector<double>& from = {},
                    int threads = 1) const;

  const Whitener& whitener() const { return *whitener_; }
  const Eigen::VectorXd& residual() const { return residual_; }
  /// Derivatives of the residual with respect to the unknowns, in units of their scale.
  const Eigen::MatrixXd& jacobian() const { return jacobian_; }
  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  const std::vector<double>& values() const { return values_; }
  std::size_t shared_count() const { return shared_count_; }
  long simulation_count() const { return simulations_; }
  std::size_t run_count() const { return runs_.size(); }
  /// Index in the campaign of the bench's run `number`.
  std::size_t get_run(std::size_t number) const { return runs_[number]; }

 private:
  Eigen::VectorXd combine_own_columns(const Hypothesis& h, double gain) const;
  std::unique_ptr<ReadingModel> make_model(const std::vector<Unknown>& added, int threads) const;

  const CampaignData& data_;
  std::vector<std::size_t> runs_;
  LatentRoads roads_;
  std::vector<Unknown> unknowns_;
  std::vector<double> values_;
  std::size_t shared_count_;
  EffectSettings effects_on_;  // of the fit
  int threads_;
  std::unique_ptr<Whitener> whitener_;
  Eigen::VectorXd readings_;  // residual of readings, then priors
  Eigen::VectorXd residual_;  // whitened, then priors
  Eigen::MatrixXd jacobian_;  // by unknowns in their scale
  Eigen::MatrixXd normal_;    // J'J
  Eigen::LDLT<Eigen::MatrixXd> regular_normal_;
  long simulations_ = 0;
};

}  // namespace strut
