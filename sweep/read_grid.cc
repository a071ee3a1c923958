#include "sweep/read_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "base/text/range.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

/// Tolerance between `to` and the last level, in steps: decimal fractions are not exact.
constexpr double kLevelSlack = 1e-6;
constexpr double kMaxLevels = 9e15;  // a double counts integers exactly up to about this

InputError unreached_error(const Table& table, const Axis& axis, double steps) {
  const double below = axis.from + std::floor(steps) * axis.step;
  const double above = axis.from + std::ceil(steps) * axis.step;
  return table.error("to", fmt::format("not reached by steps of {} from {}; nearest: {} or {}",
                                       format_number(axis.step), format_number(axis.from),
                                       format_number(below), format_number(above)));
}

/// Reads `step`, which must lead from `from` to `to`.
void read_step(const Table& table, double to, const Range& allowed, Axis& axis) {
  axis.step = table.number("step", any_number(allowed.unit));
  const char* const allowed_step = to == axis.from ? "not 0" : to > axis.from ? "> 0" : "< 0";
  if (axis.step == 0.0 || (to != axis.from && (axis.step > 0.0) != (to > axis.from))) {
    throw table.error("step", fmt::format("must be {} to lead from {} to {}", allowed_step,
                                          format_number(axis.from), format_number(to)));
  }
  const double steps = (to - axis.from) / axis.step;
  if (steps > kMaxLevels) {
    throw table.error("step", fmt::format("too small: more than {:g} levels", kMaxLevels));
  }
  if (std::fabs(steps - std::round(steps)) > kLevelSlack) {
    throw unreached_error(table, axis, steps);
  }
  axis.count = static_cast<std::int64_t>(std::round(steps)) + 1;
}

void read_count(const Table& table, double to, Axis& axis) {
  const bool single = to == axis.from;
  axis.count =
      table.integer("count", single ? 1 : 2, single ? 1 : static_cast<std::int64_t>(kMaxLevels));
  if (axis.count > 1) axis.step = (to - axis.from) / static_cast<double>(axis.count - 1);
}

/// Reads an axis; `levels`: whether it needs levels (grid), or only its bounds (samples).
Axis read_bounds(const Table& table, const std::string& name, bool levels) {
  const Range& allowed = find_parameter(name).allowed;
  Axis axis{.name = name, .from = table.number("from", allowed)};
  const double to = table.number("to", allowed);
  const bool has_step = table.has("step"), has_count = table.has("count");
  if (has_step && has_count) throw table.error("count", "must not be given together with 'step'");
  if (has_count) read_count(table, to, axis);
  try {
    if (!has_count && (has_step || levels)) read_step(table, to, allowed, axis);
  } catch (const InputError& e) {
    if (has_step) throw;
    throw InputError(std::string(e.what()) + "; give 'step' or 'count'");
  }
  if (!levels) {
    axis.step = to - axis.from;
    axis.count = 2;
  }
  return axis;
}

Axis read_axis(const Table& grid, const std::string& name, bool levels, Case probe) {
  std::vector<std::string> names;
  names.reserve(list_parameters().size());
  for (const ParameterInfo& parameter : list_parameters()) names.push_back(parameter.name);
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw grid.error(name, fmt::format("unknown parameter{}; parameters: {}",
                                       suggest_name(name, names), join_names(names)));
  }
  Axis axis = read_bounds(grid.table(name), name, levels);
  try {
    set_parameter(probe, name, axis.from);
  } catch (const InputError& e) {
    throw grid.error(name, e.what());
  }
  return axis;
}

/// Throws if two axes set the same quantity, as front_stiffness and front_left_stiffness do.
void check_independence(const Table& grid, const std::vector<Axis>& axes, const Case& base) {
  for (const Axis& first : axes) {
    for (const Axis& second : axes) {
      if (&first == &second) continue;
      if (!share_quantity(find_parameter(first.name), find_parameter(second.name), base)) continue;
      throw grid.error(
          second.name,
          fmt::format("sets the same quantity as the axis '{}'; allowed: one of the two",
                      first.name));
    }
  }
}

}  // namespace

bool share_quantity(const ParameterInfo& first, const ParameterInfo& second, Case c) {
  const double before = first.get(c);
  second.set(c, second.get(c) + 1.0);
  return first.get(c) != before;
}

Grid read_grid(const Table& table, SampleMethod method, const Case& base) {
  const bool levels = method == SampleMethod::kGrid;
  std::vector<Axis> axes;
  for (const std::string& name : table.keys()) {
    axes.push_back(read_axis(table, name, levels, base));
  }
  if (axes.empty()) {
    throw table.error(
        "no axis; needs at least one, for example front_stiffness = { from = 40000, to = 35500, "
        "step = -500 }");
  }
  check_independence(table, axes, base);
  try {
    return Grid(std::move(axes));
  } catch (const InputError& e) {
    throw table.error(e.what());
  }
}

}  // namespace strut
