#include "estimate/reading_model.h"

#include <algorithm>

#include "base/error/input_error.h"

namespace strut {

void ReadingModel::fill_prior_residuals(const std::vector<double>& values,
                                        Eigen::VectorXd& residual) const {
  auto row = static_cast<Eigen::Index>(reading_count());
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const Prior& prior = unknowns_[i].prior;
    if (prior.informs()) residual(row++) = (values[i] - prior.mean) / prior.sigma;
  }
}

void ReadingModel::fill_priors(const std::vector<double>& values, Linearization& out) const {
  fill_prior_residuals(values, out.residual);
  auto row = static_cast<Eigen::Index>(reading_count());
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const Unknown& u = unknowns_[i];
    if (!u.prior.informs()) continue;
    out.jacobian(row++, static_cast<Eigen::Index>(i)) = u.scale / u.prior.sigma;
  }
}

void ReadingModel::finish(const std::string& name) {
  prior_count_ = static_cast<std::size_t>(std::count_if(
      unknowns_.begin(), unknowns_.end(), [](const Unknown& u) { return u.prior.informs(); }));
  if (reading_count() + prior_count_ >= unknowns_.size()) return;
  throw InputError(name + ": " + std::to_string(reading_count()) +
                   " readings within the simulated time, too few for " +
                   std::to_string(unknowns_.size()) + " unknowns");
}

namespace {

/// Rows of readings of one run, and the unknowns that meet them.
struct RunBlock {
  Eigen::Index begin = 0, count = 0;
  std::vector<Eigen::Index> unknowns;
};

std::vector<RunBlock> list_blocks(const ReadingModel& model) {
  std::vector<RunBlock> blocks;
  const std::vector<ReadingPlace>& readings = model.readings();
  for (std::size_t k = 0; k < readings.size();) {
    RunBlock block;
    const std::size_t run = readings[k].run;
    block.begin = static_cast<Eigen::Index>(k);
    while (k < readings.size() && readings[k].run == run) ++k;
    block.count = static_cast<Eigen::Index>(k) - block.begin;
    for (std::size_t i = 0; i < model.unknowns().size(); ++i) {
      const int of = model.unknowns()[i].run;
      if (of == kEveryRun || of == static_cast<int>(run)) {
        block.unknowns.push_back(static_cast<Eigen::Index>(i));
      }
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

Eigen::MatrixXd get_block(const Eigen::MatrixXd& jacobian, const RunBlock& block) {
  Eigen::MatrixXd part(block.count, static_cast<Eigen::Index>(block.unknowns.size()));
  for (Eigen::Index i = 0; i < part.cols(); ++i) {
    part.col(i) =
        jacobian.col(block.unknowns[static_cast<std::size_t>(i)]).segment(block.begin, block.count);
  }
  return part;
}

}  // namespace

NormalEquations calc_normal_equations(const ReadingModel& model, const Linearization& at) {
  const auto readings = static_cast<Eigen::Index>(model.reading_count());
  const auto priors = at.jacobian.bottomRows(at.jacobian.rows() - readings);
  NormalEquations normal;
  normal.of_priors = priors.transpose() * priors;
  normal.information = normal.of_priors;
  normal.gradient = priors.transpose() * at.residual.tail(priors.rows());
  for (const RunBlock& block : list_blocks(model)) {
    const Eigen::MatrixXd part = get_block(at.jacobian, block);
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(part.cols(), part.cols());
    products.selfadjointView<Eigen::Lower>().rankUpdate(part.transpose());
    products = Eigen::MatrixXd(products.selfadjointView<Eigen::Lower>());
    normal.information(block.unknowns, block.unknowns) += products;
    normal.gradient(block.unknowns) +=
        part.transpose() * at.residual.segment(block.begin, block.count);
  }
  return normal;
}

}  // namespace strut
