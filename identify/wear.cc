#include "identify/wear.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"
#include "base/math/normal.h"
#include "base/names/corners.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

/// The scale of this name, or nullptr.
const WearScale* find_scale(const std::vector<WearScale>& scales, const std::string& name) {
  const auto found = std::find_if(scales.begin(), scales.end(),
                                  [&](const WearScale& scale) { return scale.name == name; });
  return found == scales.end() ? nullptr : &*found;
}

const ParameterInfo* find_wearing(const std::string& name) {
  const auto& all = list_parameters();
  const auto found = std::find_if(all.begin(), all.end(), [&](const ParameterInfo& p) {
    return p.name == name && !p.wears_at.empty();
  });
  return found == all.end() ? nullptr : &*found;
}

Wear calc_wear(const IdentifiedParameter& p, const WearScale& scale) {
  Wear wear{scale.fresh, 100.0 * (1.0 - p.value / scale.fresh)};
  wear.limit = scale.limit;
  if (!p.in_range) return wear;
  const double half = std::isnan(p.widened_half_width) ? p.half_width : p.widened_half_width;
  wear.half_width = 100.0 * half / scale.fresh;
  if (std::isfinite(half)) {
    const double z = (wear.percent - wear.limit) * kNormal95 / wear.half_width;
    wear.beyond = std::clamp(calc_normal_probability(z), kLeastBeyond, 1.0 - kLeastBeyond);
  }
  return wear;
}

}  // namespace

std::vector<std::string> list_wear_parameters(WearLocations locations) {
  std::vector<std::string> names;
  const auto add_at = [&](const char* location) {
    for (const ParameterInfo& p : list_parameters()) {
      if (p.wears_at == location) names.push_back(p.name);
    }
  };
  if (locations == WearLocations::kByAxle) {
    std::for_each(kAxleNames.begin(), kAxleNames.end(), add_at);
  } else {
    std::for_each(kCornerNames.begin(), kCornerNames.end(), add_at);
  }
  return names;
}

std::vector<WearScale> make_wear_scales(const Case& fresh, const std::vector<std::string>& names) {
  std::vector<WearScale> scales;
  for (const std::string& name : names) {
    const ParameterInfo* parameter = find_wearing(name);
    if (parameter == nullptr) continue;
    const double value = parameter->get(fresh);
    if (value > 0.0) scales.push_back({name, value});
  }
  return scales;
}

void set_wear_limit(std::vector<WearScale>& scales, const std::string& name, double limit) {
  if (!(limit > 0.0 && limit < 100.0)) {
    throw InputError(
        fmt::format("{}: must be above 0 and below 100 % of new", format_number(limit)));
  }
  std::vector<std::string> names;
  bool found = false;
  for (WearScale& scale : scales) {
    names.push_back(scale.name);
    if (!name.empty() && scale.name != name) continue;
    scale.limit = limit;
    found = true;
  }
  if (found) return;
  if (names.empty()) throw InputError("no identified parameter is the rate of a spring or damper");
  throw InputError(fmt::format("'{}' is not among the parts whose wear is identified: {}{}", name,
                               join_names(names), suggest_name(name, names)));
}

void add_wear(IdentifiedRow& row, const std::vector<WearScale>& scales) {
  for (IdentifiedParameter& p : row.parameters) {
    if (const WearScale* scale = find_scale(scales, p.name)) p.wear = calc_wear(p, *scale);
  }
}

void add_wear_change(IdentifiedRow& now, const IdentifiedRow& before) {
  for (std::size_t i = 0; i < now.parameters.size(); ++i) {
    IdentifiedParameter& p = now.parameters[i];
    const std::optional<Wear>& earlier = before.parameters.at(i).wear;
    if (!p.wear || !earlier) continue;
    p.change = {p.wear->percent - earlier->percent,
                std::hypot(p.wear->half_width, earlier->half_width)};
  }
}

}  // namespace strut
