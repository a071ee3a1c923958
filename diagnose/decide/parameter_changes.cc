#include "diagnose/decide/parameter_changes.h"

#include <cmath>
#include <utility>

#include "base/math/normal.h"
#include "diagnose/campaign/campaign_unknowns.h"
#include "diagnose/decide/shared_law.h"

namespace strut {

std::vector<ParameterChange> list_parameter_changes(const CampaignData& data,
                                                    const Diagnosis& diagnosis) {
  std::vector<ParameterChange> changes;
  const Selection& selection = diagnosis.selection;
  const std::vector<GroupValue> group = list_group_values(selection, diagnosis.verdict.positions);
  const WhitenedFit &before = selection.base, &after = selection.extended;
  // A force map shows the residual's form, but not which part of the force looks like a parameter.
  const std::vector<double> form = calc_form_errors(
      after.fit, before.shared_count, selection.is_left ? selection.left.energy : 0.0);
  for (std::size_t i = 0; i < before.shared_count; ++i) {
    const Unknown& u = before.fit.unknowns[i];
    if (is_sensor_tolerance(u)) continue;
    ParameterChange c;
    c.name = u.name;
    c.unit = u.unit;
    c.nominal = get_nominal(data, u);
    const auto fill = [&](const FitResult& fit, double& value, double& low, double& high) {
      const double spread = kNormal95 * fit.widened.sigma[i];
      value = fit.values[i];
      low = value - spread;
      high = value + spread;
      return static_cast<bool>(fit.at_bound[i]);
    };
    c.before_at_bound = fill(before.fit, c.before, c.before_low, c.before_high);
    c.after_at_bound = fill(after.fit, c.after, c.after_low, c.after_high);
    // Half as wide again: the members differ by more than each is uncertain.
    c.differs = group[i].high - group[i].low > 1.5 * (c.after_high - c.after_low);
    const double sigma = after.fit.widened.sigma[i];
    const Interval averaged =
        calc_averaged_interval(c.after, std::hypot(sigma, form[i]), i, selection.undetected);
    if (std::isfinite(sigma)) {
      c.after_low = group[i].low - (c.after_low - averaged.low);
      c.after_high = group[i].high + (averaged.high - c.after_high);
    }
    if (!diagnosis.is_extended()) {
      c.before_low = c.after_low;
      c.before_high = c.after_high;
    }
    changes.push_back(std::move(c));
  }
  return changes;
}

}  // namespace strut
