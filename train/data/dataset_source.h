// Turns the cases of a dataset into the rows that a network trains on.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/file/row_store.h"
#include "io/store/dataset.h"
#include "train/data/noise.h"
#include "train/data/normalizer.h"
#include "train/data/row_source.h"
#include "train/data/split.h"
#include "train/data/transform.h"

namespace strut {

struct RowChoice {
  std::vector<std::string> inputs;   // channels of the snapshot; for windows, of the histories
  std::vector<std::string> targets;  // parameters; empty: all
  std::int64_t samples = 0;          // number of usable rows to take, the first ones; 0: all
};

/// The usable rows of a dataset, as recorded: inputs, then targets.
struct UsableRows {
  std::vector<ColumnInfo> inputs, targets;
  RowStore rows{1};
  std::int64_t skipped = 0;  // cases that failed or have NaN
};

/// Finds columns by name; `kind` is used in messages. Throws InputError for an unknown name (with
/// the nearest one and all known ones), a repeated name, or no name at all.
std::vector<std::size_t> find_columns(const std::vector<ColumnInfo>& columns,
                                      const std::vector<std::string>& names, const char* kind);

/// Finds the chosen targets among the parameters.
std::vector<std::size_t> find_targets(const ShardSchema& schema, const RowChoice& choice);

std::vector<ColumnInfo> take_columns(const std::vector<ColumnInfo>& from,
                                     const std::vector<std::size_t>& columns);

/// Appends the wanted values of row i of a piece to `row`.
using FillRow =
    std::function<void(const ShardRows& piece, std::size_t i, std::vector<double>& row)>;

/// Appends a row to `rows` for each case that did not fail and whose values are finite, at most
/// `samples` rows (0: all); returns the number of skipped cases. Throws InputError if no case is
/// usable, or fewer than `samples`.
std::int64_t collect_usable(Dataset& dataset, std::int64_t samples, const FillRow& fill,
                            RowStore& rows);

/// Reads the usable rows in one pass. Throws InputError for an unknown channel or parameter (with
/// the nearest name and all known ones), and as collect_usable does.
UsableRows read_usable_rows(Dataset& dataset, const RowChoice& choice,
                            const RowStoreOptions& store = {});

/// Fractions of a split.
struct SplitChoice {
  double train = 0.7, validate = 0.15;
  std::uint64_t seed = 1;
};

/// Makes a split of `rows` rows. Throws InputError if a part would be empty.
Split make_split(std::int64_t rows, const SplitChoice& choice);

/// The training, validation and test rows of a network.
struct TrainingRows {
  std::vector<ColumnInfo> inputs, targets;
  Normalizer input_map{0}, target_map{0};   // bounds of the training part
  RowStore train{1}, validate{1}, test{1};  // as recorded: inputs, then targets
  std::int64_t usable = 0, skipped = 0;
  std::optional<NoiseModel> noise;        // added to the inputs, channels of the snapshot
  std::optional<WindowTransform> window;  // the inputs are its components
};

/// Splits the rows into parts; with `noise`, each part holds noisy copies of its rows. Throws
/// InputError for a column that is constant in the training part.
TrainingRows split_rows(UsableRows usable, const SplitChoice& choice,
                        const RowStoreOptions& store = {},
                        const std::optional<NoiseModel>& noise = {});

/// Sets the maps to the bounds of the training part. Throws InputError as split_rows does.
void fit_maps(TrainingRows& rows);

/// Copies the rows of one part, as recorded.
RowStore take_part(const RowStore& rows, const Split& split, Part part,
                   const RowStoreOptions& store = {});

/// Makes noisy copies of recorded rows: the first copy of all rows, then the second, and so on.
/// `takes`: true for the numbers of the rows to copy. The noise of a row depends on its number and
/// copy alone.
RowStore make_noisy_rows(const RowStore& rows, const NoiseModel& noise,
                         const std::function<bool(std::int64_t)>& takes,
                         const RowStoreOptions& store = {});

/// Normalized rows of a store.
class StoreSource : public RowSource {
 public:
  /// The store, whose columns are those of both maps, must outlive this.
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
