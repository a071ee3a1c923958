// The option --columns of `strut identify`: the columns of measured files as a campaign names them.
#pragma once

#include <vector>

#include "io/store/column_map.h"
#include "jobs/cli/arguments.h"

namespace strut {

void add_columns_option(Arguments& arguments);

/// The map of the campaign, or an empty one: columns are named like their channels.
ColumnMap read_columns_option(const Arguments& arguments, const std::vector<ColumnInfo>& channels);

}  // namespace strut
