#include "identify/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/error/input_error.h"
#include "base/math/normal.h"
#include "base/text/nearest_name.h"
#include "estimate/nuisances.h"

namespace strut {

std::vector<Unknown> make_free_unknowns(const std::vector<MeasuredRun>& runs,
                                        const std::vector<std::string>& names) {
  std::vector<Unknown> unknowns;
  for (const std::string& name : names) {
    if (name != kSpeedName) {
      unknowns.push_back(make_parameter(runs, name));
      continue;
    }
    for (std::size_t run = 0; run < runs.size(); ++run) {
      unknowns.push_back(make_parameter(runs, name, static_cast<int>(run)));
    }
  }
  check_unknowns(unknowns, runs.size());
  return unknowns;
}

void set_prior(const ModelInfo& model, const std::string& name, const Prior& prior,
               std::vector<Unknown>& unknowns) {
  std::vector<std::string> names;
  bool found = false;
  for (Unknown& u : unknowns) {
    names.push_back(u.name);
    if (u.name != name) continue;
    found = true;
    if (u.kind == UnknownKind::kHitTime) {
      u = make_hit_time(u.run, prior);
    } else if (u.kind == UnknownKind::kBias) {
      u = make_bias(model, u.run, u.channel, prior);
    } else {
      u.prior = prior;
      u.start = std::clamp(prior.mean, u.low, u.high);
    }
  }
  if (found) return;
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  throw InputError(fmt::format("'{}' is not free; free: {}{}", name, join_names(names),
                               suggest_name(name, names)));
}

void add_nuisance(const std::vector<MeasuredRun>& runs, const std::string& name, const Prior& prior,
                  std::vector<Unknown>& unknowns) {
  if (!is_among(unknowns, name)) {
    for (Unknown& u : make_free_unknowns(runs, {name})) {
      u.scale = prior.sigma;
      unknowns.push_back(std::move(u));
    }
  }
  set_prior(runs.front().setup.info(), name, prior, unknowns);
}

IdentifiedParameter make_estimate(const FitResult& fit, std::size_t i) {
  IdentifiedParameter p;
  p.name = fit.unknowns[i].name;
  p.unit = fit.unknowns[i].unit;
  p.value = fit.values[i];
  const bool known = fit.uncertainty.identifiable[i];
  p.half_width =
      known ? kNormal95 * fit.uncertainty.sigma[i] : std::numeric_limits<double>::infinity();
  p.widened_half_width = known ? kNormal95 * fit.widened.sigma[i] : p.half_width;
  p.in_range = known && !fit.at_bound[i];
  return p;
}

IdentifiedRow make_fit_row(const FitResult& fit, std::size_t parameter_count) {
  IdentifiedRow row;
  row.parameters.reserve(parameter_count);
  for (std::size_t i = 0; i < parameter_count; ++i) row.parameters.push_back(make_estimate(fit, i));
  return row;
}

}  // namespace strut
