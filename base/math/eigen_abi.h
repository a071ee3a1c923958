// Where strut is installed: a program that compiles Eigen otherwise than its libraries were does
// not compile. Matrices are allocated by one and freed by the other, and Eigen chooses how, and how
// a matrix is aligned in a struct, by the instruction set (-march, -mavx).
#pragma once

#include <Eigen/Core>

#ifdef STRUT_EIGEN_HEAP_ALIGNMENT  // of the libraries, told by their package
                                   // (.ci/cmake/install.cmake)
static_assert(EIGEN_DEFAULT_ALIGN_BYTES == STRUT_EIGEN_HEAP_ALIGNMENT &&
                  EIGEN_MAX_STATIC_ALIGN_BYTES == STRUT_EIGEN_STATIC_ALIGNMENT,
              "Eigen's alignment is not that of the installed strut: compile without -march, -mavx "
              "and EIGEN_MAX_ALIGN_BYTES, or build strut with the same CMAKE_CXX_FLAGS");
#endif
