#include "tests/hidden/imitation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tests/hidden/fault_range.h"

namespace strut::hidden {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Places of a fault: axles, outputs, or one.
std::vector<int> list_places(const Kit& kit, const FaultInfo& info) {
  std::vector<int> places;
  if (info.where == Where::kChannel) {
    for (std::size_t i = 0; i < kit.sensors.size(); ++i) {
      if (!kit.sensors[i].input) places.push_back(static_cast<int>(i));
    }
    return places;
  }
  const bool has_axles =
      kit.kind == KitKind::kCar && (info.where == Where::kStrut || info.where == Where::kTire);
  return has_axles ? std::vector<int>{0, 1} : std::vector<int>{0};
}

/// Bumps and speeds are nuisances of every fit: under another name they imitate nothing.
bool is_nuisance(const FaultInfo& info) {
  return info.fault == Fault::kBumpHeight || info.fault == Fault::kBumpLength ||
         info.fault == Fault::kSpeedometer;
}

/// So small that the runs change in proportion.
double get_small(const Kit& kit, const FaultInfo& info) {
  return std::max(0.2 * kSmall * get_start(kit, info), find_bracket(kit, info.fault).first);
}

bool is_allowed(const KnownCause& cause, double amount) {
  return amount > 0.0 || get_info(cause.setting.fault).either_sign;
}

/// Cosines of the residual with each cause.
VectorXd calc_overlaps(const VectorXd& residual, const std::vector<KnownCause>& causes) {
  VectorXd overlaps(static_cast<Eigen::Index>(causes.size()));
  for (Eigen::Index i = 0; i < overlaps.size(); ++i) {
    overlaps[i] = causes[static_cast<std::size_t>(i)].direction.dot(residual);
  }
  return overlaps;
}

bool is_same_class(const KnownCause& cause, const VectorXd& residual) {
  return std::fabs(cause.direction.dot(residual)) > kSameClass * residual.norm();
}

}  // namespace

std::vector<KnownCause> list_known_causes(const Detector& detector) {
  const Kit& kit = detector.kit();
  std::vector<KnownCause> causes;
  for (const FaultInfo& info : list_faults()) {
    const bool is_known = *info.effect != '\0' && (info.kits & kit.bit) != 0;
    if (!is_known || is_nuisance(info)) continue;
    for (const int place : list_places(kit, info)) {
      const FaultSetting setting{info.fault, place, get_small(kit, info), 0.0};
      const VectorXd residual = detector.project(detector.calc_deviation({setting}));
      causes.push_back({setting, residual.normalized()});
    }
  }
  return causes;
}

std::vector<CauseName> list_twins(const Kit& kit, const FaultSetting& fault,
                                  const VectorXd& residual, const std::vector<KnownCause>& causes) {
  std::vector<CauseName> twins;
  for (const KnownCause& cause : causes) {
    // A worn joint is bare metal, a mount, around a gap.
    const bool is_part = fault.fault == Fault::kPlay && cause.setting.fault == Fault::kMount &&
                         cause.setting.place == fault.place;
    const bool is_itself = cause.setting.fault == fault.fault && cause.setting.place == fault.place;
    if (is_itself || !is_allowed(cause, cause.direction.dot(residual))) continue;
    if (is_part || is_same_class(cause, residual)) {
      twins.push_back({get_info(cause.setting.fault).effect, get_place(kit, cause.setting)});
    }
  }
  return twins;
}

double calc_beyond_one(const VectorXd& residual, const std::vector<KnownCause>& causes) {
  const VectorXd overlaps = calc_overlaps(residual, causes);
  double taken = 0.0;
  for (Eigen::Index i = 0; i < overlaps.size(); ++i) {
    if (!is_allowed(causes[static_cast<std::size_t>(i)], overlaps[i])) continue;
    taken = std::max(taken, overlaps[i] * overlaps[i]);
  }
  return std::sqrt(std::max(residual.squaredNorm() - taken, 0.0));
}

double calc_beyond_two(const VectorXd& residual, const std::vector<KnownCause>& causes,
                       const std::vector<VectorXd>& hidden) {
  const VectorXd overlaps = calc_overlaps(residual, causes);
  double taken = residual.squaredNorm() - std::pow(calc_beyond_one(residual, causes), 2);
  const auto is_hidden_pair = [&](const KnownCause& a, const KnownCause& b) {
    return hidden.size() == 2 && ((is_same_class(a, hidden[0]) && is_same_class(b, hidden[1])) ||
                                  (is_same_class(a, hidden[1]) && is_same_class(b, hidden[0])));
  };
  for (std::size_t a = 0; a < causes.size(); ++a) {
    for (std::size_t b = a + 1; b < causes.size(); ++b) {
      const double cosine = causes[a].direction.dot(causes[b].direction);
      const double free = 1.0 - cosine * cosine;
      if (free < 1e-6 || is_hidden_pair(causes[a], causes[b])) continue;
      const double u = overlaps[static_cast<Eigen::Index>(a)],
                   v = overlaps[static_cast<Eigen::Index>(b)];
      const double of_a = (u - cosine * v) / free, of_b = (v - cosine * u) / free;
      if (!is_allowed(causes[a], of_a) || !is_allowed(causes[b], of_b)) continue;
      taken = std::max(taken, of_a * u + of_b * v);
    }
  }
  return std::sqrt(std::max(residual.squaredNorm() - taken, 0.0));
}

}  // namespace strut::hidden
