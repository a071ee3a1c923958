#include "estimate/uncertainty.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "estimate/fisher.h"

namespace strut {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Eigenvectors of the information along which sigma exceeds 100 %.
std::vector<NullDirection> find_null_directions(const Eigen::MatrixXd& information) {
  // A nuisance known from its prior alone has an eigenvalue of 1 up to rounding.
  constexpr double kMinEigenvalue = 1.0 - 1e-6;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information);
  const double rounding = kMinInformation * solver.eigenvalues().maxCoeff();
  std::vector<NullDirection> found;
  for (Eigen::Index k = 0; k < information.rows(); ++k) {
    const double value = solver.eigenvalues()(k);
    if (value >= kMinEigenvalue) break;  // ascending
    Eigen::VectorXd v = solver.eigenvectors().col(k);
    Eigen::Index largest = 0;
    v.cwiseAbs().maxCoeff(&largest);
    if (v(largest) < 0.0) v = -v;
    found.push_back(
        {{v.data(), v.data() + v.size()}, value > rounding ? 1.0 / std::sqrt(value) : kInfinity});
  }
  return found;
}

}  // namespace

double Uncertainty::calc_correlation(std::size_t i, std::size_t j) const {
  const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
  const double product = covariance(a, a) * covariance(b, b);
  return product > 0.0 ? covariance(a, b) / std::sqrt(product) : 0.0;
}

Uncertainty calc_uncertainty(const Eigen::MatrixXd& information,
                             const std::vector<Unknown>& unknowns) {
  const InformationInverse inverse = invert_information(information);
  const auto n = static_cast<Eigen::Index>(unknowns.size());
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    scale(i) = inverse.free[at] ? 0.0 : unknowns[at].scale;
  }
  Uncertainty result;
  result.covariance = scale.asDiagonal() * inverse.covariance * scale.asDiagonal();
  result.sigma.reserve(unknowns.size());
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    result.sigma.push_back(inverse.free[i] ? kInfinity : std::sqrt(result.covariance(at, at)));
    result.identifiable.push_back(is_identifiable(result.sigma[i], unknowns[i]));
  }
  result.null_directions = find_null_directions(information);
  result.rank = static_cast<int>(unknowns.size() - result.null_directions.size());
  return result;
}

bool is_identifiable(double sigma, const Unknown& u) { return sigma <= u.scale * (1.0 + 1e-6); }

std::string describe_direction(const NullDirection& direction,
                               const std::vector<Unknown>& unknowns) {
  constexpr double kMinPart = 0.1;
  std::string text;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const double part = direction.parts[i];
    if (std::abs(part) < kMinPart) continue;
    text += text.empty() ? (part < 0.0 ? "-" : "") : (part < 0.0 ? " - " : " + ");
    if (std::abs(part) <= 0.99) text += fmt::format("{:.2g} ", std::abs(part));
    text += unknowns[i].name;
    if (unknowns[i].run > 0) text += fmt::format(" of run {}", unknowns[i].run + 1);
  }
  return text;
}

std::vector<std::string> describe_null_directions(const Uncertainty& uncertainty,
                                                  const std::vector<Unknown>& unknowns) {
  std::vector<std::string> list;
  for (const NullDirection& direction : uncertainty.null_directions) {
    list.push_back(describe_direction(direction, unknowns));
  }
  return list;
}

}  // namespace strut
