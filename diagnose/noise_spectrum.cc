#include "diagnose/noise_spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "diagnose/linearize.h"
#include "io/input_error.h"
#include "sweep/parameters.h"

namespace strut {
namespace {

using Spectrum = std::vector<std::complex<double>>;

constexpr double kPi = 3.14159265358979323846;
constexpr double kLongestResponse = 4.0;  // s, after which a car or a rig is at rest again

Spectrum calc_transform(std::vector<double> series, std::size_t length) {
  series.resize(length, 0.0);
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  fft.SetFlag(Eigen::FFT<double>::Unscaled);
  Spectrum out;
  fft.fwd(out, series);
  return out;
}

NoiseSpectrum make_white(const CampaignData& data, std::size_t run) {
  const std::vector<double>& times = data.times(run);
  NoiseSpectrum s;
  s.samples = find_quick_length(times.size());
  s.interval = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (const MeasuredChannel& c : data.channels(run)) s.sigma.push_back(c.sigma);
  return s;
}

Eigen::MatrixXcd make_source(const NoiseSpectrum& s) {
  return Eigen::MatrixXcd::Zero(static_cast<Eigen::Index>(s.sigma.size()),
                                static_cast<Eigen::Index>(s.samples / 2 + 1));
}

// --- cars ---------------------------------------------------------------------------------------

constexpr double kPulseTime = 0.016, kPulseStart = 0.1;  // s; first zero of its spectrum: 125 Hz
constexpr double kPulseHeight = 1e-4;                    // m
constexpr double kHighest = 100.0;  // Hz; beyond, a road moves nothing that is measured

/// Transform of h / 2 (1 + cos(2 pi t / T)), abs(t) < T / 2, over h.
double calc_pulse_transform(double frequency) {
  const double x = frequency * kPulseTime;
  if (std::abs(x - 1.0) < 1e-6) return 0.25 * kPulseTime;
  const double sinc = x == 0.0 ? 1.0 : std::sin(kPi * x) / (kPi * x);
  return 0.5 * kPulseTime * sinc / (1.0 - x * x);
}

/// Which axles meet the pulse.
enum class PulseAxle { kBoth, kRear };

/// Of a car's run over a small pulse under one track; under the rear axle alone, or first under
/// the front axle and then, a wheelbase later, under the rear one.
std::vector<std::vector<double>> simulate_pulse(Case c, const NoiseSpectrum& s,
                                                const std::vector<MeasuredChannel>& channels,
                                                double height, BumpSide side, PulseAxle axle) {
  const double wheelbase = c.vehicle.whole.centroid_to_front + c.vehicle.whole.centroid_to_rear;
  c.maneuver.road = RoadSpec{};
  c.maneuver.road.shape = BumpShape::kCosine;
  c.maneuver.road.height = height;
  c.maneuver.road.length = kPulseTime * c.maneuver.speed;
  c.maneuver.road.side = side;
  c.maneuver.bump_distance = kPulseStart * c.maneuver.speed;
  if (axle == PulseAxle::kRear) c.maneuver.bump_distance -= wheelbase;
  c.maneuver.duration = std::min(kLongestResponse, static_cast<double>(s.samples) * s.interval);
  SamplePlan plan;
  plan.interval = s.interval;
  plan.snapshot = false;
  CasePreparer preparer;
  const std::vector<LaneRun> runs =
      run_prepared({preparer.prepare(c)}, make_fit_integration(), plan);
  if (runs.front().status() != RunStatus::kDone) {
    throw InputError("the car cannot be simulated on a level road");
  }
  std::vector<std::vector<double>> responses;
  responses.reserve(channels.size());
  for (const MeasuredChannel& m : channels) responses.push_back(runs.front().get_series(m.channel));
  return responses;
}

/// Transforms, by channel, of the response to a pulse of one track under each axle.
struct TrackResponse {
  std::vector<Spectrum> front, rear;
};

TrackResponse calc_track_response(const Case& c, const NoiseSpectrum& s,
                                  const std::vector<MeasuredChannel>& channels, BumpSide side) {
  const double wheelbase = c.vehicle.whole.centroid_to_front + c.vehicle.whole.centroid_to_rear;
  const auto rest = simulate_pulse(c, s, channels, 0.0, side, PulseAxle::kBoth);
  const auto both = simulate_pulse(c, s, channels, kPulseHeight, side, PulseAxle::kBoth);
  const auto rear = simulate_pulse(c, s, channels, kPulseHeight, side, PulseAxle::kRear);
  TrackResponse response;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    std::vector<double> of_both(both[k]), of_rear(rear[k]);
    for (std::size_t i = 0; i < of_both.size(); ++i) of_both[i] -= rest[k][i];
    for (std::size_t i = 0; i < of_rear.size(); ++i) of_rear[i] -= rest[k][i];
    Spectrum front = calc_transform(of_both, s.samples);
    const Spectrum later = calc_transform(of_rear, s.samples);
    for (std::size_t f = 0; f < front.size(); ++f) {
      const double frequency =
          static_cast<double>(f) / (static_cast<double>(s.samples) * s.interval);
      front[f] -= std::polar(1.0, -2.0 * kPi * frequency * wheelbase / c.maneuver.speed) * later[f];
    }
    response.front.push_back(std::move(front));
    response.rear.push_back(later);
  }
  return response;
}

constexpr double kLongestWave = 50.0;  // m; longer ones move no channel

/// The road under one wheel alone.
Eigen::MatrixXcd make_wheel_source(const std::vector<Spectrum>& response, double speed,
                                   const NoiseSpectrum& s) {
  Eigen::MatrixXcd source = make_source(s);
  const double rate = 1.0 / s.interval;
  for (Eigen::Index f = 0; f < source.cols(); ++f) {
    const double frequency = static_cast<double>(f) * rate / static_cast<double>(s.samples);
    if (frequency > kHighest) break;
    const double n = std::max(frequency / speed, 1.0 / kLongestWave);
    // Two-sided density over time of a road with G0 = 1 m^3; n0 = 0.1 1/m.
    const double density = 0.5 * 0.01 / (n * n) / speed;
    const double per_height = s.interval / (kPulseHeight * calc_pulse_transform(frequency));
    const double amplitude = per_height * std::sqrt(density * rate);
    for (std::size_t k = 0; k < response.size(); ++k) {
      source(static_cast<Eigen::Index>(k), f) =
          amplitude * response[k][static_cast<std::size_t>(f)];
    }
  }
  return source;
}

/// How alike two tracks of an isotropic road are, as far as it is relied upon (NoiseSpectrum).
double calc_track_coherence(double wave_number, double track) {
  constexpr double kTrusted = 0.9;
  const double x = 2.0 * kPi * wave_number * track;
  return x < 1e-6 ? kTrusted : kTrusted * x * std::cyl_bessel_k(1.0, std::min(x, 50.0));
}

/// The sources of both tracks under both axles as four that are independent of each other: columns
/// times the Cholesky factors of the coherence along a track and between the tracks.
void add_road_sources(const std::array<std::array<Eigen::MatrixXcd, 2>, 2>& wheels, double speed,
                      double wheelbase, double track, NoiseSpectrum& s) {
  constexpr double kTrusted = 0.95, kDelayError = 1e-3;  // s
  std::array<Eigen::MatrixXcd, 4> sources;
  sources.fill(make_source(s));
  const double rate = 1.0 / s.interval;
  for (Eigen::Index f = 0; f < sources[0].cols(); ++f) {
    const double frequency = static_cast<double>(f) * rate / static_cast<double>(s.samples);
    const double off = 2.0 * kPi * frequency * kDelayError;
    const double same = kTrusted * std::exp(-0.5 * off * off);
    const std::complex<double> later = std::polar(same, -2.0 * kPi * frequency * wheelbase / speed);
    const double other = std::sqrt(1.0 - same * same);
    const double alike =
        calc_track_coherence(std::max(frequency / speed, 1.0 / kLongestWave), track);
    const double apart = std::sqrt(1.0 - alike * alike);
    const auto& [left, right] = wheels;
    const Eigen::VectorXcd left_both = left[0].col(f) + later * left[1].col(f);
    const Eigen::VectorXcd right_both = right[0].col(f) + later * right[1].col(f);
    sources[0].col(f) = left_both + alike * right_both;
    sources[1].col(f) = other * (left[1].col(f) + alike * right[1].col(f));
    sources[2].col(f) = apart * right_both;
    sources[3].col(f) = apart * other * right[1].col(f);
  }
  for (Eigen::MatrixXcd& source : sources) s.sources.push_back(std::move(source));
}

NoiseSpectrum make_car_spectrum(const CampaignData& data, std::size_t run, int number,
                                const std::vector<Unknown>& unknowns,
                                const std::vector<double>& values) {
  NoiseSpectrum s = make_white(data, run);
  s.level = 0.0;
  s.fades = true;
  Case c = data.cars[run].setup;
  set_parameters(c, unknowns, values, number);
  // The road's faults have no place on this one, and at rest friction would hold the car.
  c.vehicle.effects.clear();
  const double speed = c.maneuver.speed;
  std::array<std::array<Eigen::MatrixXcd, 2>, 2> wheels;  // by track and axle
  for (const auto& [side, axles] :
       {std::pair{BumpSide::kLeft, &wheels[0]}, std::pair{BumpSide::kRight, &wheels[1]}}) {
    const TrackResponse response = calc_track_response(c, s, data.channels(run), side);
    (*axles)[0] = make_wheel_source(response.front, speed, s);
    (*axles)[1] = make_wheel_source(response.rear, speed, s);
  }
  const WholeCarSpec& whole = c.vehicle.whole;
  const auto& [front, rear] = c.vehicle.suspension;
  add_road_sources(wheels, speed, whole.centroid_to_front + whole.centroid_to_rear,
                   front.wheel_center_y + rear.wheel_center_y, s);
  return s;
}

// --- rigs ---------------------------------------------------------------------------------------

/// The response to one wrong sample of an input, on its way through whatever smooths it.
NoiseSpectrum make_rig_spectrum(const CampaignData& data, std::size_t run,
                                const std::vector<Unknown>& unknowns,
                                const std::vector<double>& values) {
  NoiseSpectrum s = make_white(data, run);
  RigRun rig = set_rig_unknowns(data.rigs[run], unknowns, values);
  const std::vector<double> times = rig.times;
  rig.setup.effects.clear();
  rig.setup.initial_position = {};
  rig.setup.initial_velocity = {};
  const std::size_t longest =
      std::min(times.size(), static_cast<std::size_t>(kLongestResponse / s.interval) + 2);
  rig.times.resize(longest);
  for (std::size_t input = 0; input < rig.inputs.size(); ++input) {
    const InputNoise& noise = data.rigs[run].input_noise[input];
    if (!(noise.sigma > 0.0)) continue;
    const auto begin =
        std::min(longest / 4, static_cast<std::size_t>(2.0 * noise.half_width / s.interval) + 4);
    for (std::size_t i = 0; i < rig.inputs.size(); ++i) {
      std::vector<double> pulse(longest, 0.0);
      if (i == input) pulse[begin] = noise.sigma;
      rig.inputs[i] = make_sampled_input(rig.inputs[i].channel, rig.times, pulse,
                                         data.rigs[run].input_noise[i].half_width);
    }
    double gain = 1.0;
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      const Unknown& u = unknowns[i];
      if (u.kind != UnknownKind::kInputGain) continue;
      if (list_rig_inputs(rig.setup.kind)[static_cast<std::size_t>(u.channel)].name ==
          rig.inputs[input].channel) {
        gain = values[i];
      }
    }
    const RigCurves curves = simulate_rig_run(rig, 0, {}, {});
    if (!curves.failure.empty()) throw InputError(curves.failure);
    Eigen::MatrixXcd source = make_source(s);
    for (std::size_t k = 0; k < data.channels(run).size(); ++k) {
      std::vector<double> series =
          curves.channel[static_cast<std::size_t>(data.channels(run)[k].channel)];
      const double rest = series.front();
      for (double& v : series) v = std::isnan(v) ? 0.0 : v - rest;
      const Spectrum of = calc_transform(series, s.samples);
      for (Eigen::Index f = 0; f < source.cols(); ++f) {
        source(static_cast<Eigen::Index>(k), f) = gain * of[static_cast<std::size_t>(f)];
      }
    }
    s.sources.push_back(std::move(source));
  }
  return s;
}

}  // namespace

std::size_t find_noise_band(double frequency) {
  std::size_t band = 0;
  while (frequency >= kNoiseBands[band]) ++band;
  return band;
}

double calc_source_variance(const NoiseSpectrum& s, std::size_t channel) {
  double variance = 0.0;
  for (const Eigen::MatrixXcd& source : s.sources) {
    variance += 2.0 * source.row(static_cast<Eigen::Index>(channel)).squaredNorm() /
                static_cast<double>(s.samples);
  }
  return variance;
}

double calc_noise_variance(const NoiseSpectrum& s, std::size_t channel) {
  return s.sigma[channel] * s.sigma[channel] + s.level * calc_source_variance(s, channel);
}

std::size_t find_quick_length(std::size_t n) {
  const auto is_quick = [](std::size_t m) {
    for (const std::size_t factor : {2U, 3U, 5U}) {
      while (m % factor == 0) m /= factor;
    }
    return m == 1;
  };
  while (n > 1 && (n % 2 == 1 || !is_quick(n))) --n;
  return n;
}

std::vector<NoiseSpectrum> make_noise_spectra(const CampaignData& data,
                                              const std::vector<std::size_t>& runs,
                                              const std::vector<Unknown>& unknowns,
                                              const std::vector<double>& values) {
  std::vector<NoiseSpectrum> spectra;
  spectra.reserve(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    spectra.push_back(
        data.is_rig() ? make_rig_spectrum(data, runs[i], unknowns, values)
                      : make_car_spectrum(data, runs[i], static_cast<int>(i), unknowns, values));
  }
  return spectra;
}

}  // namespace strut
