// The columns of an HDF5 file: as strut writes it, or another program, MATLAB 7.3 included.
#pragma once

#include <memory>

#include "io/table/table_file.h"

namespace strut {

/// Table of a file of strut; others have one.
enum class MeasuredPart { kSnapshot, kHistory };

/// Opens the table of `part` (/snapshot/NAME, /history/NAME, the table /snapshot of a shard or a
/// merged file) or, where the file has neither, all numeric vectors and matrices of its groups:
/// "name", "group/name"; columns of a matrix are "name:1", "name:2". Units: attribute unit or units
/// of a dataset. Throws InputError for a damaged file, and where it has only the other part.
std::unique_ptr<TableFile> open_hdf5_table(const std::filesystem::path& path, MeasuredPart part);

}  // namespace strut
