#include "sweep/strata.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error/input_error.h"
#include "base/math/strata.h"
#include "sweep/choices.h"

namespace strut {
namespace {

/// Maximum sum of losses, in units; leaves room below the range of int64 for rounding.
constexpr double kMaxSum = 0x1p60;

/// Populations of strata by level or cell: all parts of an axis have the same number of cases.
std::vector<std::int64_t> count_parts(std::int64_t parts, std::int64_t size, int strata) {
  std::vector<std::int64_t> populations;
  populations.reserve(static_cast<std::size_t>(strata));
  for (int i = 0; i < strata; ++i) {
    const std::int64_t width =
        find_first_level(i + 1, parts, strata) - find_first_level(i, parts, strata);
    populations.push_back(width * (size / parts));
  }
  return populations;
}

void check_strata(const SweepRequest& request, const std::vector<Stratum>& strata,
                  std::int64_t max) {
  for (std::size_t i = 0; i < strata.size(); ++i) {
    if (strata[i].population > 0) continue;
    throw InputError(
        fmt::format("{}: sample.strata = {}: stratum {} by \"{}\" is empty; allowed: 1 to {}",
                    request.path.string(), strata.size(), i + 1, request.sample.by, max));
  }
}

void set_parameter_strata(const SweepRequest& request, const CasePoints& points, Strata& strata) {
  const Axis& axis = points.grid().axes()[static_cast<std::size_t>(strata.axis)];
  const int count = request.sample.strata;
  const bool levels = points.method() == SampleMethod::kGrid;
  std::vector<std::int64_t> populations(strata.list.size(), 0);
  if (points.method() == SampleMethod::kSobol) {
    for (std::int64_t id = 0; id < points.size(); ++id) {
      ++populations[static_cast<std::size_t>(calc_stratum(strata, points, id))];
    }
  } else {
    populations = count_parts(levels ? axis.count : points.size(), points.size(), count);
  }
  for (int i = 0; i < count; ++i) {
    Stratum& stratum = strata.list[static_cast<std::size_t>(i)];
    stratum.population = populations[static_cast<std::size_t>(i)];
    const double width = (axis.last() - axis.from) / count;
    stratum.lower =
        levels ? axis.calc_value(find_first_level(i, axis.count, count)) : axis.from + i * width;
    stratum.upper = levels ? axis.calc_value(find_first_level(i + 1, axis.count, count) - 1)
                           : axis.from + (i + 1) * width;
  }
  check_strata(request, strata.list, levels ? axis.count : points.size());
}

/// The losses of each axis as integers, and the degradation that one unit of their sum stands for.
struct Losses {
  std::vector<SumAxis> axes;
  double unit = 0.0;
};

Losses calc_losses(const CasePoints& points) {
  const auto& axes = points.grid().axes();
  double total = 0.0;
  for (const Axis& axis : axes) total += std::fabs((axis.last() - axis.from) / axis.from);
  const double scale = total > 0.0 ? kMaxSum / total : 1.0;
  const bool levels = points.method() == SampleMethod::kGrid;
  Losses losses;
  losses.axes.reserve(axes.size());
  for (const Axis& axis : axes) {
    const double loss = std::fabs((levels ? axis.step : axis.last() - axis.from) / axis.from);
    losses.axes.push_back({axis.count, std::llround(loss * scale)});
  }
  losses.unit = 1.0 / (scale * static_cast<double>(axes.size()));
  return losses;
}

RankedPoint rank_case(const std::vector<SumAxis>& losses, const CasePoints& points,
                      std::int64_t id) {
  std::vector<std::int64_t> coordinates(losses.size());
  points.calc_coordinates(id, coordinates);
  const bool levels = points.method() == SampleMethod::kGrid;
  std::int64_t sum = 0;
  for (std::size_t a = 0; a < losses.size(); ++a) {
    sum += levels ? coordinates[a] * losses[a].weight
                  : scale_down(coordinates[a], losses[a].weight, CasePoints::kCoordinates);
  }
  return {sum, id};
}

/// The points at `ranks` in the order of degradation.
std::vector<RankedPoint> find_points(const std::vector<SumAxis>& losses, const CasePoints& points,
                                     const std::vector<std::int64_t>& ranks) {
  std::vector<RankedPoint> found, all;
  found.reserve(ranks.size());
  if (points.method() == SampleMethod::kGrid) {
    const GridSums sums(losses);
    for (const std::int64_t rank : ranks) found.push_back(sums.find(rank));
    return found;
  }
  all.reserve(static_cast<std::size_t>(points.size()));
  for (std::int64_t id = 0; id < points.size(); ++id) all.push_back(rank_case(losses, points, id));
  std::sort(all.begin(), all.end());
  for (const std::int64_t rank : ranks) found.push_back(all[static_cast<std::size_t>(rank)]);
  return found;
}

/// Sets the populations; returns the rank of each stratum's first case and of the last case of all.
std::vector<std::int64_t> divide_ranks(const SweepRequest& request, const CasePoints& points,
                                       std::vector<Stratum>& strata) {
  const int count = request.sample.strata;
  std::vector<std::int64_t> ranks;
  ranks.reserve(strata.size() + 1);
  for (int i = 0; i <= count; ++i) ranks.push_back(find_first_level(i, points.size(), count));
  for (std::size_t i = 0; i < strata.size(); ++i) strata[i].population = ranks[i + 1] - ranks[i];
  check_strata(request, strata, points.size());
  ranks.back() = points.size() - 1;
  return ranks;
}

void set_degradation_strata(const SweepRequest& request, const CasePoints& points, Strata& strata) {
  const std::vector<std::int64_t> ranks = divide_ranks(request, points, strata.list);
  Losses losses = calc_losses(points);
  strata.losses = std::move(losses.axes);
  try {
    strata.first = find_points(strata.losses, points, ranks);
  } catch (const std::invalid_argument& e) {
    throw InputError(fmt::format("{}: sample.by = \"{}\": {}; allowed here: a grid parameter",
                                 request.path.string(), kDegradation, e.what()));
  }
  for (std::size_t i = 0; i < strata.list.size(); ++i) {
    strata.list[i].lower = losses.unit * static_cast<double>(strata.first[i].sum);
    strata.list[i].upper = losses.unit * static_cast<double>(strata.first[i + 1].sum);
  }
  strata.first.erase(strata.first.begin());
  strata.first.pop_back();
}

}  // namespace

Strata make_strata(const SweepRequest& request, const CasePoints& points) {
  Strata strata;
  strata.list.resize(static_cast<std::size_t>(request.sample.strata));
  const auto& axes = points.grid().axes();
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].name == request.sample.by) strata.axis = static_cast<int>(a);
  }
  if (strata.axis < 0) {
    set_degradation_strata(request, points, strata);
  } else {
    set_parameter_strata(request, points, strata);
  }
  return strata;
}

int calc_stratum(const Strata& strata, const CasePoints& points, std::int64_t id) {
  if (strata.axis >= 0) {
    const AxisPart part = points.calc_part(id, static_cast<std::size_t>(strata.axis));
    return find_stratum(part.index, part.count, static_cast<int>(strata.list.size()));
  }
  const RankedPoint rank = rank_case(strata.losses, points, id);
  return static_cast<int>(std::upper_bound(strata.first.begin(), strata.first.end(), rank) -
                          strata.first.begin());
}

}  // namespace strut
