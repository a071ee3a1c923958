#include "diagnose/discrepancy/map_basis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "diagnose/discrepancy/map_axis.h"

namespace strut {
namespace {

using Index = Eigen::Index;

/// Shapes over one variable: the line, then curved ones by roughness relative to the line's.
struct AxisShapes {
  Eigen::VectorXd one;      // the constant
  Eigen::MatrixXd columns;  // empty where the map does not depend on this variable
  Eigen::VectorXd roughness;
};

AxisShapes make_axis_shapes(const MapAxis& axis, const std::vector<double>& samples) {
  const Index n = axis.count;
  AxisShapes shapes;
  shapes.one = Eigen::VectorXd::Ones(n);
  if (n < kMinSplines || samples.empty()) return shapes;
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n), second = Eigen::MatrixXd::Zero(n - 2, n);
  for (const double x : samples) {
    const Eigen::VectorXd b = axis.calc_splines(x);
    mass.noalias() += b * b.transpose();
  }
  mass /= static_cast<double>(samples.size());
  // Unvisited parts count a little, so that they stay smooth and bounded.
  constexpr double kUnvisited = 1e-4;
  mass.diagonal().array() += kUnvisited * mass.trace() / static_cast<double>(n);
  for (Index i = 0; i + 2 < n; ++i) second.row(i).segment(i, 3) << 1.0, -2.0, 1.0;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      Eigen::MatrixXd(second.transpose() * second), mass);
  // The line, orthogonal to the constant, before the curved shapes.
  const std::vector<double> abscissas = calc_map_abscissas(axis.low, axis.high, axis.count);
  Eigen::VectorXd line = Eigen::Map<const Eigen::VectorXd>(abscissas.data(), n);
  line.array() -= shapes.one.dot(mass * line) / shapes.one.dot(mass * shapes.one);
  line /= std::sqrt(line.dot(mass * line));
  shapes.columns.resize(n, n - 1);
  shapes.columns.col(0) = line;
  shapes.columns.rightCols(n - 2) = solver.eigenvectors().rightCols(n - 2);
  // Roughness grows with the fourth power of the number of bends: the line counts as the first.
  constexpr double kSecond = 16.0;
  shapes.roughness = Eigen::VectorXd::Ones(n - 1);
  shapes.roughness.tail(n - 2) =
      solver.eigenvalues().tail(n - 2) * (kSecond / solver.eigenvalues()(2));
  return shapes;
}

/// Coefficients of f(d) g(v), row by row.
Eigen::VectorXd calc_product(const Eigen::VectorXd& of_deflection,
                             const Eigen::VectorXd& of_velocity) {
  const Eigen::MatrixXd rows = of_velocity * of_deflection.transpose();
  return Eigen::Map<const Eigen::VectorXd>(rows.data(), rows.size());
}

void choose_range(const std::vector<double>& samples, double margin, double& low, double& high) {
  const auto [min, max] = std::minmax_element(samples.begin(), samples.end());
  const double wide = margin * (*max - *min);
  low = *min - wide;
  high = *max + wide;
}

ForceMap make_grid(const VisitedStates& states, const MapGridOptions& options) {
  ForceMap grid;
  grid.place = states.place;
  choose_range(states.deflection, options.margin, grid.deflection_low, grid.deflection_high);
  choose_range(states.velocity, options.margin, grid.velocity_low, grid.velocity_high);
  grid.deflection_count = options.deflection_count;
  grid.velocity_count = options.velocity_count;
  return grid;
}

}  // namespace

MapBasis make_map_basis(const VisitedStates& states, const ForceMap* given,
                        const MapGridOptions& options) {
  constexpr double kStill = 1e-6;  // m, m/s
  MapBasis basis;
  if (states.velocity.empty()) return basis;
  basis.grid = given != nullptr ? *given : make_grid(states, options);
  ForceMap& grid = basis.grid;
  if (!(grid.deflection_high - grid.deflection_low > kStill) ||
      !(grid.velocity_high - grid.velocity_low > kStill)) {
    return basis;
  }
  grid.coefficients.assign(static_cast<std::size_t>(grid.deflection_count) *
                               static_cast<std::size_t>(grid.velocity_count),
                           0.0);
  const AxisShapes d = make_axis_shapes(get_deflection_axis(grid), states.deflection);
  const AxisShapes v = make_axis_shapes(get_velocity_axis(grid), states.velocity);
  for (Index i = 1; i < v.columns.cols(); ++i) {
    basis.shapes.push_back(
        {MapShare::kVelocity, v.roughness(i), calc_product(d.one, v.columns.col(i))});
  }
  for (Index i = 1; i < d.columns.cols(); ++i) {
    basis.shapes.push_back(
        {MapShare::kDeflection, d.roughness(i), calc_product(d.columns.col(i), v.one)});
  }
  const Index rows = std::min<Index>(d.columns.cols(), 1 + options.joint_deflection);
  const Index columns = std::min<Index>(v.columns.cols(), 1 + options.joint_velocity);
  for (Index i = 0; i < rows; ++i) {
    for (Index j = 0; j < columns; ++j) {
      basis.shapes.push_back({MapShare::kJoint, d.roughness(i) * v.roughness(j),
                              calc_product(d.columns.col(i), v.columns.col(j))});
    }
  }
  return basis;
}

ForceMap add_shapes(const MapBasis& basis, const Eigen::VectorXd& factors) {
  Eigen::VectorXd sum = Eigen::Map<const Eigen::VectorXd>(
      basis.grid.coefficients.data(), static_cast<Index>(basis.grid.coefficients.size()));
  for (std::size_t i = 0; i < basis.shapes.size(); ++i) {
    sum += factors(static_cast<Index>(i)) * basis.shapes[i].coefficients;
  }
  ForceMap map = basis.grid;
  map.coefficients.assign(sum.data(), sum.data() + sum.size());
  return map;
}

}  // namespace strut
