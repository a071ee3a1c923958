#include "estimate/recording/check_alignment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/math/spread.h"
#include "base/text/format_number.h"

namespace strut {
namespace {

/// Least correlation of channels that are compared, and of one that few runs must judge.
constexpr double kComparable = 0.6, kClear = 0.9;
/// A run judges a channel that moves at least this fraction of its motion in the run where it moves
/// most: only one-sided bumps make a car roll.
constexpr double kMoves = 0.1;
constexpr double kMinSignRatio = 1.5;
constexpr double kMaxFactor = 1.9;
/// Factors of channels that are one: that of their input.
constexpr double kSameFactor = 1.15;
constexpr double kMaxLag = 0.010, kMaxCommonLag = 0.015;  // s
constexpr double kMinLagRatio = 1.3;

/// Lags [s] by run.
struct Lags {
  std::vector<double> runs;
  double median = 0.0;
};

/// A channel in all runs.
struct ChannelSummary {
  int channel = 0;  // in ModelInfo::channels
  std::vector<const ChannelAlignment*> runs;
  Lags lag, own_lag;  // own: without what the other channels of a run share
  double factor = 1.0, lag_ratio = 1.0, correlation = 0.0;  // medians
  bool is_negative = false;
};

/// The lag [s] that the other channels of the run that move have in common: an event or a speed
/// that is not quite as stated shifts them all. 0 where few others could tell.
template <class Moves>
double calc_shared_lag(const Alignment& alignment, const ChannelAlignment& of, const Moves& moves) {
  constexpr std::size_t kMinOthers = 4;
  std::vector<double> lags;
  for (const ChannelAlignment& a : alignment.channels) {
    const bool is_other = a.run == of.run && a.channel != of.channel;
    if (is_other && moves(a) && a.correlation >= kComparable) lags.push_back(a.lag);
  }
  return lags.size() < kMinOthers ? 0.0 : calc_quantile(lags, 0.5);
}

template <class Value>
double calc_median(const std::vector<const ChannelAlignment*>& runs, const Value& get) {
  std::vector<double> values;
  values.reserve(runs.size());
  for (const ChannelAlignment* run : runs) values.push_back(get(*run));
  return calc_quantile(values, 0.5);
}

std::vector<ChannelSummary> summarize(const std::vector<MeasuredRun>& runs,
                                      const Alignment& alignment) {
  std::map<int, ChannelSummary> channels;
  std::map<int, std::size_t> measured, moved;
  std::map<int, double> most;
  const auto get_number = [&](const ChannelAlignment& a) {
    return runs[a.run].channels[a.channel].channel;
  };
  for (const ChannelAlignment& a : alignment.channels) {
    ++measured[get_number(a)];
    most[get_number(a)] = std::max(most[get_number(a)], a.motion);
  }
  const auto moves = [&](const ChannelAlignment& a) {
    return a.motion >= kMoves * most[get_number(a)];
  };
  for (const ChannelAlignment& a : alignment.channels) moved[get_number(a)] += moves(a) ? 1 : 0;
  for (const ChannelAlignment& a : alignment.channels) {
    const int number = get_number(a);
    const bool are_few = 2 * moved[number] <= measured[number];
    if (!moves(a) || a.correlation < (are_few ? kClear : kComparable)) continue;
    channels[number].channel = number;
    channels[number].runs.push_back(&a);
    channels[number].lag.runs.push_back(a.lag);
    // Many runs agree about a sensor's lag whatever shifts one of them.
    const double shared = are_few ? calc_shared_lag(alignment, a, moves) : 0.0;
    channels[number].own_lag.runs.push_back(a.lag - shared);
  }
  std::vector<ChannelSummary> list;
  for (auto& [number, c] : channels) {
    // Of a motion that the model does not have, such as roll over a straight bump, single runs may
    // agree by chance.
    if (2 * c.runs.size() <= moved[number]) continue;
    const auto negative = std::count_if(c.runs.begin(), c.runs.end(), [](const auto* run) {
      return run->factor < 0.0 && run->sign_ratio >= kMinSignRatio;
    });
    c.is_negative = 2 * static_cast<std::size_t>(negative) > c.runs.size();
    c.factor = calc_median(c.runs, [](const auto& run) { return std::abs(run.factor); });
    for (Lags* lags : {&c.lag, &c.own_lag}) lags->median = calc_quantile(lags->runs, 0.5);
    c.lag_ratio = calc_median(c.runs, [](const auto& run) { return run.lag_ratio; });
    c.correlation = calc_median(c.runs, [](const auto& run) { return run.correlation; });
    list.push_back(std::move(c));
  }
  return list;
}

const ChannelInfo& get_info(const std::vector<MeasuredRun>& runs, int channel) {
  return runs.front().setup.info().channels[static_cast<std::size_t>(channel)];
}

bool is_large(double factor) { return factor > kMaxFactor || factor < 1.0 / kMaxFactor; }

RecordingFinding make_sign(const std::string& channel) {
  return {FindingKind::kSign, "", channel, -1.0, "looks negated", "sign = -1"};
}

/// For readings that are `factor` times what they should be: the unit that explains it, or a scale.
std::string advise_scale(const std::string& si, const ColumnReading& reading, double factor) {
  const std::string unit = reading.guess_true_unit(si, factor);
  return unit.empty() ? fmt::format("scale = {}?", format_significant(reading.scale / factor, 3))
                      : fmt::format("unit = \"{}\"?", unit);
}

/// The column of a channel in the first run that has it.
ColumnReading get_reading(const std::vector<MeasuredRun>& runs, const ChannelSummary& c) {
  const ChannelAlignment& first = *c.runs.front();
  return runs[first.run].channels[first.channel].reading;
}

/// The recorded column that drives the first input: the input itself or a time derivative of it.
struct InputColumn {
  std::string name, unit;
  ColumnReading reading{};
};

InputColumn find_input_column(const std::vector<MeasuredRun>& runs) {
  const ModelInfo& info = runs.front().setup.info();
  const InputInfo& input = info.inputs.front();
  InputColumn column{input.name, input.unit};
  const std::vector<InputSignal>& signals = runs.front().setup.rig().inputs;
  const std::vector<InputNoise>& noise = runs.front().input_noise;
  for (std::size_t i = 0; i < std::min(signals.size(), noise.size()); ++i) {
    if (signals[i].channel != input.name) continue;
    column.reading = noise[i].reading;
    if (noise[i].derivative == 0) continue;
    const int channel = noise[i].derivative == 1 ? input.rate : input.second_rate;
    column.name = info.channels[static_cast<std::size_t>(channel)].name;
    column.unit = info.channels[static_cast<std::size_t>(channel)].unit;
  }
  return column;
}

RecordingFinding make_factor(const ChannelInfo& info, const ColumnReading& reading, double factor) {
  return {FindingKind::kFactor,
          "",
          info.name,
          factor,
          fmt::format("is {} times what the model predicts", format_significant(factor, 2)),
          advise_scale(info.unit, reading, factor)};
}

std::string describe_lag(double lag) {
  return fmt::format("{} ms {}", format_significant(1e3 * std::abs(lag), 2),
                     lag > 0.0 ? "late" : "early");
}

/// `lag`: beyond the delay with which the column was read.
std::string advise_delay(const ColumnReading& reading, double lag) {
  return fmt::format("delay = {}", format_significant(reading.delay + lag, 3));
}

/// Where all channels have one factor, it is that of the input.
bool add_common_factor(const std::vector<MeasuredRun>& runs,
                       const std::vector<ChannelSummary>& channels,
                       std::vector<RecordingFinding>& findings) {
  const ModelInfo& info = runs.front().setup.info();
  if (channels.size() < 2 || info.inputs.empty()) return false;
  const auto [low, high] = std::minmax_element(
      channels.begin(), channels.end(),
      [](const ChannelSummary& a, const ChannelSummary& b) { return a.factor < b.factor; });
  if (!is_large(low->factor) || !is_large(high->factor) ||
      high->factor > kSameFactor * low->factor) {
    return false;
  }
  const InputColumn input = find_input_column(runs);
  const double factor = 1.0 / low->factor;
  findings.push_back({FindingKind::kFactor, "", input.name, factor,
                      fmt::format("is {} times what the channels that it drives suggest",
                                  format_significant(factor, 2)),
                      advise_scale(input.unit, input.reading, factor)});
  return true;
}

/// Likewise where all channels are negated.
bool add_common_sign(const std::vector<MeasuredRun>& runs,
                     const std::vector<ChannelSummary>& channels,
                     std::vector<RecordingFinding>& findings) {
  const ModelInfo& info = runs.front().setup.info();
  const bool all = std::all_of(channels.begin(), channels.end(),
                               [](const ChannelSummary& c) { return c.is_negative; });
  if (channels.size() < 2 || info.inputs.empty() || !all) return false;
  findings.push_back(make_sign(find_input_column(runs).name));
  return true;
}

/// Whether a lag may be the phase of a motion that repeats itself after `period`.
bool is_phase(double lag, double period) {
  constexpr double kMaxPart = 0.125;
  return period > 0.0 && std::abs(lag) > kMaxPart * period;
}

/// Whether most runs of a channel agree about `lags`, one kind of its own.
bool has_lag(const ChannelSummary& c, const Lags& lags, double least) {
  std::size_t same = 0;
  for (std::size_t i = 0; i < lags.runs.size(); ++i) {
    const double lag = lags.runs[i], period = c.runs[i]->period;
    same += lag * lags.median > 0.0 && std::abs(lag) > 0.5 * std::abs(lags.median) &&
            !is_phase(lag, period) && !is_phase(c.lag.runs[i], period);
  }
  return std::abs(lags.median) >= least && c.lag_ratio >= kMinLagRatio &&
         2 * same > lags.runs.size();
}

/// Lags of all channels are one of the clock; others are those of single sensors.
void add_lags(const std::vector<MeasuredRun>& runs, const std::vector<ChannelSummary>& channels,
              std::vector<RecordingFinding>& findings) {
  const bool is_driven = runs.front().setup.info().is_driven_by_inputs();
  std::vector<double> lags;
  lags.reserve(channels.size());
  for (const ChannelSummary& c : channels) lags.push_back(c.lag.median);
  const double common = calc_quantile(lags, 0.5);
  const bool all_late =
      channels.size() > 1 &&
      std::all_of(channels.begin(), channels.end(), [&](const ChannelSummary& c) {
        return has_lag(c, c.lag, 0.5 * kMaxCommonLag) && std::abs(c.lag.median - common) < kMaxLag;
      });
  if (all_late && std::abs(common) >= kMaxCommonLag) {
    const std::string what = fmt::format("all channels are {}", describe_lag(common));
    if (is_driven) {
      const InputColumn input = find_input_column(runs);
      findings.push_back({FindingKind::kLag, "", "", common, what + " against " + input.name,
                          advise_delay(input.reading, -common) + " of " + input.name});
    } else {
      findings.push_back(
          {FindingKind::kLag, "", "", common, what, "offset of time, or hit_time of the runs"});
    }
    return;
  }
  for (const ChannelSummary& c : channels) {
    const double least = channels.size() > 1 ? kMaxLag : kMaxCommonLag;
    if (!has_lag(c, c.own_lag, least)) continue;
    const double lag = c.own_lag.median;
    findings.push_back({FindingKind::kLag, "", get_info(runs, c.channel).name, lag,
                        "is " + describe_lag(lag),
                        advise_delay(get_reading(runs, c), lag) +
                            " if another clock recorded it; or is it filtered?"});
  }
}

/// Pairs that agree better when swapped in most runs; returns the channels of these.
std::set<int> add_swaps(const std::vector<MeasuredRun>& runs, const Alignment& alignment,
                        std::vector<RecordingFinding>& findings) {
  constexpr double kMinGain = 2.0;
  std::map<std::pair<int, int>, std::vector<double>> gains;
  for (const PossibleSwap& swap : alignment.swaps) {
    const auto& channels = runs[swap.run].channels;
    gains[{channels[swap.first].channel, channels[swap.second].channel}].push_back(swap.gain);
  }
  std::set<int> swapped;
  // The clearest first: each channel is in one pair.
  std::vector<std::pair<double, std::pair<int, int>>> pairs;
  pairs.reserve(gains.size());
  for (const auto& [pair, list] : gains) pairs.emplace_back(calc_quantile(list, 0.5), pair);
  std::sort(pairs.rbegin(), pairs.rend());
  for (const auto& [gain, pair] : pairs) {
    const auto [first, second] = pair;
    if (gain < kMinGain || swapped.count(first) + swapped.count(second) > 0) continue;
    swapped.insert({first, second});
    findings.push_back({FindingKind::kSwapped, "", get_info(runs, first).name, gain,
                        fmt::format("and {} look swapped", get_info(runs, second).name),
                        "swap their columns"});
  }
  return swapped;
}

/// A sign that one run alone has.
void add_single_signs(const std::vector<MeasuredRun>& runs, const ChannelSummary& c,
                      std::vector<RecordingFinding>& findings) {
  for (const ChannelAlignment* run : c.runs) {
    const bool is_negative = run->factor < 0.0;
    if (is_negative == c.is_negative || run->correlation < kClear || run->sign_ratio < 2.0)
      continue;
    RecordingFinding finding = make_sign(get_info(runs, c.channel).name);
    finding.run = runs[run->run].name;
    finding.what = "has the other sign than in the other runs";
    finding.advice = "";
    findings.push_back(std::move(finding));
  }
}

/// A channel that moves and resembles nothing that the model does, in any run. A car's channels may
/// follow the road's roughness, which the simulation does not have; all of them never do.
void add_strangers(const std::vector<MeasuredRun>& runs, const Alignment& alignment,
                   const std::set<int>& swapped, std::vector<RecordingFinding>& findings) {
  constexpr double kMinSpread = 5.0;  // of a channel, in standard deviations of its noise
  std::map<int, std::vector<double>> correlations;
  for (const ChannelAlignment& a : alignment.channels) {
    const MeasuredChannel& channel = runs[a.run].channels[a.channel];
    if (calc_spread(channel.values) < kMinSpread * channel.sigma) continue;
    correlations[channel.channel].push_back(a.correlation);
  }
  std::vector<std::pair<int, double>> strangers;
  for (const auto& [channel, list] : correlations) {
    const double most = *std::max_element(list.begin(), list.end());
    if (most < kComparable && swapped.count(channel) == 0) strangers.emplace_back(channel, most);
  }
  const bool is_driven = runs.front().setup.info().is_driven_by_inputs();
  if (!is_driven && strangers.size() < correlations.size()) return;
  for (const auto& [channel, most] : strangers) {
    findings.push_back(
        {FindingKind::kStranger, "", get_info(runs, channel).name, most,
         fmt::format("resembles nothing that the model does (correlation {:.2f})", most),
         "another column or run, far start values, or a clock that is off by more than 0.3 s?"});
  }
}

}  // namespace

std::vector<RecordingFinding> check_alignment(const std::vector<MeasuredRun>& runs,
                                              const Alignment& alignment) {
  std::vector<RecordingFinding> findings;
  const std::set<int> swapped = add_swaps(runs, alignment, findings);
  add_strangers(runs, alignment, swapped, findings);
  std::vector<ChannelSummary> channels = summarize(runs, alignment);
  std::erase_if(channels, [&](const ChannelSummary& c) { return swapped.count(c.channel) > 0; });
  if (channels.empty()) return findings;
  const bool common_sign = add_common_sign(runs, channels, findings);
  const bool common_factor = add_common_factor(runs, channels, findings);
  for (const ChannelSummary& c : channels) {
    const ChannelInfo& info = get_info(runs, c.channel);
    if (c.is_negative && !common_sign) findings.push_back(make_sign(info.name));
    if (is_large(c.factor) && !common_factor) {
      findings.push_back(make_factor(info, get_reading(runs, c), c.factor));
    }
    add_single_signs(runs, c, findings);
  }
  add_lags(runs, channels, findings);
  return findings;
}

}  // namespace strut
