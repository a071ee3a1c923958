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

/// D = c / (2 sqrt(k m)), with the logarithmic derivatives of its parts.
PlateFigure calc_lehr(const FitResult& fit, const std::vector<Fitted>& springs, Fitted mass) {
  double stiffness = 0.0;
  for (const Fitted s : springs) stiffness += fit.values[s];
  PlateFigure d;
  d.value = fit.values[kDamper] / (2.0 * std::sqrt(stiffness * fit.values[mass]));
  d.frequency = std::sqrt(stiffness / fit.values[mass]) / (2.0 * std::numbers::pi);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fit.values.size()));
  gradient(kDamper) = d.value / fit.values[kDamper];
  for (const Fitted s : springs) gradient(s) = -0.5 * d.value / stiffness;
  gradient(mass) = -0.5 * d.value / fit.values[mass];
  d.sigma = std::sqrt(gradient.dot(fit.widened.covariance * gradient));
  return d;
}

}  // namespace

FitResult fit_plate(const PlateRecord& record, const RigSpec& rig, double noise, int threads) {
  MeasuredRun run{record.name, RigCase{rig, {}}, record.times, {}};
  const RigInfo& info = get_rig_info(RigKind::kQuarterCar);
  STRUT_CHECK(rig.kind == RigKind::kQuarterCar, "fit_plate: the rig must be a quarter car");
  for (double& t : run.times) t -= record.times.front();
  run.setup.rig().inputs = {
      make_signal(info.inputs.front().name, run.times, record.position, Interpolation::kSpline)};
  run.input_noise.emplace_back();
  run.channels = {{QuarterCarChannel::kTireForce, noise, record.force}};
  check_measured_run(run);
  double load = 0.0;
  for (const double f : record.force) load += f / static_cast<double>(record.force.size());
  const std::vector<MeasuredRun> runs = {run};
  FitOptions options;
  options.linearize.threads = threads;
  return fit_simulation(runs, make_unknowns(runs, load), options);
}

LehrDamping calc_lehr_damping(const FitResult& fit) {
  return {calc_lehr(fit, {kSpring}, kBody), calc_lehr(fit, {kSpring, kTire}, kWheel)};
}

}  // namespace strut
