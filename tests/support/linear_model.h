// Readings that are linear in the unknowns, so that every fit to them is a linear system.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "estimate/reading_model.h"

namespace strut::test {

/// One run of one channel: residual = offset + matrix * values, then the priors.
class LinearModel : public ReadingModel {
 public:
  LinearModel(std::vector<Unknown> unknowns, Eigen::MatrixXd matrix, Eigen::VectorXd offset)
      : ReadingModel(std::move(unknowns)), matrix_(std::move(matrix)), offset_(std::move(offset)) {
    channels_ = {{0}};
    const auto count = static_cast<std::size_t>(offset_.size());
    for (std::size_t t = 0; t < count; ++t) readings_.push_back({0, t, 0});
    for (const Unknown& u : unknowns_) prior_count_ += u.prior.informs() ? 1 : 0;
  }

  Linearization linearize(const std::vector<double>& values) override {
    Linearization at{"", calc_residual(values), Eigen::MatrixXd::Zero(row_count(), matrix_.cols())};
    at.jacobian.topRows(matrix_.rows()) = matrix_;
    for (Eigen::Index i = 0; i < matrix_.cols(); ++i) {
      at.jacobian.col(i) *= unknowns_[static_cast<std::size_t>(i)].scale;
    }
    fill_priors(values, at);
    return at;
  }
  bool has_independent_residuals() const override { return true; }
  using ReadingModel::evaluate;
  std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) override {
    std::vector<Evaluation> evaluations;
    evaluations.reserve(points.size());
    for (const std::vector<double>& p : points) evaluations.push_back({"", calc_residual(p)});
    return evaluations;
  }

 private:
  Eigen::VectorXd calc_residual(const std::vector<double>& values) const {
    Eigen::VectorXd residual(row_count());
    residual.head(offset_.size()) =
        offset_ + matrix_ * Eigen::Map<const Eigen::VectorXd>(values.data(), matrix_.cols());
    fill_prior_residuals(values, residual);
    return residual;
  }

  Eigen::MatrixXd matrix_;
  Eigen::VectorXd offset_;
};

/// An unknown between -100 and 100.
inline Unknown make_plain_unknown(const std::string& name, double scale = 1.0) {
  Unknown u;
  u.name = name;
  u.scale = scale;
  u.low = -100.0;
  u.high = 100.0;
  return u;
}

}  // namespace strut::test
