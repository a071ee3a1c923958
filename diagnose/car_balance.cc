#include "diagnose/car_balance.h"

#include <algorithm>
#include <array>

#include "diagnose/whitened_fit.h"

namespace strut {
namespace {

using C = CarChannel;

constexpr std::array<const char*, 4> kStrutNames = {"front_stiffness", "front_damping",
                                                    "rear_stiffness", "rear_damping"};

/// m^3, G0 of the road that stands for everything unknown below the struts. A bump 5 mm higher than
/// surveyed is a road of 1e-5 m^3 (energy of the bump's spectrum over a crossing of 3 s).
constexpr double kUnknownRoad = 1e-3;

bool has_channel(const std::vector<MeasuredChannel>& channels, int channel) {
  return std::any_of(channels.begin(), channels.end(),
                     [&](const MeasuredChannel& c) { return c.channel == channel; });
}

bool has_deflection(const std::vector<MeasuredChannel>& channels, int axle) {
  const int left = C::kCornerBegin + 2 * axle * C::kCornerChannels + C::kSuspensionDeflection;
  return has_channel(channels, left) || has_channel(channels, left + C::kCornerChannels);
}

bool can_balance(const CampaignData& data, std::size_t run) {
  if (data.is_rig()) return false;
  const std::vector<MeasuredChannel>& channels = data.channels(run);
  return (has_channel(channels, C::kImuAccelerationZ) ||
          has_channel(channels, C::kBodyAccelerationZ)) &&
         has_deflection(channels, kFront) && has_deflection(channels, kRear);
}

bool is_strut(const Unknown& u) {
  return std::find(kStrutNames.begin(), kStrutNames.end(), u.name) != kStrutNames.end();
}

struct Start {
  std::vector<Unknown> unknowns;  // the struts', what is known by a prior, the run's own
  std::vector<double> values;
};

Start make_start(const CampaignData& data, const SharedValues& shared, const RunEvaluation& at) {
  Start start;
  const auto add = [&](const Unknown& u, double value) {
    start.unknowns.push_back(u);
    start.unknowns.back().start = value;
    start.values.push_back(value);
  };
  for (const char* name : kStrutNames) {
    const Unknown u = make_parameter(data.cars, name);
    add(u, u.start);
  }
  for (std::size_t i = 0; i < shared.unknowns.size(); ++i) {
    const Unknown& u = shared.unknowns[i];
    const bool is_weighed = u.kind == UnknownKind::kParameter && u.prior.informs();
    if (is_weighed && !is_strut(u)) add(u, shared.values[i]);
  }
  for (std::size_t i = 0; i < at.unknowns.size(); ++i) add(at.unknowns[i], at.values[i]);
  return start;
}

/// Mean square of the whitened readings at the fit, without what the fit counted as noise.
double calc_left(const CampaignData& data, const WhitenedFit& fit) {
  const auto model = make_reading_model(data, {0}, fit.fit.unknowns);
  const Evaluation at = model->evaluate(fit.fit.values);
  if (!at.failure.empty()) return 0.0;
  NoiseSpectrum plain = fit.spectra.front();
  std::fill(plain.excess.begin(), plain.excess.end(), 1.0);
  const Whitener whitener(*model, {plain});
  const Eigen::VectorXd left = whitener.apply(at.residual);
  const auto count = static_cast<Eigen::Index>(whitener.whitened_count());
  return left.head(count).squaredNorm() / (static_cast<double>(count) * whitener.get_share(0));
}

}  // namespace

std::optional<CarBalance> calc_car_balance(const CampaignData& data, std::size_t run,
                                           const SharedValues& shared, const RunEvaluation& at,
                                           int threads) {
  if (!can_balance(data, run) || !at.failure.empty()) return std::nullopt;
  const CampaignData one = pin_run(data, run, shared);
  const Start start = make_start(one, shared, at);
  std::vector<NoiseSpectrum> spectra = make_noise_spectra(one, {0}, start.unknowns, start.values);
  spectra.front().level = kUnknownRoad;
  const WhitenedFit fit =
      fit_whitened(one, {0}, spectra, start.unknowns, start.values, kStrutNames.size(), threads);
  CarBalance balance;
  for (std::size_t i = 0; i < kStrutNames.size(); ++i) {
    const Unknown& u = fit.fit.unknowns[i];
    balance.parameters.push_back({u.name, u.unit, fit.fit.values[i], fit.fit.widened.sigma[i]});
  }
  balance.chi2_per_reading = calc_left(one, fit);
  return balance;
}

}  // namespace strut
