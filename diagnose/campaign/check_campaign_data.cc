#include "diagnose/campaign/check_campaign_data.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error/input_error.h"
#include "base/math/spread.h"
#include "base/text/format_number.h"
#include "diagnose/campaign/campaign_data.h"
#include "diagnose/campaign/units.h"
#include "estimate/simulate_run.h"

namespace strut {
namespace {

/// Spreads that a suspension's quantities can have, from a laboratory rig to a truck.
struct PlausibleSpread {
  const char* si;
  double low, high;
};
constexpr PlausibleSpread kPlausible[] = {{"m", 1e-6, 3.0},       {"m/s", 1e-5, 60.0},
                                          {"m/s^2", 1e-4, 500.0}, {"N", 1e-3, 1e6},
                                          {"rad", 1e-6, 1.5},     {"rad/s", 1e-5, 300.0}};
constexpr double kMostRatio = 300.0;

constexpr double kWantedPerPeriod = 8.0, kNeededPerPeriod = 4.0;
constexpr double kWantedCarRate = 100.0, kNeededCarRate = 50.0;  // Hz; wheels hop at 10 to 15 Hz
/// A strut on a crank shows its force at so many places of a stroke.
constexpr double kWantedPerStroke = 40.0, kNeededPerStroke = 20.0;

struct RateNeed {
  double wanted, needed;  // Hz
  std::string reason;
};

/// Crossings of the mean, upwards, per second; with a dead band, so that noise makes none.
double calc_frequency(const std::vector<double>& values, double duration) {
  const double mean = calc_mean(values), band = 0.3 * calc_spread(values);
  bool below = false;
  double count = 0.0;
  for (const double v : values) {
    if (v < mean - band) below = true;
    if (!below || !(v > mean + band)) continue;
    below = false;
    ++count;
  }
  return count / duration;
}

RateNeed find_need(const CampaignData& data, std::size_t r) {
  if (!data.has_inputs()) {
    return {kWantedCarRate, kNeededCarRate, "wheels hop at 10 to 15 Hz"};
  }
  const MeasuredRun& run = data.runs[r];
  const double mode = run.setup.calc_fastest_mode() / (2.0 * std::numbers::pi);
  if (mode > 0.0) {
    return {kWantedPerPeriod * mode, kNeededPerPeriod * mode,
            "the model's fastest mode has " + format_rounded(mode) + " Hz"};
  }
  const MeasuredColumn* stroke =
      data.tables[r].find(data.campaign.columns, data.model().inputs.front().name);
  const double f = stroke ? calc_frequency(stroke->values, run.times.back()) : 0.0;
  return {kWantedPerStroke * f, kNeededPerStroke * f,
          "the strut is driven at " + format_rounded(f) + " Hz"};
}

void check_duration(const CampaignData& data, std::size_t r) {
  constexpr double kMaxDuration = 1e5;  // s, as of a rig's maneuver
  const MeasuredTable& table = data.tables[r];
  const double duration = table.times.back() - table.times.front();
  if (duration <= kMaxDuration) return;
  throw InputError(table.name + ": lasts " + format_rounded(duration) + " s; must be at most " +
                   format_rounded(kMaxDuration) + " s");
}

void check_rate(CampaignData& data, std::size_t r) {
  const MeasuredTable& table = data.tables[r];
  const double rate = table.rate();
  const RateNeed need = find_need(data, r);
  const std::string told = table.name + ": " + format_rounded(rate) + " samples a second; " +
                           need.reason + ", so " + format_rounded(std::ceil(need.wanted)) +
                           " are wanted and " + format_rounded(std::ceil(need.needed)) + " needed";
  if (rate < need.needed) {
    const bool kilo = data.campaign.time.unit.empty() && 1000.0 * rate >= need.needed &&
                      table.times.back() - table.times.front() > 1000.0;
    throw InputError(
        told +
        (kilo ? "; is column '" + data.campaign.time.column + "' in ms? then unit = \"ms\"" : ""));
  }
  if (rate < need.wanted) data.notes.push_back(told);
  constexpr double kMostRate = 1e5;
  if (rate > kMostRate) {
    throw InputError(table.name + ": " + format_rounded(rate) +
                     " samples a second are more than any such sensor takes; wrong by a factor of "
                     "1000? column '" +
                     data.campaign.time.column + "' is read in " +
                     (data.campaign.time.unit.empty() ? "s" : data.campaign.time.unit));
  }
}

std::string suspect(const MeasuredTable& table, const CampaignColumn& c, double spread,
                    double expected, const std::string& of) {
  const std::string guess = guess_unit(c.si, spread / expected);
  std::string text = table.name + ": " + c.channel + " (column '" + c.column + "', read in " +
                     (c.unit.empty() ? c.si : c.unit) + ") spreads by " + format_rounded(spread) +
                     " " + c.si + ", " + of + ": is its unit wrong, perhaps by a factor of 1000?";
  if (!guess.empty() && c.unit.empty()) text += " Then unit = \"" + guess + "\"";
  return text;
}

void check_plausible(const CampaignData& data, std::size_t r) {
  for (const MeasuredColumn& column : data.tables[r].columns) {
    const CampaignColumn& c = data.campaign.columns[column.at];
    const double spread = calc_spread(column.values);
    for (const PlausibleSpread& plausible : kPlausible) {
      if (plausible.si != c.si || spread == 0.0) continue;
      if (spread >= plausible.low && spread <= plausible.high) continue;
      const bool high = spread > plausible.high;
      throw InputError(suspect(data.tables[r], c, spread, high ? 1e-3 * spread : 1e3 * spread,
                               (high ? "more than " : "less than ") +
                                   format_rounded(high ? plausible.high : plausible.low) + " " +
                                   c.si + " that such a channel can have"));
    }
  }
}

void check_driven(const CampaignData& data, std::size_t r) {
  if (!data.has_inputs()) return;
  double most = 0.0;
  for (const MeasuredColumn& column : data.tables[r].columns) {
    if (data.campaign.columns[column.at].role != ColumnRole::kInput) continue;
    most = std::max(most, calc_spread(column.values));
  }
  if (most > 0.0) return;
  throw InputError(data.tables[r].name + ": every input is constant: nothing moves the rig");
}

/// Against the nominal model, driven by the same inputs or the stated maneuver.
void check_units(const CampaignData& data, std::size_t r) {
  const RunCurves curves = simulate_run(data.runs[r], {}, {});
  if (!curves.failure.empty()) return;  // told by whoever needs the simulation
  for (std::size_t k = 0; k < data.channels(r).size(); ++k) {
    const MeasuredChannel& channel = data.channels(r)[k];
    const double measured = calc_spread(channel.values);
    const double simulated = calc_spread(curves.channel[static_cast<std::size_t>(channel.channel)]);
    if (!(simulated > 0.0) || !(measured > 0.0)) continue;
    const double ratio = measured / simulated;
    if (ratio < kMostRatio && ratio * kMostRatio > 1.0) continue;
    // Below the noise the model may rest; where it rests, a rough road still moves the car.
    if (std::max(simulated, measured) < 10.0 * channel.sigma) continue;
    if (!data.has_inputs() && simulated < channel.sigma) continue;
    for (const CampaignColumn& c : data.campaign.columns) {
      if (c.channel != data.info(channel.channel).name) continue;
      throw InputError(suspect(data.tables[r], c, measured, simulated,
                               "the nominal model's by " + format_rounded(simulated) + " " + c.si));
    }
  }
}

}  // namespace

void check_campaign_data(CampaignData& data) {
  for (std::size_t r = 0; r < data.run_count(); ++r) {
    check_rate(data, r);
    check_duration(data, r);
    check_driven(data, r);
    check_plausible(data, r);
    check_units(data, r);
  }
}

}  // namespace strut
