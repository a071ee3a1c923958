// Where training rows come from: in order, in pieces, from memory or from files.
#pragma once

#include <cstddef>
#include <vector>

namespace strut {

/// Rows of inputs and targets, already normalized. Training reads them in ascending order, again
/// from the start in each pass, always whole pieces in a row; an implementation may read ahead.
class RowSource {
 public:
  virtual ~RowSource() = default;
  virtual int input_count() const = 0;
  virtual int target_count() const = 0;
  virtual std::size_t row_count() const = 0;
  /// Writes rows first to first + count, by rows. Called by one thread at a time.
  virtual void read(std::size_t first, std::size_t count, double* inputs, double* targets) = 0;
};

/// Rows held in memory.
class MemorySource : public RowSource {
 public:
  /// `inputs` and `targets` by rows. Throws InputError unless they hold the same number of rows, at
  /// least one, and are finite.
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
