#include "jobs/diagnose/force_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/math/spread.h"
#include "jobs/compare/curves.h"
#include "report/html.h"

namespace strut {
namespace {

using Values = std::vector<double>;

/// Evenly spaced points from the minimum to the maximum of `values`.
Values list_even(const Values& values, std::size_t count) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  Values points;
  for (std::size_t i = 0; i < count; ++i) {
    const double theta = static_cast<double>(i) / static_cast<double>(count - 1);
    points.push_back(*low + theta * (*high - *low));
  }
  return points;
}

double get_step(const Values& even) { return even[1] - even[0]; }

/// Number of samples within half a step of a point.
double count_around(const VisitedStates& states, double deflection, double deflection_step,
                    double velocity, double velocity_step) {
  double count = 0.0;
  for (std::size_t i = 0; i < states.velocity.size(); ++i) {
    const bool near = std::abs(states.deflection[i] - deflection) <= 0.5 * deflection_step &&
                      std::abs(states.velocity[i] - velocity) <= 0.5 * velocity_step;
    if (near) ++count;
  }
  return count;
}

/// Quantiles of 10, 50 and 90 %.
std::array<double, 3> list_cuts(const Values& values) {
  return {calc_quantile(values, 0.1), calc_quantile(values, 0.5), calc_quantile(values, 0.9)};
}

/// Curves over one variable at three values of the other; NaN away from visited states.
ChartPanel make_cuts(const UnknownForce& force, bool over_velocity) {
  constexpr std::size_t kPoints = 61, kCoarse = 9;
  const VisitedStates& s = force.states;
  const Values& along = over_velocity ? s.velocity : s.deflection;
  const Values& across = over_velocity ? s.deflection : s.velocity;
  const double width = get_step(list_even(across, kCoarse));
  const Values points = list_even(along, kPoints);
  ChartPanel panel{{over_velocity ? "velocity [m/s]" : "deflection [m]"}, {"force [N]"}, {}};
  for (const double cut : list_cuts(across)) {
    ChartSeries line{fmt::format("at {} {}", format_short(cut), over_velocity ? "m" : "m/s"),
                     SeriesKind::kLine, static_cast<int>(panel.series.size()) + 1, points};
    for (const double x : points) {
      const double d = over_velocity ? cut : x, v = over_velocity ? x : cut;
      const double step = 2.0 * get_step(points);
      const bool visited = over_velocity ? count_around(s, d, width, v, step) > 0.0
                                         : count_around(s, d, step, v, width) > 0.0;
      line.y.push_back(visited ? calc_force(force.map, d, v)
                               : std::numeric_limits<double>::quiet_NaN());
    }
    panel.series.push_back(std::move(line));
  }
  return panel;
}

}  // namespace

Chart make_force_map_chart(const UnknownForce& force) {
  ChartSeries visited{"", SeriesKind::kPoints, 5};
  const std::size_t stride = choose_stride(force.states.velocity.size());
  for (std::size_t i = 0; i < force.states.velocity.size(); i += stride) {
    visited.x.push_back(force.states.velocity[i]);
    visited.y.push_back(force.states.deflection[i]);
  }
  Chart chart{"force_map",
              {make_cuts(force, true),
               make_cuts(force, false),
               {{"velocity [m/s]"}, {"deflection [m]"}, {visited}}},
              3};
  chart.panel_height = 400;
  chart.caption = fmt::format(
      "Force map of the {}, beside its spring and damper: over velocity and over "
      "deflection, within the states visited in the runs for fitting; and those states.",
      force.states.describe());
  return chart;
}

std::vector<CsvColumn> make_force_map_columns(const UnknownForce& force, const WhitenedFit& fit) {
  constexpr std::size_t kDeflections = 15, kVelocities = 41;
  const Values deflections = list_even(force.states.deflection, kDeflections);
  const Values velocities = list_even(force.states.velocity, kVelocities);
  std::vector<CsvColumn> columns = {{"deflection", "m", {}},
                                    {"velocity", "m/s", {}},
                                    {"force", "N", {}},
                                    {"force_sigma", "N", {}},
                                    {"samples", "1", {}}};
  for (const double d : deflections) {
    for (const double v : velocities) {
      const double row[] = {
          d, v, calc_force(force.map, d, v), calc_map_sigma(fit, d, v),
          count_around(force.states, d, get_step(deflections), v, get_step(velocities))};
      for (std::size_t c = 0; c < columns.size(); ++c) columns[c].values.push_back(row[c]);
    }
  }
  return columns;
}

}  // namespace strut
