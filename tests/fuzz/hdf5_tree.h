// HDF5 files with valid metadata and hostile content, sealed as their seeds are.
#pragma once

#include <string>

#include "tests/fuzz/random.h"

namespace strut::fuzz {

/// Writes the content of an HDF5 file again with some changes: datasets and attributes missing,
/// with another name, type or shape, extreme numbers, texts of any bytes, damaged chunks. If `seed`
/// is sealed, the result is sealed again, so that it reaches the readers behind the seal. The
/// library's own metadata stay valid: HDF5 1.10.8 crashes on some damaged ones.
std::string rewrite_hdf5(const std::string& seed, Random& random);

/// Returns `file` with a seal like that of `seed` that matches its bytes; unchanged if `seed` has
/// none.
std::string seal_again(const std::string& seed, std::string file);

}  // namespace strut::fuzz
