// Compile-time check for users of an installed strut: their Eigen must align memory as that of the
// installed libraries does. Matrices are allocated by one and freed by the other, and Eigen chooses
// the alignment of heap memory and of matrices in structs by the instruction set (-march, -mavx).
#pragma once

#include <Eigen/Core>

#ifdef STRUT_EIGEN_HEAP_ALIGNMENT  // the libraries' alignment, defined by their package
                                   // (.ci/cmake/install.cmake)
static_assert(EIGEN_DEFAULT_ALIGN_BYTES == STRUT_EIGEN_HEAP_ALIGNMENT &&
                  EIGEN_MAX_STATIC_ALIGN_BYTES == STRUT_EIGEN_STATIC_ALIGNMENT,
              "Eigen's alignment is not that of the installed strut: compile without -march, -mavx "
              "and EIGEN_MAX_ALIGN_BYTES, or build strut with the same CMAKE_CXX_FLAGS");
#endif
