// Compile-time check for programs that use an installed strut: Eigen must align memory there as in
// the installed libraries, because matrices are allocated in one and freed in the other. Eigen
// chooses the alignment of the heap and of matrices in structs by instruction set (-march, -mavx).
#pragma once

#include <Eigen/Core>

#ifdef STRUT_EIGEN_HEAP_ALIGNMENT  // the libraries' alignment, defined by their package
                                   // (.ci/cmake/install.cmake)
static_assert(EIGEN_DEFAULT_ALIGN_BYTES == STRUT_EIGEN_HEAP_ALIGNMENT &&
                  EIGEN_MAX_STATIC_ALIGN_BYTES == STRUT_EIGEN_STATIC_ALIGNMENT,
              "Eigen's alignment is not that of the installed strut: compile without -march, -mavx "
              "and EIGEN_MAX_ALIGN_BYTES, or build strut with the same CMAKE_CXX_FLAGS");
#endif
