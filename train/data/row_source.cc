#include "train/data/row_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"

namespace strut {
namespace {

std::size_t count_rows(const std::vector<double>& values, int columns, const char* what) {
  if (columns < 1 || values.empty() || values.size() % static_cast<std::size_t>(columns) != 0) {
    throw InputError(fmt::format("training rows: {} values of {} do not fill rows of {} columns",
                                 values.size(), what, columns));
  }
  const auto bad =
      std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
  const std::size_t rows = values.size() / static_cast<std::size_t>(columns);
  if (bad != values.end()) {
    const auto at = static_cast<std::size_t>(bad - values.begin());
    throw InputError(fmt::format("training rows: {} of row {} are not finite", what,
                                 at / static_cast<std::size_t>(columns)));
  }
  return rows;
}

}  // namespace

MemorySource::MemorySource(int input_count, std::vector<double> inputs, int target_count,
                           std::vector<double> targets)
    : input_count_(input_count),
      target_count_(target_count),
      inputs_(std::move(inputs)),
      targets_(std::move(targets)) {
  row_count_ = count_rows(inputs_, input_count, "inputs");
  const std::size_t target_rows = count_rows(targets_, target_count, "targets");
  if (target_rows != row_count_) {
    throw InputError(fmt::format("training rows: {} rows of inputs, but {} of targets", row_count_,
                                 target_rows));
  }
}

void MemorySource::read(std::size_t first, std::size_t count, double* inputs, double* targets) {
  const auto copy = [&](const std::vector<double>& from, int columns, double* to) {
    const auto width = static_cast<std::size_t>(columns);
    std::copy_n(from.data() + first * width, count * width, to);
  };
  copy(inputs_, input_count_, inputs);
  copy(targets_, target_count_, targets);
}

}  // namespace strut
