// Measured time histories.
#pragma once

#include <filesystem>
#include <vector>

#include "io/store/column_map.h"

namespace strut {

/// The column of a history that holds its times [s].
inline constexpr char kTimeColumn[] = "time";

/// Reads the times and the channels of a history in SI. Throws InputError that names the file, as
/// read_channels does.
Measurement read_history(const std::filesystem::path& file, const std::vector<ColumnInfo>& channels,
                         const ColumnMap& map = {});

/// Throws InputError that names file and row unless the times ascend strictly.
void require_ascending_times(const Measurement& history);

}  // namespace strut
