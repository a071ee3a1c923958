// The structure of a MATLAB 5 file, checked before matio, which trusts its sizes, reads it.
//
// MathWorks, "MAT-File Format": after a header of 128 bytes, elements of a tag (type, size) and a
// body; that of a matrix is elements again (flags, dimensions, name, data), that of a compressed
// element a deflated matrix.
#pragma once

#include <cstddef>
#include <filesystem>

namespace strut {

struct MatStructure {
  std::size_t whole_count = 0;  // elements that end within the file, one variable each
  bool is_cut_off = false;      // another one begins
};

/// Throws InputError where an element does not fit into the one around it, or the dimensions of an
/// array exceed what its bytes can hold; EnvironmentError if the file cannot be read.
MatStructure check_mat_structure(const std::filesystem::path& path);

}  // namespace strut
