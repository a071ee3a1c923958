#include "sweep/case_order.h"

#include <algorithm>

#include "model/kernel/mechanism.h"
#include "model_files/parameters.h"
#include "sweep/random_streams.h"

namespace strut {
namespace {

/// All axes, slow ones first; empty if none is slow.
std::vector<std::size_t> sort_axes(const SweepRequest& request) {
  std::vector<std::size_t> order = find_slow_axes(request);
  if (order.empty()) return order;
  const std::size_t slow = order.size();
  for (std::size_t a = 0; a < request.grid.axes().size(); ++a) {
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(slow);
    if (std::find(order.begin(), end, a) == end) order.push_back(a);
  }
  return order;
}

Grid reorder(const Grid& grid, const std::vector<std::size_t>& order) {
  std::vector<Axis> axes;
  axes.reserve(order.size());
  for (const std::size_t a : order) axes.push_back(grid.axes()[a]);
  return Grid(std::move(axes));
}

}  // namespace

std::vector<std::size_t> find_slow_axes(const SweepRequest& request) {
  std::vector<std::size_t> slow;
  if (request.sample.method != SampleMethod::kGrid) return slow;
  const auto& axes = request.grid.axes();
  for (std::size_t a = 0; a < axes.size(); ++a) {
    Case first = request.base, last = request.base;
    const ParameterInfo& parameter = find_parameter(axes[a].name);
    parameter.set(first, axes[a].from);
    parameter.set(last, axes[a].last());
    const bool same_duration = first.maneuver.duration == last.maneuver.duration;
    if (!same_duration || !shares_mechanism(first, last)) slow.push_back(a);
  }
  return slow;
}

CaseOrder::CaseOrder(const SweepRequest& request, const CasePoints& points,
                     std::optional<std::vector<std::int64_t>> drawn)
    : points_(points.size()),
      axes_(sort_axes(request)),
      grid_(request.grid),
      ranked_(reorder(request.grid, axes_)),
      members_(std::move(drawn)),
      size_(members_ ? static_cast<std::int64_t>(members_->size()) : points_) {
  if (members_) {
    for (std::int64_t& member : *members_) member = calc_rank(member);
    std::sort(members_->begin(), members_->end());
  }
  if (request.shuffle && size_ > 0) {
    shuffle_.emplace(size_, request.sample.seed, get_stream(RandomStream::kRunOrder));
  }
}

std::int64_t CaseOrder::calc_rank(std::int64_t case_id) const {
  if (axes_.empty()) return case_id;
  std::vector<std::int64_t> levels(axes_.size()), sorted(axes_.size());
  grid_.calc_levels(case_id, levels);
  for (std::size_t i = 0; i < axes_.size(); ++i) sorted[i] = levels[axes_[i]];
  return ranked_.calc_id(sorted);
}

std::int64_t CaseOrder::calc_id(std::int64_t rank) const {
  if (axes_.empty()) return rank;
  std::vector<std::int64_t> levels(axes_.size()), sorted(axes_.size());
  ranked_.calc_levels(rank, sorted);
  for (std::size_t i = 0; i < axes_.size(); ++i) levels[axes_[i]] = sorted[i];
  return grid_.calc_id(levels);
}

std::vector<std::int64_t> CaseOrder::list_drawn() const {
  std::vector<std::int64_t> drawn;
  if (!members_) return drawn;
  drawn.reserve(members_->size());
  for (const std::int64_t rank : *members_) drawn.push_back(calc_id(rank));
  std::sort(drawn.begin(), drawn.end());
  return drawn;
}

std::int64_t CaseOrder::calc_case_id(std::int64_t position) const {
  const std::int64_t index = shuffle_ ? shuffle_->apply(position) : position;
  return calc_id(members_ ? (*members_)[static_cast<std::size_t>(index)] : index);
}

std::int64_t CaseOrder::find_position(std::int64_t case_id) const {
  if (case_id < 0 || case_id >= points_) return -1;
  std::int64_t index = calc_rank(case_id);
  if (members_) {
    const auto found = std::lower_bound(members_->begin(), members_->end(), index);
    if (found == members_->end() || *found != index) return -1;
    index = found - members_->begin();
  }
  return shuffle_ ? shuffle_->invert(index) : index;
}

}  // namespace strut
