#include "train/data/split.h"

#include <cmath>
#include <stdexcept>

namespace strut {
namespace {

/// Stream of the seed.
constexpr std::uint64_t kSplitStream = 0x73706c6974000000;

std::int64_t calc_part(std::int64_t rows, double fraction) {
  // 0.7 * 10 must give 7 in spite of rounding.
  return static_cast<std::int64_t>(std::floor(static_cast<double>(rows) * fraction + 1e-9));
}

}  // namespace

Split::Split(std::int64_t rows, double train, double validate, std::uint64_t seed)
    : order_(rows, seed, kSplitStream),
      train_(calc_part(rows, train)),
      validate_(calc_part(rows, validate)) {
  if (train_ <= 0 || validate_ <= 0 || train_ + validate_ >= rows) {
    throw std::invalid_argument("split: training, validation and test each need a row");
  }
}

Part Split::find_part(std::int64_t row) const {
  const std::int64_t position = order_.invert(row);
  if (position < train_) return Part::kTrain;
  return position < train_ + validate_ ? Part::kValidate : Part::kTest;
}

std::int64_t Split::count(Part part) const {
  if (part == Part::kTrain) return train_;
  return part == Part::kValidate ? validate_ : size() - train_ - validate_;
}

}  // namespace strut
