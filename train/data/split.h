// Splits cases into training, validation and test parts.
#pragma once

#include <cstdint>

#include "base/math/permutation.h"

namespace strut {

enum class Part { kTrain, kValidate, kTest };

/// A random split of n rows into parts of fixed size, computed by index: nothing is stored.
class Split {
 public:
  /// `train`, `validate`: fractions; these parts have floor(n fraction) rows, the test part has the
  /// others. Throws std::invalid_argument if a part would be empty.
  Split(std::int64_t rows, double train, double validate, std::uint64_t seed);

  Part find_part(std::int64_t row) const;
  std::int64_t count(Part part) const;
  std::int64_t size() const { return order_.size(); }

 private:
  Permutation order_;
  std::int64_t train_, validate_;
};

}  // namespace strut
