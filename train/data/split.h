// Which cases train, which validate, which test.
#pragma once

#include <cstdint>

#include "base/math/permutation.h"

namespace strut {

enum class Part { kTrain, kValidate, kTest };

/// A random split of n rows in parts of fixed size, by index: nothing is stored.
class Split {
 public:
  /// Shares of training and validation; the rest tests. The parts have floor(n share) rows, the
  /// test part what is left. Throws std::invalid_argument where a part would be empty.
  Split(std::int64_t rows, double train, double validate, std::uint64_t seed);

  Part find_part(std::int64_t row) const;
  std::int64_t count(Part part) const;
  std::int64_t size() const { return order_.size(); }

 private:
  Permutation order_;
  std::int64_t train_, validate_;
};

}  // namespace strut
