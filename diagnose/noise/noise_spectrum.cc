#include "diagnose/noise/noise_spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "base/error/input_error.h"
#include "base/math/all_finite.h"
#include "base/parallel/team.h"
#include "diagnose/noise/smooth_road.h"
#include "estimate/simulate_run.h"
#include "model/scenario/road_density.h"

namespace strut {
namespace {

using Spectrum = std::vector<std::complex<double>>;

constexpr double kPi = std::numbers::pi;
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

/// Channels by frequencies of a transform of `length` samples.
Eigen::MatrixXcd make_source(const NoiseSpectrum& s, std::size_t length) {
  return Eigen::MatrixXcd::Zero(static_cast<Eigen::Index>(s.sigma.size()),
                                static_cast<Eigen::Index>(length / 2 + 1));
}

// --- cars ---------------------------------------------------------------------------------------

constexpr double kPulseTime = 0.016, kPulseStart = 0.1;  // s; first zero of its spectrum: 125 Hz
constexpr double kPulseHeight = 1e-4;                    // m
constexpr double kHighest = 100.0;  // Hz; beyond, a road moves nothing that is measured
/// Responses are computed at so many frequencies for each of a run's transform: a run is short, and
/// its ends spread every frequency over the next ones.
constexpr std::size_t kFiner = 4;

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
  const double wheelbase = c.vehicle.whole.wheelbase();
  c.maneuver.road = RoadSpec{};
  c.maneuver.road.shape = BumpShape::kCosine;
  c.maneuver.road.height = height;
  c.maneuver.road.length = kPulseTime * c.maneuver.speed;
  c.maneuver.road.side = side;
  c.maneuver.bump_distance = kPulseStart * c.maneuver.speed;
  if (axle == PulseAxle::kRear) c.maneuver.bump_distance -= wheelbase;
  c.maneuver.duration =
      std::min(kLongestResponse, static_cast<double>(kFiner * s.samples) * s.interval);
  SamplePlan plan;
  plan.interval = s.interval;
  plan.snapshot = false;
  const LaneRun run = simulate_smooth_road(c, plan);
  std::vector<std::vector<double>> responses;
  responses.reserve(channels.size());
  for (const MeasuredChannel& m : channels) responses.push_back(run.get_series(m.channel));
  return responses;
}

/// Transforms, by channel, of the response to a pulse of one track under each axle.
struct TrackResponse {
  std::vector<Spectrum> front, rear;
};

TrackResponse calc_track_response(const Case& c, const NoiseSpectrum& s,
                                  const std::vector<MeasuredChannel>& channels, BumpSide side) {
  const double wheelbase = c.vehicle.whole.wheelbase();
  const auto rest = simulate_pulse(c, s, channels, 0.0, side, PulseAxle::kBoth);
  const auto both = simulate_pulse(c, s, channels, kPulseHeight, side, PulseAxle::kBoth);
  const auto rear = simulate_pulse(c, s, channels, kPulseHeight, side, PulseAxle::kRear);
  TrackResponse response;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    std::vector<double> of_both(both[k]), of_rear(rear[k]);
    for (std::size_t i = 0; i < of_both.size(); ++i) of_both[i] -= rest[k][i];
    for (std::size_t i = 0; i < of_rear.size(); ++i) of_rear[i] -= rest[k][i];
    Spectrum front = calc_transform(of_both, kFiner * s.samples);
    const Spectrum later = calc_transform(of_rear, kFiner * s.samples);
    for (std::size_t f = 0; f < front.size(); ++f) {
      const double frequency =
          static_cast<double>(f) / (static_cast<double>(kFiner * s.samples) * s.interval);
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
  Eigen::MatrixXcd source = make_source(s, kFiner * s.samples);
  const double rate = 1.0 / s.interval;
  for (Eigen::Index f = 0; f < source.cols(); ++f) {
    const double frequency =
        static_cast<double>(f) * rate / static_cast<double>(kFiner * s.samples);
    if (frequency > kHighest) break;
    const double n = std::max(frequency / speed, 1.0 / kLongestWave);
    // Over time.
    const double density = calc_height_density(n) / speed;
    const double per_height = s.interval / (kPulseHeight * calc_pulse_transform(frequency));
    const double amplitude = per_height * std::sqrt(density * rate);
    for (std::size_t k = 0; k < response.size(); ++k) {
      source(static_cast<Eigen::Index>(k), f) =
          amplitude * response[k][static_cast<std::size_t>(f)];
    }
  }
  return source;
}

/// Responses to the road by track and axle.
using WheelSources = std::array<std::array<Eigen::MatrixXcd, 2>, 2>;

/// By frequency of the sources, what four wheels in two tracks do together.
std::vector<Eigen::MatrixXcd> calc_road_covariance(const WheelSources& wheels, double step,
                                                   double speed, double wheelbase, double track) {
  constexpr double kTrusted = 0.9, kDelayError = 10e-3;  // s
  const auto& [left, right] = wheels;
  std::vector<Eigen::MatrixXcd> covariance;
  for (Eigen::Index f = 0; f < left[0].cols(); ++f) {
    const double frequency = static_cast<double>(f) * step;
    if (frequency > kHighest) break;
    const double off = 2.0 * kPi * frequency * kDelayError;
    const std::complex<double> rear_to_front = std::polar(
        kTrusted * std::exp(-0.5 * off * off), -2.0 * kPi * frequency * wheelbase / speed);
    const double alike =
        calc_track_coherence(std::max(frequency / speed, 1.0 / kLongestWave), track);
    Eigen::Matrix2cd along, across;
    along << 1.0, std::conj(rear_to_front), rear_to_front, 1.0;
    across << 1.0, alike, alike, 1.0;
    Eigen::MatrixXcd h(left[0].rows(), 4);
    h << left[0].col(f), left[1].col(f), right[0].col(f), right[1].col(f);
    Eigen::Matrix4cd coherence;
    coherence << across(0, 0) * along, across(0, 1) * along, across(1, 0) * along,
        across(1, 1) * along;
    covariance.emplace_back(h * coherence * h.adjoint());
  }
  return covariance;
}

/// Of a faded record: what its ends spread over the neighbors of each frequency.
std::vector<Eigen::MatrixXcd> spread_covariance(const std::vector<Eigen::MatrixXcd>& fine,
                                                std::size_t samples) {
  constexpr std::size_t kReach = 12 * kFiner;  // of the finer frequencies, to either side
  const Spectrum window =
      calc_transform(make_fade(samples, calc_fade_length(samples)), kFiner * samples);
  std::vector<double> weights;
  double sum = 0.0;
  for (std::size_t m = 0; m <= std::min(kReach, window.size() - 1); ++m) {
    weights.push_back(std::norm(window[m]));
    sum += (m == 0 ? 1.0 : 2.0) * weights.back();
  }
  std::vector<Eigen::MatrixXcd> spread;
  for (std::size_t k = 0; kFiner * k < fine.size(); ++k) {
    Eigen::MatrixXcd at = Eigen::MatrixXcd::Zero(fine[0].rows(), fine[0].cols());
    const auto middle = static_cast<std::ptrdiff_t>(kFiner * k);
    const auto reach = static_cast<std::ptrdiff_t>(weights.size()) - 1;
    for (std::ptrdiff_t m = -reach; m <= reach; ++m) {
      const std::ptrdiff_t f = middle + m;
      const auto place = static_cast<std::size_t>(std::abs(f));
      if (place >= fine.size()) continue;
      const double weight = weights[static_cast<std::size_t>(std::abs(m))] / sum;
      // Negative frequencies are the conjugates of positive ones.
      if (f < 0) {
        at += weight * fine[place].conjugate();
      } else {
        at += weight * fine[place];
      }
    }
    spread.push_back(std::move(at));
  }
  return spread;
}

NoiseSpectrum make_road_spectrum(const CampaignData& data, std::size_t run, int number,
                                 const std::vector<Unknown>& unknowns,
                                 const std::vector<double>& values, RoadRecord record) {
  NoiseSpectrum s = make_white(data, run);
  s.level = 0.0;
  s.fades = true;
  Case c = set_unknowns(data.runs[run], unknowns, values, number).setup.car();
  // The road's faults have no place on this one, and at rest friction would hold the car.
  c.vehicle.effects.clear();
  c.vehicle.force_maps.clear();
  const double speed = c.maneuver.speed;
  WheelSources wheels;
  for (const auto& [side, axles] :
       {std::pair{BumpSide::kLeft, &wheels[0]}, std::pair{BumpSide::kRight, &wheels[1]}}) {
    const TrackResponse response = calc_track_response(c, s, data.channels(run), side);
    (*axles)[0] = make_wheel_source(response.front, speed, s);
    (*axles)[1] = make_wheel_source(response.rear, speed, s);
  }
  const WholeCarSpec& whole = c.vehicle.whole;
  const auto& [front, rear] = c.vehicle.suspension;
  const double step = 1.0 / (static_cast<double>(kFiner * s.samples) * s.interval);
  const std::vector<Eigen::MatrixXcd> fine = calc_road_covariance(
      wheels, step, speed, whole.wheelbase(), front.wheel_center_y + rear.wheel_center_y);
  if (record == RoadRecord::kCutOff) {
    s.common = spread_covariance(fine, s.samples);
  } else {
    for (std::size_t k = 0; kFiner * k < fine.size(); ++k) s.common.push_back(fine[kFiner * k]);
  }
  return s;
}

// --- rigs ---------------------------------------------------------------------------------------

/// What one more source does to all channels.
void add_source(const Eigen::MatrixXcd& source, NoiseSpectrum& s) {
  if (s.common.empty()) {
    s.common.assign(static_cast<std::size_t>(source.cols()),
                    Eigen::MatrixXcd::Zero(source.rows(), source.rows()));
  }
  for (Eigen::Index f = 0; f < source.cols(); ++f) {
    s.common[static_cast<std::size_t>(f)] += source.col(f) * source.col(f).adjoint();
  }
}

/// The run with inputs of zero but for a sample of `pulse` at `begin` in input number `input`, on
/// its way through whatever smooths it: the readings of all channels. Throws InputError.
std::vector<std::vector<double>> simulate_input_pulse(MeasuredRun run, std::size_t input,
                                                      std::size_t begin, double pulse) {
  std::vector<InputSignal>& inputs = run.setup.rig().inputs;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    std::vector<double> samples(run.times.size(), 0.0);
    if (i == input) samples[begin] = pulse;
    inputs[i] =
        make_sampled_input(inputs[i].channel, run.times, samples, run.input_noise[i].smoothing);
  }
  RunCurves curves = simulate_run(run, {}, {});
  if (!curves.failure.empty()) throw InputError(curves.failure);
  return std::move(curves.channel);
}

/// Divides a source by (2 pi i f)^derivative. Drift slower than the run counts as that of half of
/// its lowest frequency, since the biases are unknowns of the fit.
void integrate_source(int derivative, const NoiseSpectrum& s, Eigen::MatrixXcd& source) {
  const double step = 1.0 / (static_cast<double>(s.samples) * s.interval);
  for (Eigen::Index f = 0; f < source.cols(); ++f) {
    const double frequency = std::max(static_cast<double>(f), 0.5) * step;
    const std::complex<double> rate(0.0, 2.0 * kPi * frequency);
    source.col(f) /= std::pow(rate, derivative);
  }
}

/// Responses to one wrong sample of each input: differences against the run without it, which a
/// mass without a spring spends falling.
NoiseSpectrum make_driven_spectrum(const CampaignData& data, std::size_t run,
                                   const std::vector<Unknown>& unknowns,
                                   const std::vector<double>& values) {
  NoiseSpectrum s = make_white(data, run);
  MeasuredRun measured = set_unknowns(data.runs[run], unknowns, values);
  const std::vector<double> times = measured.times;
  RigSpec& rig = measured.setup.rig().rig;
  rig.effects.clear();
  rig.force_maps.clear();
  rig.initial_position = {};
  rig.initial_velocity = {};
  // Number of readings before a pulse, enough for whole smoothing windows around it.
  const auto count_before = [&](const InputNoise& noise) {
    return static_cast<std::size_t>(2.0 * noise.smoothing.half_width / s.interval) + 4;
  };
  std::size_t longest = static_cast<std::size_t>(kLongestResponse / s.interval) + 2;
  for (const InputNoise& noise : measured.input_noise) longest += count_before(noise);
  longest = std::min(times.size(), longest);
  measured.times.resize(longest);
  const auto rest = simulate_input_pulse(measured, 0, 0, 0.0);
  for (std::size_t input = 0; input < measured.input_noise.size(); ++input) {
    const InputNoise noise = measured.input_noise[input];
    if (!(noise.sigma > 0.0)) continue;
    const std::size_t begin = std::min(longest / 2, count_before(noise));
    const auto response = simulate_input_pulse(measured, input, begin, noise.sigma);
    Eigen::MatrixXcd source = make_source(s, s.samples);
    for (std::size_t k = 0; k < data.channels(run).size(); ++k) {
      const auto channel = static_cast<std::size_t>(data.channels(run)[k].channel);
      std::vector<double> series = response[channel];
      for (std::size_t t = 0; t < series.size(); ++t) series[t] -= rest[channel][t];
      const Spectrum of = calc_transform(series, s.samples);
      for (Eigen::Index f = 0; f < source.cols(); ++f) {
        source(static_cast<Eigen::Index>(k), f) = of[static_cast<std::size_t>(f)];
      }
    }
    integrate_source(noise.derivative, s, source);
    add_source(source, s);
  }
  return s;
}

/// Throws InputError where the noise of a run is not finite.
void check_finite(const NoiseSpectrum& s, const std::string& run) {
  const bool is_finite =
      all_finite(s.sigma) &&
      std::all_of(s.common.begin(), s.common.end(), [](const auto& c) { return c.allFinite(); });
  if (!is_finite) {
    throw InputError(fmt::format(
        "{}: the noise of its channels is not finite: the nominal model cannot be simulated there",
        run));
  }
}

}  // namespace

std::size_t find_noise_band(double frequency) {
  std::size_t band = 0;
  while (frequency >= kNoiseBands[band]) ++band;
  return band;
}

std::size_t calc_fade_length(std::size_t count) {
  constexpr double kShare = 0.05;
  return static_cast<std::size_t>(kShare * static_cast<double>(count));
}

std::vector<double> make_fade(std::size_t count, std::size_t length) {
  std::vector<double> fade(count, 1.0);
  for (std::size_t i = 0; i < length; ++i) {
    const double way = (static_cast<double>(i) + 0.5) / static_cast<double>(length);
    fade[i] = fade[count - 1 - i] = 0.5 - 0.5 * std::cos(kPi * way);
  }
  return fade;
}

double calc_common_variance(const NoiseSpectrum& s, std::size_t channel) {
  double variance = 0.0;
  const auto at = static_cast<Eigen::Index>(channel);
  for (std::size_t k = 0; k < s.common.size(); ++k) {
    // Every frequency stands for its negative, too, but for the ends of the spectrum.
    const double both = k == 0 || 2 * k == s.samples ? 1.0 : 2.0;
    variance += both * s.common[k](at, at).real() / static_cast<double>(s.samples);
  }
  return variance;
}

double calc_noise_variance(const NoiseSpectrum& s, std::size_t channel) {
  return s.sigma[channel] * s.sigma[channel] + s.level * calc_common_variance(s, channel);
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
                                              const std::vector<double>& values, RoadRecord record,
                                              int threads) {
  std::vector<NoiseSpectrum> spectra(runs.size());
  share_items(threads, runs.size(), [&](std::size_t i, int) {
    spectra[i] = data.has_inputs() ? make_driven_spectrum(data, runs[i], unknowns, values)
                                   : make_road_spectrum(data, runs[i], static_cast<int>(i),
                                                        unknowns, values, record);
  });
  for (std::size_t i = 0; i < runs.size(); ++i) {
    check_finite(spectra[i], data.runs[runs[i]].name);
  }
  return spectra;
}

}  // namespace strut
