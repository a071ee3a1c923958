#include "train/model/interval.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "train/model/identifier.h"

namespace strut {

ConformalWidth::ConformalWidth(std::size_t errors, double coverage) {
  const double rank = std::ceil((static_cast<double>(errors) + 1.0) * coverage);
  const auto position = static_cast<std::size_t>(rank);
  keep_ = position <= errors ? errors - position + 1 : 0;
  largest_.reserve(keep_ + 1);
}

void ConformalWidth::add(double error) {
  if (keep_ == 0) return;
  const std::greater<> smallest_first;
  largest_.push_back(std::abs(error));
  std::push_heap(largest_.begin(), largest_.end(), smallest_first);
  if (largest_.size() <= keep_) return;
  std::pop_heap(largest_.begin(), largest_.end(), smallest_first);
  largest_.pop_back();
}

double ConformalWidth::get() const {
  return largest_.empty() ? std::numeric_limits<double>::infinity() : largest_.front();
}

std::vector<double> calc_ci95(const TrainedModel& model, const RowStore& validation) {
  const Identifier identifier(model);
  const std::size_t n = model.inputs.size(), m = model.targets.size();
  std::vector<ConformalWidth> widths(m, ConformalWidth(validation.row_count()));
  std::vector<double> values(m);
  for_each_piece(validation, [&](std::span<const double> rows, std::size_t, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const double* row = rows.data() + i * (n + m);
      identifier.identify(row, values.data());
      for (std::size_t t = 0; t < m; ++t) widths[t].add(values[t] - row[n + t]);
    }
  });
  std::vector<double> ci95;
  ci95.reserve(m);
  for (const ConformalWidth& width : widths) ci95.push_back(width.get());
  return ci95;
}

}  // namespace strut
