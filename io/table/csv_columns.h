// Names and units of a text table's columns.
#pragma once

#include <string>
#include <vector>

#include "io/table/csv.h"
#include "io/table/csv_layout.h"

namespace strut {

/// Makes the empty columns of the table that begins with `lines`. Without a line of names,
/// `comment`, the last one above the table, has them if its cells are as many; otherwise they are
/// column_1, column_2, ... The first column is `time` if it alone has no name. Columns of one name
/// keep their unit in it, or get a number if that is the same, too.
std::vector<CsvColumn> make_csv_columns(const std::vector<NumberedLine>& lines,
                                        const CsvLayout& layout, const std::string& comment);

}  // namespace strut
