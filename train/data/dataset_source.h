// From the cases of a sweep to rows that a network trains on.
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
  std::vector<std::string> inputs;   // channels of the snapshot, of a window those of the histories
  std::vector<std::string> targets;  // parameters; empty: all
  std::int64_t samples = 0;          // only the first so many usable rows; 0: all
};

/// Rows of a dataset that can be used, as recorded: the inputs' columns, then the targets'.
struct UsableRows {
  std::vector<ColumnInfo> inputs, targets;
  RowStore rows{1};
  std::int64_t skipped = 0;  // failed cases and NaN among them
};

/// Positions of columns by name; `kind` stands in messages. Throws InputError for a name that is
/// not there, with the nearest and all there are, for one named twice, and for none.
std::vector<std::size_t> find_columns(const std::vector<ColumnInfo>& columns,
                                      const std::vector<std::string>& names, const char* kind);

/// Those of the chosen targets among the parameters.
std::vector<std::size_t> find_targets(const ShardSchema& schema, const RowChoice& choice);

std::vector<ColumnInfo> take_columns(const std::vector<ColumnInfo>& from,
                                     const std::vector<std::size_t>& columns);

/// Appends to `row` what is wanted of row i of a piece.
using FillRow =
    std::function<void(const ShardRows& piece, std::size_t i, std::vector<double>& row)>;

/// Appends a row to `rows` for each case that did not fail and whose row is finite, up to `samples`
/// of them (0: all); returns how many cases it left out. Throws InputError where nothing is usable
/// or there are fewer than `samples`.
std::int64_t collect_usable(Dataset& dataset, std::int64_t samples, const FillRow& fill,
                            RowStore& rows);

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
  std::optional<NoiseModel> noise;        // that the inputs, channels of the snapshot, carry
  std::optional<WindowTransform> window;  // whose components the inputs are
};

/// Takes the rows apart; with `noise`, of the inputs, into its noisy copies. Throws InputError that
/// names a column whose values are all equal in the training part.
TrainingRows split_rows(UsableRows usable, const SplitChoice& choice,
                        const RowStoreOptions& store = {},
                        const std::optional<NoiseModel>& noise = {});

/// Sets the maps to the bounds of the training part. Throws InputError as split_rows.
void fit_maps(TrainingRows& rows);

/// The rows of one part, as recorded.
RowStore take_part(const RowStore& rows, const Split& split, Part part,
                   const RowStoreOptions& store = {});

/// Noisy copies of rows as recorded, all of the first copy before those of the second. The draws of
/// a row are those of its number, whatever else is taken. `takes`: by that number.
RowStore make_noisy_rows(const RowStore& rows, const NoiseModel& noise,
                         const std::function<bool(std::int64_t)>& takes,
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
