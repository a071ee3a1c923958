// Normal matrices and their Cholesky factorization for one instruction set: compiled once for each,
// with STRUT_ISA defined as its name.
#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "base/least_squares/cholesky.h"
#include "base/math/matrix_map.h"
#include "base/parallel/instruction_sets.h"

namespace {

using strut::ColumnMap;
using strut::ColumnMatrix;
using strut::ConstColumnMap;
using strut::map_columns;
using strut::Stride;
using strut::to_index;

void add_normal(const double* a, std::size_t rows, std::size_t n, double* h) {
  map_columns(h, n, n, n)
      .selfadjointView<Eigen::Lower>()
      .rankUpdate(map_columns(a, rows, n, rows).transpose());
}

void multiply_lower(const double* a, const double* l, std::size_t rows, std::size_t n, double* b) {
  map_columns(b, rows, n, rows).noalias() =
      map_columns(a, rows, n, rows) * map_columns(l, n, n, n).triangularView<Eigen::Lower>();
}

bool factor_diagonal(double* a, std::size_t n, std::size_t lead) {
  Eigen::Ref<ColumnMatrix, 0, Stride> in_place(map_columns(a, n, n, lead));
  const Eigen::LLT<Eigen::Ref<ColumnMatrix, 0, Stride>> factor(in_place);
  if (factor.info() != Eigen::Success) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (!(a[i * lead + i] > 0.0)) return false;  // Eigen does not report NaN
  }
  return true;
}

void solve_panel(const double* l, std::size_t n, double* b, std::size_t rows, std::size_t lead) {
  ColumnMap panel = map_columns(b, rows, n, lead);
  map_columns(l, n, n, lead)
      .transpose()
      .triangularView<Eigen::Upper>()
      .solveInPlace<Eigen::OnTheRight>(panel);
}

void update_panel(const double* a, const double* b, double* c, std::size_t rows,
                  std::size_t columns, std::size_t depth, std::size_t lead) {
  map_columns(c, rows, columns, lead).noalias() -=
      map_columns(a, rows, depth, lead) * map_columns(b, columns, depth, lead).transpose();
}

void solve(const double* l, std::size_t n, double* x) {
  Eigen::Map<Eigen::VectorXd> vector(x, to_index(n));
  const ConstColumnMap lower = map_columns(l, n, n, n);
  lower.triangularView<Eigen::Lower>().solveInPlace(vector);
  lower.transpose().triangularView<Eigen::Upper>().solveInPlace(vector);
}

}  // namespace

extern "C" strut::CholeskyKernel STRUT_ISA_NAME(strut_cholesky_)();

extern "C" strut::CholeskyKernel STRUT_ISA_NAME(strut_cholesky_)() {
  // Eigen splits its sums by the cache sizes. With those of the processor, results would differ
  // between machines of one instruction set.
  Eigen::setCpuCacheSizes(32 * 1024, 512 * 1024, 4 * 1024 * 1024);
  return {STRUT_ISA_STRING, &add_normal,   &multiply_lower, &factor_diagonal,
          &solve_panel,     &update_panel, &solve};
}
