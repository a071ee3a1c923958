#include "diagnose/noise/chord_search.h"

#include <algorithm>
#include <utility>

#include "base/error/input_error.h"
#include "estimate/fisher.h"
#include "estimate/fit.h"

namespace strut {

ChordSearch::ChordSearch(ReadingModel& model, std::vector<double> values)
    : model_(model), values_(std::move(values)) {
  renew();
}

void ChordSearch::renew() {
  if (at_ != nullptr && taken_at_ == values_) return;
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

std::optional<double> ChordSearch::step(const Whitener& whitener, const Eigen::VectorXd& change,
                                        Linearization& at) {
  std::vector<double> tried = values_;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    const Unknown& u = model_.unknowns()[i];
    tried[i] = std::clamp(tried[i] - u.scale * change(static_cast<Eigen::Index>(i)), u.low, u.high);
  }
  Evaluation there = model_.evaluate(tried);
  if (!there.failure.empty()) return std::nullopt;
  Eigen::VectorXd residual = whitener.apply_residual(there.residual);
  const double gained = at.residual.squaredNorm() - residual.squaredNorm();
  if (!(gained > 0.0)) return 0.0;
  values_ = std::move(tried);
  residual_ = std::move(there.residual);
  at.residual = std::move(residual);
  return gained;
}

void ChordSearch::search(const Whitener& whitener) {
  constexpr int kMostSteps = 40, kMostRenewals = 8;
  constexpr double kNear = 0.1 * kFitTolerance, kEnough = 0.25;
  const WhitenedModel whitened(model_, whitener);
  Linearization at;
  NormalEquations normal;
  const auto weigh = [&] {
    at.residual = whitener.apply_residual(residual_);
    at.jacobian = whitener.apply(at_->jacobian);
    normal = calc_normal_equations(whitened, at);
  };
  weigh();
  at_kink_ = false;
  int renewals = 0;
  for (int i = 0; i < kMostSteps; ++i, ++steps_) {
    normal.gradient.noalias() = at.jacobian.transpose() * at.residual;
    const NormalEquations free = free_unknowns(normal, list_held(normal.gradient));
    const Eigen::VectorXd change = invert_information(free.information).covariance * free.gradient;
    const double promised = free.gradient.dot(change);
    const double widening = calc_widening(whitened, at);
    if (promised < kNear * kNear * widening * widening) return;
    double gained = 0.0;
    bool all_simulated = true;
    for (const double share : {1.0, 0.25, 0.05}) {
      const std::optional<double> gain = step(whitener, share * change, at);
      all_simulated = all_simulated && gain;
      gained = gain.value_or(0.0);
      if (gained > 0.0) break;
    }
    if (gained >= kEnough * promised) continue;
    // Derivatives of here that do not lead on are those of a kink; steps turned to where chi2 falls
    // most gain a hundredth of what is promised, over and over (measured).
    const bool is_stuck = values_ == taken_at_;
    at_kink_ = is_stuck && all_simulated;
    if (is_stuck || renewals == kMostRenewals) return;
    renew();
    weigh();
    ++renewals;
  }
}

}  // namespace strut
