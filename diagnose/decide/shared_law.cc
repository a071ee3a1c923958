#include "diagnose/decide/shared_law.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/math/normal.h"

namespace strut {
namespace {

const Candidate* find_candidate(const SelectRound& round, const Cause& cause) {
  for (const Candidate& c : round.candidates) {
    const Hypothesis& h = c.hypothesis;
    if (h.effect == cause.effect && h.place == cause.place && h.change == cause.change) return &c;
  }
  return nullptr;
}

/// The chosen candidate of a position and the other close ones, as fitted in one round.
struct Members {
  const Candidate* chosen = nullptr;
  std::vector<const Candidate*> others;
};

std::vector<Members> list_members(const Selection& selection,
                                  const std::vector<CausePosition>& positions) {
  std::vector<Members> list;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const SelectRound& round = selection.rounds[selection.round_of[i]];
    Members members{find_candidate(round, positions[i].get_cause()), {}};
    for (std::size_t k = 0; k < positions[i].close; ++k) {
      const Candidate* c = find_candidate(round, positions[i].candidates[k]);
      if (k != positions[i].chosen && c != nullptr) members.others.push_back(c);
    }
    if (members.chosen != nullptr) list.push_back(std::move(members));
  }
  return list;
}

void widen(GroupValue& value, double shift, double error) {
  value.low = std::min(value.low, value.value + shift - error);
  value.high = std::max(value.high, value.value + shift + error);
}

/// Motion and force of the strut at one place, all runs in sequence.
struct StrutMotionForce {
  std::string place;
  std::vector<double> deflection, velocity, force;
  bool has_spring = false;
};

void add_motion(const StrutInfo& strut, const RunCurves& curves, StrutMotionForce& motion) {
  const std::vector<double> d = calc_sum(strut.deflection, curves.channel);
  const std::vector<double> v = calc_sum(strut.velocity, curves.channel);
  const auto& spring = curves.channel[static_cast<std::size_t>(strut.spring_force)];
  const auto& damper = curves.channel[static_cast<std::size_t>(strut.damper_force)];
  for (std::size_t t = 0; t < d.size(); ++t) {
    const double force = spring[t] + damper[t];
    if (!std::isfinite(d[t]) || !std::isfinite(v[t]) || !std::isfinite(force)) continue;
    motion.deflection.push_back(d[t]);
    motion.velocity.push_back(v[t]);
    motion.force.push_back(force);
    motion.has_spring = motion.has_spring || spring[t] != 0.0;
  }
}

/// By place, in the order of ModelInfo::struts.
std::vector<std::pair<std::string, Slopes>> calc_secants(const CampaignData& data,
                                                         const std::vector<std::size_t>& runs,
                                                         const SharedValues& shared) {
  std::vector<StrutMotionForce> motions;
  for (const std::size_t r : runs) {
    const RunCurves curves = simulate_motion(data.runs[r], shared.unknowns, shared.values);
    if (!curves.failure.empty()) continue;
    for (const StrutInfo& strut : data.model().struts) {
      auto found = std::find_if(motions.begin(), motions.end(),
                                [&](const StrutMotionForce& m) { return m.place == strut.place; });
      if (found == motions.end()) found = motions.insert(found, {strut.place, {}, {}, {}});
      add_motion(strut, curves, *found);
    }
  }
  std::vector<std::pair<std::string, Slopes>> secants;
  secants.reserve(motions.size());
  for (const StrutMotionForce& m : motions) {
    Slopes slopes = fit_slopes(m.deflection, m.velocity, m.force);
    if (!m.has_spring) slopes.stiffness = std::numeric_limits<double>::quiet_NaN();
    secants.emplace_back(m.place, slopes);
  }
  return secants;
}

/// 1.96 standard errors of the calibrated model's parameter, 0 where it is not fitted.
double find_error(const WhitenedFit& base, const std::string& name) {
  for (std::size_t i = 0; i < base.shared_count; ++i) {
    if (base.fit.unknowns[i].name == name) return kNormal95 * base.fit.widened.sigma[i];
  }
  return 0.0;
}

}  // namespace

Slopes fit_slopes(const std::vector<double>& deflection, const std::vector<double>& velocity,
                  const std::vector<double>& force) {
  const auto n = static_cast<Eigen::Index>(force.size());
  if (n < 3) return {};
  Eigen::MatrixXd a(n, 3);
  a.col(0).setOnes();
  a.col(1) = Eigen::Map<const Eigen::VectorXd>(deflection.data(), n);
  a.col(2) = Eigen::Map<const Eigen::VectorXd>(velocity.data(), n);
  const Eigen::VectorXd slopes =
      a.completeOrthogonalDecomposition().solve(Eigen::Map<const Eigen::VectorXd>(force.data(), n));
  return {slopes(1), slopes(2)};
}

std::vector<GroupValue> list_group_values(const Selection& selection,
                                          const std::vector<CausePosition>& positions) {
  const WhitenedFit& extended = selection.extended;
  std::vector<GroupValue> values(selection.base.shared_count);
  const std::vector<Members> members = list_members(selection, positions);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double error = kNormal95 * extended.fit.widened.sigma[i], at = extended.fit.values[i];
    values[i] = {at, at - error, at + error};
    for (const Members& m : members) {
      for (const Candidate* other : m.others) {
        widen(values[i], other->base_values[i] - m.chosen->base_values[i], error);
      }
    }
  }
  return values;
}

std::vector<StrutSecant> list_secants(const CampaignData& data, const Selection& selection,
                                      const std::vector<CausePosition>& positions) {
  const std::vector<std::size_t>& runs = selection.base.runs;
  std::vector<StrutSecant> secants;
  for (const auto& [place, slopes] : calc_secants(data, runs, selection.extended.shared())) {
    const std::string head = place.empty() ? "" : place + "_";
    StrutSecant s{place, {slopes.stiffness, 0.0, 0.0}, {slopes.damping, 0.0, 0.0}};
    s.stiffness.low = s.stiffness.high = slopes.stiffness;
    s.damping.low = s.damping.high = slopes.damping;
    widen(s.stiffness, 0.0, find_error(selection.base, head + "stiffness"));
    widen(s.damping, 0.0, find_error(selection.base, head + "damping"));
    secants.push_back(std::move(s));
  }
  for (const Members& m : list_members(selection, positions)) {
    if (m.others.empty()) continue;
    const auto chosen = calc_secants(data, runs, m.chosen->shared);
    for (const Candidate* other : m.others) {
      const auto found = calc_secants(data, runs, other->shared);
      for (std::size_t i = 0; i < std::min(found.size(), secants.size()); ++i) {
        const std::string head = secants[i].place.empty() ? "" : secants[i].place + "_";
        widen(secants[i].stiffness, found[i].second.stiffness - chosen[i].second.stiffness,
              find_error(selection.base, head + "stiffness"));
        widen(secants[i].damping, found[i].second.damping - chosen[i].second.damping,
              find_error(selection.base, head + "damping"));
      }
    }
  }
  return secants;
}

}  // namespace strut
