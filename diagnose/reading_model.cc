#include "diagnose/reading_model.h"

#include <algorithm>

#include "io/input_error.h"

namespace strut {

void ReadingModel::fill_priors(const std::vector<double>& values, Linearization& out) const {
  auto row = static_cast<Eigen::Index>(reading_count());
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const Prior& prior = unknowns_[i].prior;
    if (!prior.informs()) continue;
    out.residual(row) = (values[i] - prior.mean) / prior.sigma;
    out.jacobian(row, static_cast<Eigen::Index>(i)) = unknowns_[i].scale / prior.sigma;
    ++row;
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

}  // namespace strut
