// Which column of a file is which channel of a model, by name and unit.
#pragma once

#include <string>
#include <vector>

#include "io/table/summary.h"
#include "model/info/model_info.h"

namespace strut {

struct ColumnMatch {
  std::string channel;
  std::size_t column = 0;  // index in TableSummary::columns
  bool is_sure = false;    // every word of the channel's name stands in that of the column
};

/// Returns the best assignment, each channel and each column at most once, in the order of the
/// channels. A column with a unit that does not convert to the channel's is none of its candidates;
/// at least half of the words of the channel's name must stand in the column's, abbreviations
/// ("disp", "acc", "fl") included.
std::vector<ColumnMatch> match_columns(const ModelInfo& model, const TableSummary& table);

}  // namespace strut
