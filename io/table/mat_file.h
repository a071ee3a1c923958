// MATLAB files of version 5 to 7; those of version 7.3 are HDF5.
#pragma once

#include <memory>

#include "io/table/table_file.h"

namespace strut {

/// Reads a file's real numeric vectors and matrices, also in structs: "name", "struct.field";
/// columns of a matrix are "name:1", "name:2". Throws InputError for a damaged file.
std::unique_ptr<TableFile> open_mat_file(const std::filesystem::path& path);

}  // namespace strut
