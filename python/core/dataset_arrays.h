// The cases of a sweep as arrays.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <vector>

namespace strut {

/// Reads a sweep's folder, shards or a merged file (Dataset), sorted by case. Returns a dictionary
/// of arrays and of columns, lists of (name, unit, description). Throws as Dataset.
pybind11::dict read_dataset(const std::vector<std::filesystem::path>& paths, bool partial,
                            bool histories);

}  // namespace strut
