// HDF5 files with sound metadata and hostile content, sealed as their seeds are.
#pragma once

#include <string>

#include "tests/fuzz/random.h"

namespace strut::fuzz {

/// Writes the content of an HDF5 file again with some changes: datasets and attributes missing, of
/// another name, type or shape, with extreme numbers, texts of any bytes, damaged chunks. Where
/// `seed` is sealed, the result is sealed anew, so that the readers behind the seal meet it. The
/// library's own metadata stay sound: HDF5 1.10.8 crashes on some damaged ones.
std::string rewrite_hdf5(const std::string& seed, Random& random);

/// `file` with a seal like that of `seed` that fits its bytes; unchanged where `seed` has none.
std::string seal_again(const std::string& seed, std::string file);

}  // namespace strut::fuzz
