#include "diagnose/discrepancy/map_shape.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/math/spread.h"
#include "base/text/format_number.h"
#include "base/text/range.h"
#include "diagnose/discrepancy/map_axis.h"

namespace strut {
namespace {

using Index = Eigen::Index;
using Values = std::vector<double>;

constexpr std::size_t kCurvePoints = 81;
/// Relative curvature, by mean squares, below which a bend is rounding error.
constexpr double kStraight = 1e-6;

/// Name of the direction in which a strut grows longer.
std::string name_outward(MapVariable variable) {
  return variable == MapVariable::kVelocity ? "rebound" : "extension";
}

/// The curve over the visited range without its extremes.
MapCurve make_curve(const MapAxis& axis, const Eigen::VectorXd& coefficients,
                    const Values& samples) {
  constexpr double kExtreme = 0.005;
  const double low = calc_quantile(samples, kExtreme),
               high = calc_quantile(samples, 1.0 - kExtreme);
  MapCurve curve;
  for (std::size_t i = 0; i < kCurvePoints; ++i) {
    const double theta = static_cast<double>(i) / (kCurvePoints - 1);
    curve.x.push_back(low + theta * (high - low));
    curve.force.push_back(axis.calc_splines(curve.x.back()).dot(coefficients));
  }
  return curve;
}

/// The curve at x by straight lines between its points; x within them.
double interpolate(const MapCurve& curve, double x) {
  const double step = (curve.x.back() - curve.x.front()) / static_cast<double>(curve.x.size() - 1);
  const double at =
      std::clamp((x - curve.x.front()) / step, 0.0, static_cast<double>(curve.x.size() - 1) - 1e-9);
  const auto i = static_cast<std::size_t>(at);
  const double theta = at - static_cast<double>(i);
  return (1.0 - theta) * curve.force[i] + theta * curve.force[i + 1];
}

/// Force over the distance from rest in one direction, positive for a spring or damper, and its
/// straight line.
struct Side {
  Values x, force;
  double offset = 0.0, slope = 0.0;  // of the line
  double bend = 0.0;                 // mean square about the line
  double mean = 0.0;                 // of the force

  double calc_power() const {
    double sum = 0.0;
    for (const double f : force) sum += f * f;
    return sum / static_cast<double>(force.size());
  }
  /// Mean square about the best straight line through rest.
  double calc_power_about_ray() const {
    double xx = 0.0, xf = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      xx += x[i] * x[i];
      xf += x[i] * force[i];
    }
    return calc_power() - xf * xf / (xx * static_cast<double>(x.size()));
  }
  void fit_line() {
    const auto n = static_cast<double>(x.size());
    double mean_x = 0.0, xx = 0.0, xf = 0.0;
    mean = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      mean_x += x[i] / n;
      mean += force[i] / n;
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      xx += (x[i] - mean_x) * (x[i] - mean_x);
      xf += (x[i] - mean_x) * (force[i] - mean);
    }
    slope = xf / xx;
    offset = mean - slope * mean_x;
    bend = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double off = force[i] - offset - slope * x[i];
      bend += off * off / n;
    }
  }
};

Side make_side(const MapCurve& curve, double reach, double sign) {
  // Nearer to rest, splines round off a step.
  constexpr double kInner = 0.08;
  constexpr std::size_t kPoints = 41;
  // Nothing is known nearer to rest than the visited range.
  const double nearest = sign > 0.0 ? curve.x.front() : -curve.x.back();
  const double from = std::max(kInner * reach, nearest);
  Side side;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double theta = static_cast<double>(i) / (kPoints - 1);
    const double x = from + (reach - from) * theta;
    side.x.push_back(x);
    side.force.push_back(sign * interpolate(curve, sign * x));
  }
  side.fit_line();
  return side;
}

Side combine(const Side& a, const Side& b, double sign) {
  Side mixed = a;
  for (std::size_t i = 0; i < mixed.x.size(); ++i) {
    mixed.force[i] = 0.5 * (a.force[i] + sign * b.force[i]);
  }
  mixed.fit_line();
  return mixed;
}

std::string format_location(double x, MapVariable variable) {
  const bool is_speed = variable == MapVariable::kVelocity;
  const double shown = is_speed ? x : 1e3 * x;
  const double unit = std::pow(10.0, std::floor(std::log10(shown)) - 1.0);
  return format_rounded(std::round(shown / unit) * unit) + (is_speed ? " m/s" : " mm");
}

/// Describes whether the slope falls or grows with the distance from rest, and where.
std::string describe_bend(const Side& side, MapVariable variable) {
  const std::size_t n = side.x.size() - 1, third = n / 3;
  const auto get_slope = [&](std::size_t from, std::size_t to) {
    return (side.force[to] - side.force[from]) / (side.x[to] - side.x[from]);
  };
  const double inner = get_slope(0, third), outer = get_slope(n - third, n);
  const double middle = 0.5 * (inner + outer);
  constexpr std::size_t kWidth = 3;
  std::size_t at = 0;
  while (at + kWidth < n && (get_slope(at, at + kWidth) - middle) * (inner - middle) > 0.0) ++at;
  const std::string where =
      format_location(side.x[at] + 0.5 * (side.x[kWidth] - side.x[0]), variable);
  if (variable == MapVariable::kVelocity) {
    return outer < inner ? "saturates above " + where : "grows more steeply above " + where;
  }
  return outer < inner ? "softens beyond " + where : "hardens beyond " + where;
}

/// Describes the step or kink at rest of a curve that is straight on both sides.
std::string describe_rest(const Side& up, const Side& down, MapVariable variable) {
  const double reach = up.x.back();
  const double step = up.offset + down.offset, kink = 0.5 * reach * (up.slope - down.slope);
  const std::string rest = variable == MapVariable::kVelocity ? "standstill" : "rest";
  if (std::abs(step) > std::abs(kink)) return "a step at " + rest;
  const std::string out = name_outward(variable);
  return kink > 0.0 ? fmt::format("a kink at {}, stiffer in compression than in {}", rest, out)
                    : fmt::format("a kink at {}, stiffer in {} than in compression", rest, out);
}

/// Coefficients of splines (one column per sample) by least squares.
Eigen::VectorXd fit_splines(const Eigen::MatrixXd& splines, const Eigen::VectorXd& force) {
  Eigen::MatrixXd products = splines * splines.transpose();
  // Regularized: the constant is in both variables' splines, and some splines may be unvisited.
  products.diagonal().array() += 1e-6 * products.trace() / static_cast<double>(products.rows());
  return products.ldlt().solve(splines * force);
}

std::string describe_fraction(const std::string& name, double fraction) {
  return fmt::format("{} ({} %)", name, format_rounded(std::round(100.0 * fraction)));
}

std::string describe(const MapDependence& d) {
  if (d.of_both > std::max(d.of_velocity, d.of_deflection)) {
    return describe_fraction("deflection and velocity together", d.of_both);
  }
  const bool is_velocity = d.of_velocity >= d.of_deflection;
  const std::string shape = is_velocity
                                ? describe_curve(d.over_velocity, MapVariable::kVelocity)
                                : describe_curve(d.over_deflection, MapVariable::kDeflection);
  return (is_velocity ? describe_fraction("velocity", d.of_velocity)
                      : describe_fraction("deflection", d.of_deflection)) +
         (shape.empty() ? "" : ", " + shape);
}

}  // namespace

std::string describe_curve(const MapCurve& curve, MapVariable variable) {
  const double up_reach = std::max(curve.x.back(), 0.0);
  const double down_reach = std::max(-curve.x.front(), 0.0);
  // A side that was hardly visited is ignored.
  constexpr double kOneSided = 0.25;
  const double reach = std::min(up_reach, down_reach), far = std::max(up_reach, down_reach);
  if (reach < kOneSided * far) {
    const Side side = make_side(curve, far, up_reach > down_reach ? 1.0 : -1.0);
    return side.bend > kStraight * side.calc_power() ? describe_bend(side, variable) : "";
  }
  const Side up = make_side(curve, reach, 1.0), down = make_side(curve, reach, -1.0);
  const Side odd = combine(up, down, 1.0), even = combine(up, down, -1.0);
  const double odd_power = odd.calc_power_about_ray();
  const double even_power = even.calc_power() - even.mean * even.mean;
  const double all = odd_power + even_power, bends = up.bend + down.bend;
  constexpr double kPieces = 0.03, kOneDirection = 0.85, kClear = 0.8;
  if (all <= kStraight * (up.calc_power() + down.calc_power())) return "";
  if (0.5 * bends < kPieces * all) return describe_rest(up, down, variable);
  const std::string out = name_outward(variable);
  if (up.bend > kOneDirection * bends) return describe_bend(up, variable) + ", in compression only";
  if (down.bend > kOneDirection * bends) {
    return describe_bend(down, variable) + ", in " + out + " only";
  }
  if (even_power > kClear * all) return "pushes the same way in both directions";
  const bool is_odd = odd_power > kClear * all;
  return describe_bend(odd, variable) + (is_odd
                                             ? ", alike in both directions"
                                             : fmt::format(", unlike in compression and {}", out));
}

MapDependence measure_dependence(const ForceMap& map, const VisitedStates& states) {
  MapDependence result;
  const std::size_t count = states.velocity.size();
  if (count == 0) return result;
  const MapAxis of_v = get_velocity_axis(map), of_d = get_deflection_axis(map);
  const Index nv = of_v.count, nd = of_d.count;
  const Eigen::MatrixXd grid = Eigen::Map<const Eigen::MatrixXd>(map.coefficients.data(), nv, nd);
  Eigen::MatrixXd splines(nv + nd, static_cast<Index>(count));
  Eigen::VectorXd force(splines.cols());
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<Index>(i);
    splines.col(k) << of_v.calc_splines(states.velocity[i]),
        of_d.calc_splines(states.deflection[i]);
    force(k) = splines.col(k).head(nv).dot(grid * splines.col(k).tail(nd));
  }
  force.array() -= force.mean();
  const double power = force.squaredNorm();
  result.spread = std::sqrt(power / static_cast<double>(count));
  const Eigen::VectorXd parts = fit_splines(splines, force);
  result.over_velocity = make_curve(of_v, parts.head(nv), states.velocity);
  result.over_deflection = make_curve(of_d, parts.tail(nd), states.deflection);
  if (power == 0.0) return result;
  const auto calc_fraction = [&](const Eigen::VectorXd& part) {
    return std::clamp((part.array() - part.mean()).matrix().dot(force) / power, 0.0, 1.0);
  };
  result.of_velocity = calc_fraction(splines.topRows(nv).transpose() * parts.head(nv));
  result.of_deflection = calc_fraction(splines.bottomRows(nd).transpose() * parts.tail(nd));
  result.of_both = std::max(0.0, 1.0 - result.of_velocity - result.of_deflection);
  result.words = describe(result);
  return result;
}

}  // namespace strut
