#include "diagnose/compare/car_balance.h"

#include <algorithm>
#include <array>

#include "base/error/input_error.h"
#include "diagnose/noise/whitened_fit.h"

namespace strut {
namespace {

using C = CarChannel;

constexpr std::array<const char*, 4> kStrutNames = {"front_stiffness", "front_damping",
                                                    "rear_stiffness", "rear_damping"};

/// m^3, G0 of the road that stands for what is unknown below the struts. A bump 5 mm higher than
/// surveyed is one of some 1e-5 m^3 (the energy of the bump's spectrum over a crossing of 3 s).
constexpr double kUnknownRoad = 1e-4;
/// Of that road's response, relative; so much of the channels' motion is not relied on.
constexpr double kResponseError = 0.003;

/// What is wrong below the struts makes forces lengthwise, too, which no h_w has: 10 % in the bump,
/// 20 % in the tires (1 sigma) are fitted along.
struct Below {
  const char* name;
  double share;
  bool is_bump;
};
constexpr std::array<Below, 3> kBelow = {
    {{"bump_height", 0.1, true}, {"bump_length", 0.1, true}, {"tire_stiffness", 0.2, false}}};

bool has_channel(const std::vector<MeasuredChannel>& channels, int channel) {
  return std::any_of(channels.begin(), channels.end(),
                     [&](const MeasuredChannel& c) { return c.channel == channel; });
}

bool has_deflection(const std::vector<MeasuredChannel>& channels, int axle) {
  return has_channel(channels, C::get_corner_channel(2 * axle, C::kSuspensionDeflection)) ||
         has_channel(channels, C::get_corner_channel(2 * axle + 1, C::kSuspensionDeflection));
}

bool can_balance(const CampaignData& data, std::size_t run) {
  if (data.has_inputs()) return false;
  const std::vector<MeasuredChannel>& channels = data.channels(run);
  return (has_channel(channels, C::kImuAccelerationZ) ||
          has_channel(channels, C::kBodyAccelerationZ)) &&
         has_deflection(channels, kFront) && has_deflection(channels, kRear);
}

bool is_own(const Unknown& u) {
  return std::find(kStrutNames.begin(), kStrutNames.end(), u.name) != kStrutNames.end() ||
         std::any_of(kBelow.begin(), kBelow.end(),
                     [&](const Below& b) { return u.name == b.name; });
}

/// The values without gain errors and skews of sensors: a wrong road moves these in the
/// calibration, and the balance is to be independent of it.
SharedValues without_sensor_errors(const SharedValues& shared) {
  SharedValues kept;
  for (std::size_t i = 0; i < shared.unknowns.size(); ++i) {
    const Unknown& u = shared.unknowns[i];
    if (is_sensor_tolerance(u)) continue;
    kept.unknowns.push_back(u);
    kept.values.push_back(shared.values[i]);
  }
  return kept;
}

/// What the balance fits, and where it begins.
struct Start {
  std::vector<Unknown> unknowns;
  std::vector<double> values;

  void add(const Unknown& u, double value) {
    unknowns.push_back(u);
    unknowns.back().start = value;
    values.push_back(value);
  }
};

/// The struts', what is below them, what is known by a prior, the run's own. `data`: the run alone,
/// set to where it begins.
Start make_start(const CampaignData& data, const SharedValues& shared, const RunEvaluation& at) {
  Start start;
  for (const char* name : kStrutNames) {
    const Unknown u = make_parameter(data.runs, name);
    start.add(u, u.start);
  }
  const std::vector<MeasuredRun> cars = {
      set_unknowns(data.runs.front(), at.unknowns, at.values, 0)};
  for (const Below& below : kBelow) {
    if (below.is_bump && !cars.front().setup.car().maneuver.road.has_formula()) continue;
    Unknown u = make_parameter(cars, below.name);
    if (!(u.start > 0.0)) continue;  // a level road
    u.prior = {u.start, below.share * u.start};
    start.add(u, u.start);
  }
  for (std::size_t i = 0; i < shared.unknowns.size(); ++i) {
    const Unknown& u = shared.unknowns[i];
    const bool is_weighed = u.kind == UnknownKind::kParameter && u.prior.informs();
    if (is_weighed && !is_own(u)) start.add(u, shared.values[i]);
  }
  for (std::size_t i = 0; i < at.unknowns.size(); ++i) {
    if (!is_own(at.unknowns[i])) start.add(at.unknowns[i], at.values[i]);
  }
  return start;
}

/// Mean square of the whitened readings at the fit, without what the fit counted as noise.
double calc_left(const CampaignData& data, const WhitenedFit& fit) {
  const auto model = make_reading_model(data, {0}, fit.fit.unknowns);
  const Evaluation at = model->evaluate(fit.fit.values);
  if (!at.failure.empty()) throw InputError(at.failure);
  NoiseSpectrum plain = fit.spectra.front();
  std::fill(plain.excess.begin(), plain.excess.end(), 1.0);
  const Whitener whitener(*model, {plain});
  const Eigen::VectorXd left = whitener.apply_residual(at.residual);
  const auto count = static_cast<Eigen::Index>(whitener.whitened_count());
  return left.head(count).squaredNorm() / (static_cast<double>(count) * whitener.get_share(0));
}

}  // namespace

std::optional<CarBalance> calc_car_balance(const CampaignData& data, std::size_t run,
                                           const SharedValues& shared, const RunEvaluation& at,
                                           int threads) {
  if (!can_balance(data, run) || !at.failure.empty()) return std::nullopt;
  const CampaignData one = pin_run(data, run, without_sensor_errors(shared));
  const Start start = make_start(one, shared, at);
  std::vector<NoiseSpectrum> spectra =
      make_noise_spectra(one, {0}, start.unknowns, start.values, RoadRecord::kWithin);
  spectra.front().level = kUnknownRoad;
  spectra.front().response_error = kResponseError;
  const WhitenedFit fit =
      fit_whitened(one, {0}, {spectra}, start.unknowns, start.values, kStrutNames.size(), threads);
  CarBalance balance;
  for (std::size_t i = 0; i < kStrutNames.size(); ++i) {
    const Unknown& u = fit.fit.unknowns[i];
    balance.parameters.push_back({u.name, u.unit, fit.fit.values[i], fit.fit.widened.sigma[i]});
  }
  balance.chi2_per_reading = calc_left(one, fit);
  return balance;
}

}  // namespace strut
