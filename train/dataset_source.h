// From the cases of a sweep to rows that a network trains on.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/dataset.h"
#include "io/row_store.h"
#include "train/normalizer.h"
#include "train/row_source.h"
#include "train/split.h"

namespace strut {

struct RowChoice {
  std::vector<std::string> inputs;   // snapshot channels
  std::vector<std::string> targets;  // parameters; empty: all
  std::int64_t samples = 0;          // only the first so many usable rows; 0: all
};

/// Rows of a dataset that can be used, as recorded: the inputs' columns, then the targets'.
struct UsableRows {
  std::vector<ColumnInfo> inputs, targets;
  RowStore rows{1};
  std::int64_t skipped = 0;  // failed cases and NaN among them
};

/// Reads the dataset once. Throws InputError for a channel or parameter that it does not have, with
/// the nearest name and all there are; where nothing is usable; where there are fewer rows than
/// `samples`.
UsableRows read_usable_rows(Dataset& dataset, const RowChoice& choice,
                            const RowStoreOptions& store = {});

/// Shares of a split.
struct SplitChoice {
  double train = 0.7, validate = 0.15;
  std::uint64_t seed = 1;
};

/// A split of so many rows. Throws InputError where a part would be empty.
Split make_split(std::int64_t rows, const SplitChoice& choice);

/// A network's rows, part by part.
struct TrainingRows {
  std::vector<ColumnInfo> inputs, targets;
  Normalizer input_map{0}, target_map{0};   // bounds of the training part
  RowStore train{1}, validate{1}, test{1};  // as recorded, the inputs' columns first
  std::int64_t usable = 0, skipped = 0;
};

/// Takes the rows apart. Throws InputError that names a column whose values are all equal in the
/// training part.
TrainingRows split_rows(UsableRows usable, const SplitChoice& choice,
                        const RowStoreOptions& store = {});

/// The rows of one part, as recorded.
RowStore take_part(const RowStore& rows, const Split& split, Part part,
                   const RowStoreOptions& store = {});

/// Rows of a store, normalized on their way out.
class StoreSource : public RowSource {
 public:
  /// The store must outlive this; its columns are those of both maps.
  StoreSource(const RowStore& rows, Normalizer input_map, Normalizer target_map);

  int input_count() const override { return static_cast<int>(input_map_.columns()); }
  int target_count() const override { return static_cast<int>(target_map_.columns()); }
  std::size_t row_count() const override { return rows_->row_count(); }
  void read(std::size_t first, std::size_t count, double* inputs, double* targets) override;

 private:
  const RowStore* rows_;
  Normalizer input_map_, target_map_;
  std::vector<double> buffer_;
};

}  // namespace strut
