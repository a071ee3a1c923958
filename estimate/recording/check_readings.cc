#include "estimate/recording/check_readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "base/math/spread.h"
#include "base/text/format_number.h"
#include "io/table/summary.h"

namespace strut {
namespace {

const std::string& get_name(const MeasuredRun& run, const MeasuredChannel& c) {
  return run.setup.info().channels[static_cast<std::size_t>(c.channel)].name;
}

/// Smallest difference between two readings; 0 if all are equal.
double find_step(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double same = 1e-9 * std::max(std::abs(values.front()), std::abs(values.back()));
  double step = 0.0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double difference = values[i] - values[i - 1];
    if (difference > same && (step == 0.0 || difference < step)) step = difference;
  }
  return step;
}

std::vector<double> take_readings(const std::vector<double>& values) {
  std::vector<double> readings;
  readings.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(readings),
               [](double v) { return std::isfinite(v); });
  return readings;
}

/// Number of readings on plateaus at `extreme` that cut off a motion: three samples or more, whose
/// ends are so steep that a smooth peak between them would have been higher by more than `missed`.
std::size_t count_cut_off(const std::vector<double>& v, double extreme, double missed) {
  constexpr std::size_t kMinLength = 3;
  std::size_t count = 0;
  for (std::size_t i = 2; i + 2 < v.size();) {
    if (v[i] != extreme) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < v.size() && v[end] == extreme) ++end;
    const std::size_t length = end - i;
    if (length >= kMinLength && end + 1 < v.size()) {
      // A parabola over the plateau with these slopes at its ends rises by slope length / 4.
      const double before = std::abs(v[i - 1] - v[i - 2]), behind = std::abs(v[end + 1] - v[end]);
      const double missing = 0.25 * std::min(before, behind) * static_cast<double>(length);
      if (missing > missed) count += length;
    }
    i = end;
  }
  return count;
}

std::optional<RecordingFinding> check_saturation(const MeasuredRun& run, const MeasuredChannel& c,
                                                 double step) {
  const std::vector<double> v = take_readings(c.values);
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  constexpr double kClear = 4.0;  // several of the sensor's steps, and beyond its noise
  const double missed = kClear * std::max(step, c.sigma);
  const std::size_t at_high = count_cut_off(v, *high, missed),
                    at_low = count_cut_off(v, *low, missed);
  const std::size_t count = at_high + at_low;
  if (count == 0) return std::nullopt;
  return RecordingFinding{FindingKind::kSaturation,
                          run.name,
                          get_name(run, c),
                          static_cast<double>(count),
                          fmt::format("is cut off at {} in {} samples",
                                      format_rounded(at_high > 0 ? *high : *low), count),
                          "the sensor's range? cut the run's window"};
}

/// `spread`: the channel's in the run in which it moves most, since a quiet run is no fault of the
/// sensor.
std::optional<RecordingFinding> check_quantization(const MeasuredRun& run, const MeasuredChannel& c,
                                                   double step, double spread) {
  constexpr double kCoarse = 0.1;
  if (!(step > kCoarse * spread)) return std::nullopt;
  return RecordingFinding{
      FindingKind::kQuantization,
      run.name,
      get_name(run, c),
      step,
      fmt::format("has steps of {}, {} of its standard deviation", format_significant(step, 2),
                  format_significant(step / spread, 2)),
      "too few digits in the file, or too large a range of the sensor?"};
}

/// The largest m 2^k that is not above `count`, m < 32: a length of quick transforms.
std::size_t find_quick_size(std::size_t count) {
  const int shift = std::max(0, static_cast<int>(std::bit_width(count)) - 5);
  return count >> shift << shift;
}

/// Squared amplitudes of the frequencies k / (n interval), by a Hann window.
std::vector<double> calc_lines(std::vector<double> v) {
  const double mean = calc_mean(v), n = static_cast<double>(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(i) / n;
    v[i] = (v[i] - mean) * (1.0 - std::cos(phase));
  }
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double> fft;
  fft.fwd(spectrum, v);
  std::vector<double> lines(v.size() / 2);
  for (std::size_t k = 0; k < lines.size(); ++k) lines[k] = std::norm(2.0 * spectrum[k] / n);
  return lines;
}

/// A line that stands out from all that is within 5 Hz, and from the noise.
std::optional<RecordingFinding> check_mains(const MeasuredRun& run, const MeasuredChannel& c) {
  constexpr double kWithin = 5.0, kMinDuration = 2.0, kMinPower = 8.0, kMinAmplitude = 0.5;
  constexpr double kDrift = 0.2;  // Hz, of the mains and of the recording's clock
  std::vector<double> v = take_readings(c.values);
  const double duration = run.times.back() - run.times.front();
  if (duration < kMinDuration || v.size() != c.values.size()) return std::nullopt;
  const double rate = static_cast<double>(v.size() - 1) / duration;
  v.resize(find_quick_size(v.size()));
  const double resolution = rate / static_cast<double>(v.size());
  const std::vector<double> lines = calc_lines(std::move(v));
  for (const double frequency : {50.0, 60.0, 100.0, 120.0}) {
    const double own_width = std::max(3.0 * resolution, kDrift + resolution);
    double own = 0.0, other = 0.0;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const double distance = std::abs(resolution * static_cast<double>(k) - frequency);
      if (distance <= own_width) own = std::max(own, lines[k]);
      if (distance > own_width && distance <= kWithin) other = std::max(other, lines[k]);
    }
    if (resolution * static_cast<double>(lines.size()) < frequency + kWithin) break;
    const double amplitude = std::sqrt(own);
    if (own < kMinPower * other || amplitude < kMinAmplitude * c.sigma) continue;
    return RecordingFinding{FindingKind::kMains,
                            run.name,
                            get_name(run, c),
                            frequency,
                            fmt::format("has a line at {} Hz with an amplitude of {}", frequency,
                                        format_significant(amplitude, 2)),
                            "the mains?"};
  }
  return std::nullopt;
}

/// Adds each kind's largest finding of every channel, with the number of other runs that have it.
void add_worst(const std::vector<RecordingFinding>& all, std::vector<RecordingFinding>& findings) {
  std::set<std::pair<FindingKind, std::string>> seen;
  for (const RecordingFinding& f : all) {
    if (!seen.insert({f.kind, f.channel}).second) continue;
    const auto same = [&](const RecordingFinding& other) {
      return other.kind == f.kind && other.channel == f.channel;
    };
    RecordingFinding worst =
        *std::max_element(all.begin(), all.end(), [&](const auto& a, const auto& b) {
          return (same(a) ? a.size : -1.0) < (same(b) ? b.size : -1.0);
        });
    const auto others = std::count_if(all.begin(), all.end(), same) - 1;
    if (others > 0) worst.what += fmt::format(" (and in {} other runs)", others);
    findings.push_back(std::move(worst));
  }
}

/// Digests of the sequences of readings that are long and varied enough that none occurs twice by
/// chance, in ascending order.
std::vector<std::uint64_t> list_passages(const std::vector<double>& values) {
  constexpr std::size_t kLength = 16, kVaried = 8;
  std::vector<std::uint64_t> passages;
  for (std::size_t i = 0; i + kLength <= values.size(); ++i) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(i);
    std::array<double, kLength> passage;
    std::copy(begin, begin + kLength, passage.begin());
    const auto is_missing = [](double v) { return std::isnan(v); };
    if (std::any_of(passage.begin(), passage.end(), is_missing)) continue;
    std::uint64_t digest = 14695981039346656037ULL;  // FNV-1a, by words
    for (const double v : passage) {
      digest = (digest ^ std::bit_cast<std::uint64_t>(v)) * 1099511628211ULL;
    }
    std::sort(passage.begin(), passage.end());
    const auto different = std::unique(passage.begin(), passage.end()) - passage.begin();
    if (static_cast<std::size_t>(different) >= kVaried) passages.push_back(digest);
  }
  std::sort(passages.begin(), passages.end());
  passages.erase(std::unique(passages.begin(), passages.end()), passages.end());
  return passages;
}

/// Passages by channel.
using RunPassages = std::map<int, std::vector<std::uint64_t>>;

RunPassages list_passages(const MeasuredRun& run) {
  RunPassages passages;
  for (const MeasuredChannel& c : run.channels) {
    std::vector<std::uint64_t> of_channel = list_passages(c.values);
    if (!of_channel.empty()) passages.emplace(c.channel, std::move(of_channel));
  }
  return passages;
}

/// Fraction of the shorter run's passages that both have, in the channel that has least in common;
/// 0 where no channel can be compared.
double calc_common_fraction(const RunPassages& a, const RunPassages& b) {
  std::optional<double> fraction;
  for (const auto& [channel, of_a] : a) {
    const auto of_b = b.find(channel);
    if (of_b == b.end()) continue;
    std::vector<std::uint64_t> both;
    std::set_intersection(of_a.begin(), of_a.end(), of_b->second.begin(), of_b->second.end(),
                          std::back_inserter(both));
    const auto fewer = static_cast<double>(std::min(of_a.size(), of_b->second.size()));
    fraction = std::min(fraction.value_or(1.0), static_cast<double>(both.size()) / fewer);
  }
  return fraction.value_or(0.0);
}

}  // namespace

std::vector<RecordingFinding> check_clocks(const std::vector<MeasuredRun>& runs) {
  constexpr double kMaxJitter = 0.1;
  std::vector<RecordingFinding> findings;
  for (const MeasuredRun& run : runs) {
    const ClockSummary clock = summarize_clock(run.times);
    if (clock.gaps > 0) {
      findings.push_back({FindingKind::kDroppedSamples, run.name, "",
                          static_cast<double>(clock.dropped),
                          fmt::format("{} samples are missing in {} gaps, the first at {} s",
                                      clock.dropped, clock.gaps, format_rounded(clock.first_gap)),
                          ""});
    }
    if (clock.jitter > kMaxJitter * clock.interval) {
      findings.push_back({FindingKind::kUnevenClock, run.name, "", clock.jitter,
                          fmt::format("the clock jitters by {} ms around intervals of {} ms",
                                      format_significant(1e3 * clock.jitter, 2),
                                      format_significant(1e3 * clock.interval, 2)),
                          ""});
    }
  }
  return findings;
}

std::vector<RecordingFinding> check_sensors(const std::vector<MeasuredRun>& runs) {
  std::vector<RecordingFinding> all, findings;
  std::map<int, double> spreads;
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) {
      spreads[c.channel] = std::max(spreads[c.channel], calc_spread(c.values));
    }
  }
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) {
      const std::vector<double> readings = take_readings(c.values);
      if (readings.size() < 8) continue;
      const double step = find_step(readings);
      for (auto finding :
           {check_saturation(run, c, step), check_quantization(run, c, step, spreads[c.channel]),
            check_mains(run, c)}) {
        if (finding) all.push_back(*std::move(finding));
      }
    }
  }
  add_worst(all, findings);
  return findings;
}

std::vector<RecordingFinding> check_copies(const std::vector<MeasuredRun>& runs) {
  constexpr double kMost = 0.5;
  std::vector<RecordingFinding> findings;
  std::vector<RunPassages> passages;
  passages.reserve(runs.size());
  for (const MeasuredRun& run : runs) passages.push_back(list_passages(run));
  for (std::size_t a = 0; a < runs.size(); ++a) {
    for (std::size_t b = a + 1; b < runs.size(); ++b) {
      const double common = calc_common_fraction(passages[a], passages[b]);
      if (common < kMost) continue;
      findings.push_back({FindingKind::kCopy,
                          runs[b].name,
                          "",
                          common,
                          "is a copy of " + runs[a].name,
                          "a held-out run must be another one",
                          {a, b}});
    }
  }
  return findings;
}

}  // namespace strut
