// Reads the grid of a sweep file.
#pragma once

#include "io/format/toml_document.h"
#include "model_files/parameters.h"
#include "sweep/request.h"

namespace strut {

/// Reads the table [grid]: one axis per parameter, with levels if `method` is kGrid, else with
/// bounds only. `base`: the case whose parameters the axes set. Throws InputError with file, line,
/// key, value and what is allowed.
Grid read_grid(const Table& table, SampleMethod method, const Case& base);

/// Whether setting the second of two parameters changes the first, as front_left_stiffness does
/// front_stiffness, so that a case with both would depend on their order.
bool share_quantity(const ParameterInfo& first, const ParameterInfo& second, Case c);

}  // namespace strut
