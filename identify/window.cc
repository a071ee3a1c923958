#include "identify/window.h"

#include <cmath>

#include "base/math/normal.h"
#include "train/data/shift.h"
#include "train/model/interval.h"

namespace strut {
namespace {

std::vector<OutsideChannel> list_outside(const TrainedModel& model, const MeasuredRecord& record,
                                         const WindowReading& reading,
                                         const std::vector<double>& components) {
  const WindowTransform& window = *model.window;
  std::vector<OutsideChannel> outside;
  const auto check = [&](const std::string& name, const std::string& unit, double value, double low,
                         double high, double margin) {
    if (value >= low - margin && value <= high + margin) return;
    outside.push_back({name, unit, value, low, high, calc_excess(value, low, high)});
  };
  if (!reading.alignment.found) {
    const double begin = record.begin + reading.alignment.begin * window.grid.interval;
    outside.push_back({"alignment", "s", begin, std::nan(""), std::nan(""), 0.0});
    return outside;  // the components of a misaligned window are meaningless
  }
  check("leftover", "1", reading.residual, 0.0, calc_residual_limit(window), 0.0);
  for (std::size_t k = 0; k < components.size(); ++k) {
    check(model.inputs[k].name, model.inputs[k].unit, components[k], model.input_map.low()[k],
          model.input_map.high()[k], kNormal95);
  }
  return outside;
}

}  // namespace

IdentifiedRow identify_record(const TrainedModel& model, const Identifier& identifier,
                              const MeasuredRecord& record, bool extrapolate) {
  std::vector<double> components(model.inputs.size());
  const WindowReading reading =
      read_components(*model.window, {record.values, record.samples}, components);
  IdentifiedRow row;
  row.outside = list_outside(model, record, reading, components);
  const bool inside = row.outside.empty();
  const std::size_t m = model.targets.size();
  std::vector<double> values(m, std::nan(""));
  if (inside || extrapolate) identifier.identify(components.data(), values.data());
  row.parameters.reserve(m);
  for (std::size_t t = 0; t < m; ++t) {
    IdentifiedParameter p{model.targets[t].name, model.targets[t].unit, values[t]};
    if (inside) p.half_width = model.ci95[t];
    p.in_range = inside && is_parameter_in_range(model, t, p.value, model.ci95[t]);
    row.parameters.push_back(std::move(p));
  }
  return row;
}

}  // namespace strut
