#include "diagnose/decide/extended_unknowns.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace strut {

ExtendedUnknowns extend(const CampaignData& data, const WhitenedFit& base, const Hypothesis& h,
                        const std::vector<double>& base_values,
                        const std::vector<double>& parameters) {
  constexpr double kPinned = 1e-6;  // of what is removed
  ExtendedUnknowns e;
  const auto shared = static_cast<std::ptrdiff_t>(base.shared_count);
  e.unknowns.assign(base.fit.unknowns.begin(), base.fit.unknowns.begin() + shared);
  e.values.assign(base_values.begin(), base_values.begin() + shared);
  std::vector<Unknown> own = make_unknowns(data, h);
  const auto of_effect = list_effect_parameters(*find_effect(h.effect), data.model());
  for (std::size_t i = 0; i < own.size(); ++i) {
    Unknown& u = own[i];
    // Steps and sizes are counted in what was found.
    if (parameters[i] != 0.0) u.scale = std::abs(parameters[i]);
    if (h.change == EffectChange::kRemoved) {
      u.scale = std::abs(h.reference[i] - parameters[i]);
      u.prior = {parameters[i], kPinned * u.scale};
    } else if (!h.parameters[i].switches) {
      const double ordinary = std::max(std::abs(parameters[i]), std::abs(of_effect[i]->typical));
      u.prior = {parameters[i], std::max(ordinary, 1e-12)};
    }
    e.unknowns.push_back(std::move(u));
    e.values.push_back(parameters[i]);
  }
  e.shared_count = e.unknowns.size();
  e.unknowns.insert(e.unknowns.end(), base.fit.unknowns.begin() + shared, base.fit.unknowns.end());
  e.values.insert(e.values.end(), base_values.begin() + shared, base_values.end());
  return e;
}

ExtendedUnknowns remove(const WhitenedFit& fit, const Hypothesis& h) {
  ExtendedUnknowns e;
  for (std::size_t i = 0; i < fit.fit.unknowns.size(); ++i) {
    const auto is_own = [&](const HypothesisParameter& p) {
      return p.name == fit.fit.unknowns[i].name;
    };
    if (std::any_of(h.parameters.begin(), h.parameters.end(), is_own)) continue;
    e.unknowns.push_back(fit.fit.unknowns[i]);
    e.values.push_back(fit.fit.values[i]);
    if (i < fit.shared_count) ++e.shared_count;
  }
  return e;
}

}  // namespace strut
