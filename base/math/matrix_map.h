// Eigen maps of arrays with a stride between columns or rows.
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace strut {

using ColumnMatrix = Eigen::MatrixXd;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Stride = Eigen::OuterStride<>;
using ColumnMap = Eigen::Map<ColumnMatrix, 0, Stride>;
using ConstColumnMap = Eigen::Map<const ColumnMatrix, 0, Stride>;
using ConstRowMap = Eigen::Map<const RowMatrix, 0, Stride>;

inline Eigen::Index to_index(std::size_t i) { return static_cast<Eigen::Index>(i); }

/// rows x columns, `lead` numbers from one column to the next.
inline ColumnMap map_columns(double* a, std::size_t rows, std::size_t columns, std::size_t lead) {
  return {a, to_index(rows), to_index(columns), Stride(to_index(lead))};
}
inline ConstColumnMap map_columns(const double* a, std::size_t rows, std::size_t columns,
                                  std::size_t lead) {
  return {a, to_index(rows), to_index(columns), Stride(to_index(lead))};
}
/// rows x columns, `stride` numbers from one row to the next.
inline ConstRowMap map_rows(const double* a, std::size_t rows, std::size_t columns,
                            std::size_t stride) {
  return {a, to_index(rows), to_index(columns), Stride(to_index(stride))};
}

}  // namespace strut
