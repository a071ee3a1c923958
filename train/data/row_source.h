// Sources of training rows, read in order and in pieces, from memory or from files.
#pragma once

#include <cstddef>
#include <vector>

namespace strut {

/// Rows of normalized inputs and targets. Each pass of the training reads them in ascending order,
/// in contiguous pieces; an implementation may read ahead.
class RowSource {
 public:
  virtual ~RowSource() = default;
  virtual int input_count() const = 0;
  virtual int target_count() const = 0;
  virtual std::size_t row_count() const = 0;
  /// Reads rows [first, first + count). Called by one thread at a time.
  virtual void read(std::size_t first, std::size_t count, double* inputs, double* targets) = 0;
};

/// Rows held in memory.
class MemorySource : public RowSource {
 public:
  /// `inputs` and `targets`: by rows. Throws InputError unless both are finite and have the same
  /// number of rows, at least one.
  MemorySource(int input_count, std::vector<double> inputs, int target_count,
               std::vector<double> targets);

  int input_count() const override { return input_count_; }
  int target_count() const override { return target_count_; }
  std::size_t row_count() const override { return row_count_; }
  void read(std::size_t first, std::size_t count, double* inputs, double* targets) override;

 private:
  int input_count_, target_count_;
  std::size_t row_count_ = 0;
  std::vector<double> inputs_, targets_;
};

}  // namespace strut
