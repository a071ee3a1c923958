// Reads the grid of a sweep file.
#pragma once

#include "io/format/toml_document.h"
#include "sweep/request.h"

namespace strut {

/// Reads the table [grid]: one axis per parameter, with levels if `method` is kGrid, else with
/// bounds only. `base`: the case whose parameters the axes set. Throws InputError with file, line,
/// key, value and what is allowed.
Grid read_grid(const Table& table, SampleMethod method, const Case& base);

}  // namespace strut
