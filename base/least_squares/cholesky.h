// Normal matrices and parts of their Cholesky factorization, compiled once per instruction set
// (cholesky_isa.cc) and chosen at run time.
#pragma once

#include <cstddef>
#include <vector>

namespace strut {

struct CholeskyKernel {
  const char* isa;  // "baseline", "avx2", "avx512"

  /// h += a' a, lower triangle, with a of rows x n.
  void (*add_normal)(const double* a, std::size_t rows, std::size_t n, double* h);
  /// b = a L with L of n x n, lower triangle; a and b of rows x n, apart.
  void (*multiply_lower)(const double* a, const double* l, std::size_t rows, std::size_t n,
                         double* b);
  /// Factors A = L L' in place, lower triangle by columns with leading dimension `lead`; returns
  /// false if A is not positive definite.
  bool (*factor_diagonal)(double* a, std::size_t n, std::size_t lead);
  /// b = b L^-T with b of rows x n.
  void (*solve_panel)(const double* l, std::size_t n, double* b, std::size_t rows,
                      std::size_t lead);
  /// c -= a b' with a of rows x depth and b of columns x depth.
  void (*update_panel)(const double* a, const double* b, double* c, std::size_t rows,
                       std::size_t columns, std::size_t depth, std::size_t lead);
  /// x = A^-1 x.
  void (*solve)(const double* l, std::size_t n, double* x);
};

/// Kernels that this processor can run, widest first; never empty.
const std::vector<CholeskyKernel>& list_cholesky_kernels();
/// The widest kernel.
const CholeskyKernel& get_cholesky_kernel();

}  // namespace strut
