// The study problem of the trainer: tests/data/lm_problem, described in tests/data/README.md.
#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "train/data/row_source.h"
#include "train/network/network_problem.h"

namespace strut::test {

/// The seven start weights: Nguyen-Widrow 0 to 4, Xavier, start 0 at half scale.
inline constexpr std::array<const char*, 7> kStudyStarts{"0", "1", "2", "3", "4", "x0", "h0"};

class StudyProblem {
 public:
  /// `folder`: holds the .bin files.
  explicit StudyProblem(const std::string& folder)
      : folder_(folder),
        inputs_(read<double>("X.bin", 8000)),
        targets_(read<double>("T.bin", 8000)),
        order_(read<std::int32_t>("idx.bin", 2000)) {}

  static NetworkShape make_shape() { return NetworkShape({4, 27, 19, 11, 4}); }
  MemorySource make_training() const { return make_part(0, 1400); }
  MemorySource make_validation() const { return make_part(1400, 300); }
  MemorySource make_test() const { return make_part(1700, 300); }

  std::vector<double> read_start(const std::string& name) const {
    return read<double>("w0_" + name + ".bin", 935);
  }

 private:
  template <class T>
  std::vector<T> read(const std::string& name, std::size_t count) const {
    std::ifstream stream(folder_ + "/" + name, std::ios::binary);
    std::vector<T> values(count);
    stream.read(reinterpret_cast<char*>(values.data()),
                static_cast<std::streamsize>(count * sizeof(T)));
    if (!stream) throw std::runtime_error(folder_ + "/" + name + " is missing or too short");
    return values;
  }

  MemorySource make_part(std::size_t first, std::size_t count) const {
    std::vector<double> x, t;
    x.reserve(4 * count);
    t.reserve(4 * count);
    for (std::size_t i = first; i < first + count; ++i) {
      const auto row = static_cast<std::size_t>(order_[i]);
      for (std::size_t k = 0; k < 4; ++k) {
        x.push_back(inputs_[4 * row + k]);
        t.push_back(targets_[4 * row + k]);
      }
    }
    return {4, std::move(x), 4, std::move(t)};
  }

  std::string folder_;
  std::vector<double> inputs_, targets_;
  std::vector<std::int32_t> order_;
};

}  // namespace strut::test
