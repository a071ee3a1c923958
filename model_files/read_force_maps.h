// Force maps of a vehicle or rig file: its tables [[force_map]].
//
//   [[force_map]]
//   place = "rear"               # front, rear or a corner; absent on a rig
//   deflection = [-0.05, 0.08]   # m, range; compression positive, from nominal trim
//   velocity = [-1.0, 1.0]       # m/s, range
//   force = [                    # N, coefficients of splines: a row for each deflection,
//     [-300, -80, 0, 90, 280],   # in it one for each velocity; a single row or column: the force
//   ]                            # does not depend on that variable
#pragma once

#include <string>

#include "base/error/input_error.h"
#include "io/format/toml_document.h"
#include "model/effects/force_map.h"

namespace strut {

/// Maps of the tables [[force_map]] of a file of this kind, in the order of the file. Throws
/// InputError with file, line, key, value and allowed values.
ForceMaps read_force_maps(const Table& root, const ModelInfo& model);

/// Replaces the tables [[force_map]] in the text of a vehicle or rig file; the other text is
/// unchanged. Reads back as exactly these maps. Throws InputError where the text writes its maps in
/// another form, ModelError for maps that are invalid for this kind of model.
std::string replace_force_maps(const std::string& text, const ForceMaps& maps,
                               const ModelInfo& model);

}  // namespace strut
