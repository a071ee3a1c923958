#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error/check.h"
#include "estimate/nuisances.h"
#include "identify/plate.h"

namespace strut {
namespace {

/// The parameters of a corner, in the order of RigInfo::fields, without gravity.
enum Fitted : std::size_t { kBody, kWheel, kSpring, kDamper, kTire, kTireDamper, kFittedCount };
static_assert(kFittedCount == kPlateParameters);

std::vector<Unknown> make_unknowns(const std::vector<MeasuredRun>& runs, double static_load) {
  const RigInfo& info = get_rig_info(RigKind::kQuarterCar);
  std::vector<Unknown> unknowns;
  for (std::size_t i = 0; i < kFittedCount; ++i) {
    unknowns.push_back(make_parameter(runs, info.fields[i].name));
  }
  const RigSpec& rig = runs.front().setup.rig().rig;
  Unknown& body = unknowns[kBody];
  body.start = std::clamp(static_load / rig.gravity - rig.unsprung_mass, body.low, body.high);
  for (Unknown& u : make_nuisances(runs, {}, unknowns)) {
    if (u.kind != UnknownKind::kBias) unknowns.push_back(std::move(u));  // the plate weighs the car
  }
  return unknowns;
}

/// A quantity of the fitted corner as a product of powers, whose relative error is linear in those
/// of its factors.
class PowerProduct {
 public:
  explicit PowerProduct(const FitResult& fit)
      : fit_(fit), relative_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fit.values.size()))) {}

  /// Multiplies by the sum of `parts` to the power of `exponent`.
  PowerProduct& multiply(const std::vector<Fitted>& parts, double exponent) {
    double sum = 0.0;
    for (const Fitted p : parts) sum += fit_.values[p];
    for (const Fitted p : parts) relative_(p) += exponent / sum;
    value_ *= std::pow(sum, exponent);
    return *this;
  }

  PlateFigure get(double factor) const {
    const double variance = relative_.dot(fit_.widened.covariance * relative_);
    return {factor * value_, factor * value_ * std::sqrt(variance), 0.0};
  }

 private:
  const FitResult& fit_;
  Eigen::VectorXd relative_;  // derivatives of the quantity's logarithm
  double value_ = 1.0;
};

/// sqrt(k / m) / (2 pi)
PlateFigure calc_mode(const FitResult& fit, const std::vector<Fitted>& springs, Fitted mass) {
  return PowerProduct(fit)
      .multiply(springs, 0.5)
      .multiply({mass}, -0.5)
      .get(0.5 / std::numbers::pi);
}

/// c / (2 sqrt(k m))
PlateFigure calc_lehr(const FitResult& fit, const std::vector<Fitted>& springs, Fitted mass) {
  PlateFigure d = PowerProduct(fit)
                      .multiply({kDamper}, 1.0)
                      .multiply(springs, -0.5)
                      .multiply({mass}, -0.5)
                      .get(0.5);
  d.frequency = calc_mode(fit, springs, mass).value;
  return d;
}

}  // namespace

FitResult fit_plate(const PlateRecord& record, const RigSpec& rig, double static_load, double noise,
                    int threads) {
  MeasuredRun run{record.name, RigCase{rig, {}}, record.times, {}};
  const RigInfo& info = get_rig_info(RigKind::kQuarterCar);
  STRUT_CHECK(rig.kind == RigKind::kQuarterCar, "fit_plate: the rig must be a quarter car");
  for (double& t : run.times) t -= record.times.front();
  run.setup.rig().inputs = {
      make_signal(info.inputs.front().name, run.times, record.position, Interpolation::kSpline)};
  run.input_noise.emplace_back();
  run.channels = {{QuarterCarChannel::kTireForce, noise, record.force}};
  check_measured_run(run);
  const std::vector<MeasuredRun> runs = {run};
  FitOptions options;
  options.linearize.threads = threads;
  return fit_simulation(runs, make_unknowns(runs, static_load), options);
}

PhaseBand calc_phase_band(const FitResult& fit) {
  const PlateFigure body = PowerProduct(fit)
                               .multiply({kSpring}, 0.5)
                               .multiply({kTire}, 0.5)
                               .multiply({kSpring, kTire}, -0.5)
                               .multiply({kBody}, -0.5)
                               .get(0.5 / std::numbers::pi);
  const PlateFigure wheel = calc_mode(fit, {kSpring, kTire}, kWheel);
  return {body.value, wheel.value, wheel.sigma};
}

LehrDamping calc_lehr_damping(const FitResult& fit) {
  return {calc_lehr(fit, {kSpring}, kBody), calc_lehr(fit, {kSpring, kTire}, kWheel)};
}

}  // namespace strut
