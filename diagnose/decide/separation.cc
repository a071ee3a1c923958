#include "diagnose/decide/separation.h"

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "diagnose/campaign/campaign_unknowns.h"
#include "diagnose/decide/probability.h"
#include "diagnose/noise/whitener.h"
#include "estimate/simulate_run.h"
#include "model_files/read_model.h"

namespace strut {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The run at `from`, with the noise-free readings of `to`; false where `to` cannot be simulated.
bool replace_readings(MeasuredRun& run, const SharedValues& from, const SharedValues& to) {
  const RunCurves curves = simulate_run(run, to.unknowns, to.values);
  if (!curves.failure.empty()) return false;
  for (MeasuredChannel& c : run.channels) {
    c.values = curves.channel[static_cast<std::size_t>(c.channel)];
  }
  run.may_miss = true;
  run = set_unknowns(run, from.unknowns, from.values);
  return true;
}

/// A fit of the model at `from` to the noise-free readings of `to`, where it begins.
struct Comparison {
  std::unique_ptr<ReadingModel> model;
  std::vector<double> values;
};

std::optional<Comparison> compare(CampaignData one, const Rivals& rivals, const SharedValues& from,
                                  const SharedValues& to) {
  if (!replace_readings(one.runs[0], from, to)) return std::nullopt;
  std::vector<Unknown> unknowns = rivals.shared;
  std::vector<double> values = rivals.values;
  for (Unknown& u : make_run_unknowns(one, {0}, rivals.shared)) {
    // A possible run may have another speed than the existing one that its prior is for.
    if (u.kind == UnknownKind::kParameter) {
      u.start = u.prior.mean = get_parameter(one.runs[0].setup, u.name);
    }
    values.push_back(u.start);
    unknowns.push_back(std::move(u));
  }
  return Comparison{make_reading_model(one, {0}, std::move(unknowns)), std::move(values)};
}

const Candidate* find_candidate(const SelectRound& round, const std::string& effect,
                                const std::string& place) {
  for (const Candidate& c : round.candidates) {
    if (c.hypothesis.effect == effect && c.hypothesis.place == place) return &c;
  }
  return nullptr;
}

/// The values with the hypothesis' effect, whose parameters are the last, off.
SharedValues switch_off(const CampaignData& data, const Candidate& c) {
  SharedValues plain = c.shared;
  const auto parameters = list_effect_parameters(*find_effect(c.hypothesis.effect), data.model());
  const std::size_t first = plain.values.size() - c.hypothesis.parameters.size();
  for (std::size_t i = 0; i < c.hypothesis.parameters.size(); ++i) {
    if (c.hypothesis.parameters[i].switches) plain.values[first + i] = parameters[i]->neutral;
  }
  return plain;
}

/// Adds the shared unknowns of the fit without hypotheses, with its standard errors as priors.
void add_shared(const FitResult& fit, std::size_t count, Rivals& rivals) {
  for (std::size_t i = 0; i < count; ++i) {
    Unknown u = fit.unknowns[i];
    if (u.kind != UnknownKind::kParameter && u.kind != UnknownKind::kInputGain) continue;
    // The run already has the gain.
    const double value = u.kind == UnknownKind::kInputGain ? 1.0 : rivals.a.values[i];
    const double sigma = fit.widened.sigma[i];
    if (sigma > 0.0 && std::isfinite(sigma)) u.prior = {value, sigma};
    rivals.shared.push_back(std::move(u));
    rivals.values.push_back(value);
  }
}

}  // namespace

std::optional<Rivals> find_rivals(const CampaignData& data, const Selection& selection,
                                  const std::string& effect_a, const std::string& place_a,
                                  const std::string& effect_b, const std::string& place_b) {
  for (const SelectRound& round : selection.rounds) {
    const Candidate *a = find_candidate(round, effect_a, place_a),
                    *b = find_candidate(round, effect_b, place_b);
    if (a == nullptr || b == nullptr) continue;
    Rivals rivals{a->shared, b->shared, switch_off(data, *a), round.misfit, {}, {}};
    add_shared(selection.base.fit, selection.base.shared_count, rivals);
    return rivals;
  }
  return std::nullopt;
}

double bound_chi2_between(const CampaignData& one, const NoiseSpectrum& noise,
                          const Rivals& rivals) {
  const auto comparison = compare(one, rivals, rivals.a, rivals.b);
  if (!comparison) return kNan;
  const Evaluation at = comparison->model->evaluate(comparison->values);
  if (!at.failure.empty()) return kNan;
  return Whitener(*comparison->model, {noise}).apply_residual(at.residual).squaredNorm();
}

double calc_chi2_between(const CampaignData& one, const NoiseSpectrum& noise, const Rivals& rivals,
                         const SharedValues& from, const SharedValues& to) {
  const auto comparison = compare(one, rivals, from, to);
  if (!comparison) return kNan;
  const Linearization at = comparison->model->linearize(comparison->values);
  if (!at.failure.empty()) return kNan;
  const Linearization white = Whitener(*comparison->model, {noise}).apply(at);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(white.jacobian);
  const Eigen::VectorXd turned = qr.householderQ().adjoint() * white.residual;
  return turned.tail(turned.size() - qr.rank()).squaredNorm();
}

double calc_separation(const CampaignData& one, const NoiseSpectrum& noise, const Rivals& rivals) {
  const double between = calc_chi2_between(one, noise, rivals, rivals.a, rivals.b);
  const double effect = calc_chi2_between(one, noise, rivals, rivals.plain, rivals.a);
  const double temperature = 1.0 + ProbabilityOptions{}.form_error * effect / rivals.misfit;
  return std::sqrt(between / (rivals.misfit * temperature));
}

}  // namespace strut
