#include "diagnose/chord_search.h"

#include <algorithm>
#include <utility>

#include "diagnose/fit.h"
#include "io/input_error.h"
#include "sweep/fisher.h"

namespace strut {

ChordSearch::ChordSearch(ReadingModel& model, std::vector<double> values)
    : model_(model), values_(std::move(values)) {
  renew();
}

void ChordSearch::renew() {
  Linearization at = model_.linearize(values_);
  if (!at.failure.empty()) {
    throw InputError(at.failure + "; the fit starts there: start it elsewhere");
  }
  residual_ = at.residual;
  taken_at_ = values_;
  at_ = std::make_shared<const Linearization>(std::move(at));
}

std::vector<bool> ChordSearch::list_at_bound() const {
  std::vector<bool> at_bound;
  at_bound.reserve(values_.size());
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const Unknown& u = model_.unknowns()[i];
    at_bound.push_back(values_[i] <= u.low || values_[i] >= u.high);
  }
  return at_bound;
}

std::vector<bool> ChordSearch::list_held(const Eigen::VectorXd& gradient) const {
  std::vector<bool> held = list_at_bound();
  for (std::size_t i = 0; i < held.size(); ++i) {
    const double slope = gradient(static_cast<Eigen::Index>(i));
    const bool is_low = values_[i] <= model_.unknowns()[i].low;
    held[i] = held[i] && (is_low ? slope > 0.0 : slope < 0.0);
  }
  return held;
}

void ChordSearch::search(const Whitener& whitener) {
  constexpr int kMostSteps = 40, kMostRenewals = 8;
  constexpr double kNear = 0.1 * kFitTolerance, kEnough = 0.25;
  const WhitenedModel whitened(model_, whitener);
  Linearization at;
  NormalEquations normal;
  const auto weigh = [&] {
    at.residual = whitener.apply(residual_);
    at.jacobian = whitener.apply(at_->jacobian);
    normal = calc_normal_equations(whitened, at);
  };
  weigh();
  int renewals = 0;
  for (int step = 0; step < kMostSteps; ++step, ++steps_) {
    normal.gradient.noalias() = at.jacobian.transpose() * at.residual;
    const NormalEquations free = free_unknowns(normal, list_held(normal.gradient));
    const Eigen::VectorXd change = invert_information(free.information).covariance * free.gradient;
    const double promised = free.gradient.dot(change);
    const double widening = calc_widening(whitened, at);
    if (promised < kNear * kNear * widening * widening) return;
    const double chi2 = at.residual.squaredNorm();
    double gained = 0.0;
    for (const double share : {1.0, 0.25, 0.05}) {
      std::vector<double> tried = values_;
      for (std::size_t i = 0; i < tried.size(); ++i) {
        const Unknown& u = model_.unknowns()[i];
        tried[i] = std::clamp(tried[i] - share * u.scale * change(static_cast<Eigen::Index>(i)),
                              u.low, u.high);
      }
      Evaluation there = model_.evaluate(tried);
      if (!there.failure.empty()) continue;
      Eigen::VectorXd residual = whitener.apply(there.residual);
      gained = chi2 - residual.squaredNorm();
      if (!(gained > 0.0)) continue;
      values_ = std::move(tried);
      residual_ = std::move(there.residual);
      at.residual = std::move(residual);
      break;
    }
    if (gained >= kEnough * promised) continue;
    // Derivatives of here that do not lead on are those of a kink.
    if (values_ == taken_at_ || renewals == kMostRenewals) return;
    renew();
    weigh();
    ++renewals;
  }
}

}  // namespace strut
