#include "diagnose/campaign/check_campaign_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error/input_error.h"
#include "base/math/spread.h"
#include "base/text/format_number.h"
#include "diagnose/campaign/campaign_data.h"
#include "diagnose/campaign/campaign_unknowns.h"
#include "estimate/simulate_run.h"
#include "io/table/units.h"

namespace strut {
namespace {

/// Plausible spreads of a suspension's quantities, from a laboratory rig to a truck.
struct PlausibleSpread {
  const char* si;
  double low, high;
};
constexpr PlausibleSpread kPlausible[] = {{"m", 1e-6, 3.0},       {"m/s", 1e-5, 60.0},
                                          {"m/s^2", 1e-4, 500.0}, {"N", 1e-3, 1e6},
                                          {"rad", 1e-6, 1.5},     {"rad/s", 1e-5, 300.0}};
constexpr double kMaxRatio = 300.0;

/// Recommended and required samples: a period of the fastest mode, a second of a car, whose wheels
/// hop at 10 to 15 Hz, and a stroke of a strut on a crank.
constexpr double kRecommendedPerPeriod = 8.0, kRequiredPerPeriod = 4.0;
constexpr double kRecommendedCarRate = 100.0, kRequiredCarRate = 50.0;  // Hz
constexpr double kRecommendedPerStroke = 40.0, kRequiredPerStroke = 20.0;

struct RateNeed {
  double recommended, required;  // Hz
  std::string reason;
};

/// Upward crossings of the mean per second, with a dead band against noise.
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
    return {kRecommendedCarRate, kRequiredCarRate, "wheels hop at 10 to 15 Hz"};
  }
  const MeasuredRun& run = data.runs[r];
  const double mode = run.setup.calc_fastest_mode() / (2.0 * std::numbers::pi);
  if (mode > 0.0) {
    return {kRecommendedPerPeriod * mode, kRequiredPerPeriod * mode,
            fmt::format("the model's fastest mode has {} Hz", format_rounded(mode))};
  }
  double f = 0.0;
  for (const MeasuredColumn& column : data.tables[r].columns) {
    const CampaignColumn& c = data.campaign.columns[column.at];
    const bool is_stroke = c.role == ColumnRole::kInput && c.input.input == 0;
    if (is_stroke) f = calc_frequency(column.values, run.times.back());
  }
  return {kRecommendedPerStroke * f, kRequiredPerStroke * f,
          fmt::format("the strut is driven at {} Hz", format_rounded(f))};
}

void check_duration(const CampaignData& data, std::size_t r) {
  constexpr double kMaxDuration = 1e5;  // s, as for a rig's maneuver
  const MeasuredTable& table = data.tables[r];
  const double duration = table.times.back() - table.times.front();
  if (duration <= kMaxDuration) return;
  throw InputError(fmt::format("{}: lasts {} s; must be at most {} s", table.name,
                               format_rounded(duration), format_rounded(kMaxDuration)));
}

void check_rate(CampaignData& data, std::size_t r) {
  constexpr double kMaxRate = 1e5;
  const MeasuredTable& table = data.tables[r];
  const CampaignColumn& clock = data.campaign.time;
  const double rate = table.rate();
  const RateNeed need = find_need(data, r);
  const std::string message = fmt::format(
      "{}: {} samples per second; {}, so at least {} are required and {} recommended", table.name,
      format_rounded(rate), need.reason, format_rounded(std::ceil(need.required)),
      format_rounded(std::ceil(need.recommended)));
  if (rate < need.required) {
    const bool is_milli = clock.unit.empty() && 1000.0 * rate >= need.required &&
                          table.times.back() - table.times.front() > 1000.0;
    throw InputError(
        message + (is_milli
                       ? fmt::format("; if column '{}' is in ms, give unit = \"ms\"", clock.column)
                       : ""));
  }
  if (rate < need.recommended) data.notes.push_back(message);
  if (rate > kMaxRate) {
    throw InputError(fmt::format(
        "{}: {} samples per second are more than any such sensor takes; column '{}' is "
        "read in {}: is its unit wrong, perhaps by a factor of 1000?",
        table.name, format_rounded(rate), clock.column, clock.unit.empty() ? "s" : clock.unit));
  }
}

/// The message of a suspected unit. `comparison`: the plausible spread or the model's.
std::string suspect_unit(const MeasuredTable& table, const CampaignColumn& c,
                         const ColumnReading& reading, double spread, double expected,
                         const std::string& comparison) {
  const std::string guess = reading.guess_true_unit(c.si, spread / expected);
  std::string text = fmt::format(
      "{}: {} (column '{}', read in {}) has a standard deviation of {} {}, {}: is its "
      "unit wrong, perhaps by a factor of 1000?",
      table.name, c.channel, c.column, name_unit(c.si, reading.unit), format_rounded(spread), c.si,
      comparison);
  if (!guess.empty()) text += fmt::format(" If so, give unit = \"{}\"", guess);
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
      throw InputError(suspect_unit(
          data.tables[r], c, column.reading, spread, high ? 1e-3 * spread : 1e3 * spread,
          high ? fmt::format("above the plausible {} {}", format_rounded(plausible.high), c.si)
               : fmt::format("below the plausible {} {}", format_rounded(plausible.low), c.si)));
    }
  }
}

void check_driven(const CampaignData& data, std::size_t r) {
  if (!data.has_inputs()) return;
  double max_spread = 0.0;
  for (const MeasuredColumn& column : data.tables[r].columns) {
    if (data.campaign.columns[column.at].role != ColumnRole::kInput) continue;
    max_spread = std::max(max_spread, calc_spread(column.values));
  }
  if (max_spread > 0.0) return;
  throw InputError(data.tables[r].name + ": every input is constant, so nothing drives the rig");
}

/// Against the nominal model, driven by the same inputs or the stated maneuver.
void check_units(const CampaignData& data, std::size_t r) {
  const RunCurves curves = simulate_run(data.runs[r], {}, {});
  if (!curves.failure.empty()) return;  // reported where the simulation is needed
  for (std::size_t k = 0; k < data.channels(r).size(); ++k) {
    const MeasuredChannel& channel = data.channels(r)[k];
    const double measured = calc_spread(channel.values);
    const double simulated = calc_spread(curves.channel[static_cast<std::size_t>(channel.channel)]);
    if (!(simulated > 0.0) || !(measured > 0.0)) continue;
    const double ratio = measured / simulated;
    if (ratio < kMaxRatio && ratio * kMaxRatio > 1.0) continue;
    // Below the noise the model may be at rest; a rough road moves the measured car nevertheless.
    if (std::max(simulated, measured) < 10.0 * channel.sigma) continue;
    if (!data.has_inputs() && simulated < channel.sigma) continue;
    for (const CampaignColumn& c : data.campaign.columns) {
      if (c.channel != data.info(channel.channel).name) continue;
      throw InputError(suspect_unit(
          data.tables[r], c, channel.reading, measured, simulated,
          fmt::format("that of the nominal model is {} {}", format_rounded(simulated), c.si)));
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
  make_free_unknowns(data, data.list_runs(RunUse::kFit));  // throws for what cannot be free
}

}  // namespace strut
