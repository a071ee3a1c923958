#include "sweep/layers.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error/input_error.h"
#include "base/math/strata.h"

namespace strut {
namespace {

/// The largest sum of losses, in units; a little room below an int64 for rounding.
constexpr double kLargestSum = 0x1p60;

InputError sample_error(const SweepRequest& request, const std::string& what) {
  return InputError(request.path.string() + ": sample." + what);
}

/// Layers by level or cell: all parts of an axis have the same number of cases.
std::vector<std::int64_t> count_parts(std::int64_t parts, std::int64_t size, int layers) {
  std::vector<std::int64_t> populations;
  populations.reserve(static_cast<std::size_t>(layers));
  for (int layer = 0; layer < layers; ++layer) {
    const std::int64_t width =
        find_first_level(layer + 1, parts, layers) - find_first_level(layer, parts, layers);
    populations.push_back(width * (size / parts));
  }
  return populations;
}

void check_layers(const SweepRequest& request, const std::vector<Layer>& layers,
                  std::int64_t most) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (layers[i].population > 0) continue;
    throw sample_error(request, "strata = " + std::to_string(layers.size()) + ": layer " +
                                    std::to_string(i + 1) + " by \"" + request.sample.by +
                                    "\" is empty; allowed: 1 to " + std::to_string(most));
  }
}

}  // namespace

LayerRule::LayerRule(const SweepRequest& request, const CasePoints& points)
    : points_(points), layers_(static_cast<std::size_t>(request.sample.strata)) {
  const auto& axes = points.grid().axes();
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].name == request.sample.by) axis_ = static_cast<int>(a);
  }
  axis_ < 0 ? set_degradation_layers(request) : set_parameter_layers(request);
}

void LayerRule::set_parameter_layers(const SweepRequest& request) {
  const Axis& axis = points_.grid().axes()[static_cast<std::size_t>(axis_)];
  const int strata = request.sample.strata;
  const bool levels = points_.method() == SampleMethod::kGrid;
  std::vector<std::int64_t> populations(layers_.size(), 0);
  if (points_.method() == SampleMethod::kSobol) {
    for (std::int64_t id = 0; id < points_.size(); ++id) {
      ++populations[static_cast<std::size_t>(calc_layer(id))];
    }
  } else {
    populations = count_parts(levels ? axis.count : points_.size(), points_.size(), strata);
  }
  for (int i = 0; i < strata; ++i) {
    Layer& layer = layers_[static_cast<std::size_t>(i)];
    layer.population = populations[static_cast<std::size_t>(i)];
    const double width = (axis.last() - axis.from) / strata;
    layer.lower =
        levels ? axis.calc_value(find_first_level(i, axis.count, strata)) : axis.from + i * width;
    layer.upper = levels ? axis.calc_value(find_first_level(i + 1, axis.count, strata) - 1)
                         : axis.from + (i + 1) * width;
  }
  check_layers(request, layers_, levels ? axis.count : points_.size());
}

double LayerRule::set_losses() {
  const auto& axes = points_.grid().axes();
  double total = 0.0;
  for (const Axis& axis : axes) total += std::fabs((axis.last() - axis.from) / axis.from);
  const double scale = total > 0.0 ? kLargestSum / total : 1.0;
  const bool levels = points_.method() == SampleMethod::kGrid;
  losses_.reserve(axes.size());
  for (const Axis& axis : axes) {
    const double loss = std::fabs((levels ? axis.step : axis.last() - axis.from) / axis.from);
    losses_.push_back({axis.count, std::llround(loss * scale)});
  }
  return 1.0 / (scale * static_cast<double>(axes.size()));
}

void LayerRule::set_degradation_layers(const SweepRequest& request) {
  const int strata = request.sample.strata;
  std::vector<std::int64_t> ranks;
  ranks.reserve(layers_.size() + 1);
  for (int i = 0; i < strata; ++i) ranks.push_back(find_first_level(i, points_.size(), strata));
  ranks.push_back(points_.size());
  for (std::size_t i = 0; i < layers_.size(); ++i) layers_[i].population = ranks[i + 1] - ranks[i];
  check_layers(request, layers_, points_.size());
  const double unit = set_losses();
  ranks.back() = points_.size() - 1;  // the most degraded case
  try {
    first_ = find_points(ranks);
  } catch (const std::invalid_argument& e) {
    throw sample_error(request, std::string("by = \"degradation\": ") + e.what() +
                                    "; allowed here: a grid parameter");
  }
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    layers_[i].lower = unit * static_cast<double>(first_[i].sum);
    layers_[i].upper = unit * static_cast<double>(first_[i + 1].sum);
  }
  first_.erase(first_.begin());
  first_.pop_back();
}

std::vector<RankedPoint> LayerRule::find_points(const std::vector<std::int64_t>& ranks) const {
  std::vector<RankedPoint> found, all;
  found.reserve(ranks.size());
  if (points_.method() == SampleMethod::kGrid) {
    const GridSums sums(losses_);
    for (const std::int64_t rank : ranks) found.push_back(sums.find(rank));
    return found;
  }
  all.reserve(static_cast<std::size_t>(points_.size()));
  for (std::int64_t id = 0; id < points_.size(); ++id) all.push_back(rank_case(id));
  std::sort(all.begin(), all.end());
  for (const std::int64_t rank : ranks) found.push_back(all[static_cast<std::size_t>(rank)]);
  return found;
}

RankedPoint LayerRule::rank_case(std::int64_t id) const {
  std::vector<std::int64_t> coordinates(losses_.size());
  points_.calc_coordinates(id, coordinates);
  const bool levels = points_.method() == SampleMethod::kGrid;
  std::int64_t sum = 0;
  for (std::size_t a = 0; a < losses_.size(); ++a) {
    sum += levels ? coordinates[a] * losses_[a].weight
                  : scale_down(coordinates[a], losses_[a].weight, CasePoints::kCoordinates);
  }
  return {sum, id};
}

int LayerRule::calc_layer(std::int64_t id) const {
  if (axis_ >= 0) {
    const AxisPart part = points_.calc_part(id, static_cast<std::size_t>(axis_));
    return find_layer(part.index, part.count, static_cast<int>(layers_.size()));
  }
  return static_cast<int>(std::upper_bound(first_.begin(), first_.end(), rank_case(id)) -
                          first_.begin());
}

}  // namespace strut
