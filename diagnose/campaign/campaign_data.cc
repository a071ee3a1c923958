#include "diagnose/campaign/campaign_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/check.h"
#include "base/error/input_error.h"
#include "base/math/local_polynomial.h"
#include "base/math/spread.h"
#include "base/text/format_number.h"
#include "diagnose/campaign/check_campaign_data.h"
#include "diagnose/campaign/name_table.h"
#include "estimate/readings.h"
#include "model/error/model_error.h"
#include "model/rig/rigs.h"
#include "model_files/read_maneuver.h"
#include "model_files/read_model.h"

namespace strut {
namespace {

/// Root mean square of the runs' estimates: over the runs for fitting, or over all runs where those
/// lack the column.
NoiseEstimate estimate_column(const CampaignData& data, std::size_t column) {
  NoiseEstimate pooled;
  for (const bool fit_only : {true, false}) {
    double squares = 0.0, count = 0.0;
    for (std::size_t r = 0; r < data.run_count(); ++r) {
      if (fit_only && data.campaign.runs[r].use != RunUse::kFit) continue;
      for (const MeasuredColumn& c : data.tables[r].columns) {
        if (c.at != column) continue;
        const NoiseEstimate one = estimate_noise(c.values);
        pooled.quantum =
            pooled.quantum == 0.0 ? one.quantum : std::min(pooled.quantum, one.quantum);
        pooled.source = one.source;
        pooled.uncertainty = one.uncertainty;
        squares += one.sigma * one.sigma;
        ++count;
      }
    }
    if (count == 0.0) continue;
    pooled.sigma = std::sqrt(squares / count);
    pooled.uncertainty /= std::sqrt(count);
    break;
  }
  return pooled;
}

void fill_noise(CampaignData& data) {
  for (std::size_t i = 0; i < data.campaign.columns.size(); ++i) {
    const CampaignColumn& c = data.campaign.columns[i];
    NoiseEstimate estimate;
    if (c.role == ColumnRole::kOutput) estimate = estimate_column(data, i);
    if (c.noise) estimate = {*c.noise, estimate.quantum, NoiseSource::kGiven, 0.0};
    if (c.role == ColumnRole::kOutput && !(estimate.sigma > 0.0)) {
      bool is_measured = false;
      for (const MeasuredTable& table : data.tables) {
        is_measured = is_measured || table.find(data.campaign.columns, c.channel);
      }
      if (is_measured) {
        throw InputError(
            fmt::format("{}: columns.{}: the noise cannot be estimated from the data; give noise = "
                        "SIGMA",
                        data.campaign.path.string(), c.channel));
      }
    }
    data.noise.push_back(estimate);
  }
}

std::vector<MeasuredChannel> make_channels(const CampaignData& data, const MeasuredTable& table) {
  std::vector<MeasuredChannel> channels;
  channels.reserve(table.columns.size());
  for (const MeasuredColumn& column : table.columns) {
    const CampaignColumn& c = data.campaign.columns[column.at];
    if (c.role != ColumnRole::kOutput) continue;
    channels.push_back({find_channel(data.model(), c.channel), data.noise[column.at].sigma,
                        column.values, column.reading});
  }
  if (channels.empty()) {
    throw InputError(table.name + ": the file has none of the campaign's channels to compare");
  }
  return channels;
}

/// The readings, without missing ones, as a signal over a clock that starts at 0. Smoothed as far
/// as that removes only noise (choose_smoothing), since forces follow the rate.
InputSignal make_input(const CampaignData& data, const MeasuredTable& table,
                       const MeasuredColumn& column, InputNoise& noise) {
  const CampaignColumn& c = data.campaign.columns[column.at];
  const double gain = c.gain.sigma == 0.0 ? c.gain.mean : 1.0;
  const double bias = c.bias.sigma == 0.0 ? c.bias.mean : 0.0;
  std::vector<double> times, values;
  times.reserve(table.times.size());
  values.reserve(table.times.size());
  for (std::size_t i = 0; i < table.times.size(); ++i) {
    if (std::isnan(column.values[i])) continue;
    times.push_back(table.times[i] - table.times.front());
    values.push_back(gain * (column.values[i] - bias));
  }
  noise.derivative = c.input.derivative;
  noise.reading = column.reading;
  noise.sigma = c.noise ? *c.noise : estimate_noise(values).sigma;
  // Masses smooth their inputs; a strut's force follows the velocity itself.
  const bool smooths = !data.model().masses.empty();
  if (c.smooth) {
    noise.smoothing.half_width = *c.smooth;
  } else if (!smooths) {
    noise.smoothing = choose_smoothing(times, values, noise.sigma);
  }
  try {
    InputSignal input = make_sampled_input(data.get_input(c).name, times, values, noise.smoothing);
    for (int i = 0; i < c.input.derivative; ++i) input = integrate_signal(input);
    return input;
  } catch (const ModelError& e) {
    throw InputError(fmt::format("{}: {}", table.name, e.what()));
  }
}

/// Normalized mean power that the strut absorbs, without that of the mean force: the correlation of
/// force and velocity, -1 to 1.
double calc_absorption(const MeasuredRun& run, const MeasuredChannel& force,
                       const InputSignal& motion) {
  const double mean = calc_mean(force.values);
  double power = 0.0, forces = 0.0, rates = 0.0;
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    if (std::isnan(force.values[i])) continue;
    const double f = force.values[i] - mean, v = calc_signal(motion, run.times[i]).rate;
    power += f * v;
    forces += f * f;
    rates += v * v;
  }
  const double scale = std::sqrt(forces * rates);
  return scale > 0.0 ? power / scale : 0.0;
}

/// Flips the sign of a stand's measured force if the strut gives out energy in every run, since
/// struts absorb energy: force and motion (the first input) then have opposite directions. If the
/// campaign gives the sign, only a note is made.
void orient_force(CampaignData& data) {
  constexpr double kMaxAbsorption = -0.3;
  const int channel = data.model().stand_force;
  if (channel < 0) return;
  const std::string& input = data.model().inputs.front().name;
  for (const MeasuredRun& run : data.runs) {
    const InputSignal& motion = *find_input(run, input);
    for (const MeasuredChannel& c : run.channels) {
      if (c.channel == channel && calc_absorption(run, c, motion) > kMaxAbsorption) return;
    }
  }
  const std::string& name = data.info(channel).name;
  for (CampaignColumn& c : data.campaign.columns) {
    if (c.channel != name) continue;
    if (c.has_sign) {
      data.notes.push_back(fmt::format(
          "{}: in every run the strut gives out energy, which no strut does; is sign = {} "
          "right?",
          name, format_number(c.sign)));
      return;
    }
    c.sign = -1.0;
    data.notes.push_back(fmt::format(
        "{0}: in every run the strut would give out energy, which no strut does; {0} is "
        "read with sign = -1, opposite to {1}",
        name, input));
  }
  for (MeasuredRun& run : data.runs) {
    for (MeasuredChannel& c : run.channels) {
      for (double& value : c.values) value = c.channel == channel ? -value : value;
    }
  }
}

/// Adds the recorded inputs of a run, on a clock that starts at 0.
void add_inputs(const CampaignData& data, const MeasuredTable& table, MeasuredRun& run) {
  for (double& t : run.times) t -= table.times.front();
  std::vector<InputSignal>& inputs = run.setup.rig().inputs;
  for (const MeasuredColumn& column : table.columns) {
    if (data.campaign.columns[column.at].role != ColumnRole::kInput) continue;
    InputNoise noise;
    inputs.push_back(make_input(data, table, column, noise));
    run.input_noise.push_back(noise);
  }
  try {
    assign_rig_inputs(run.setup.rig().rig.kind, inputs);
  } catch (const ModelError& e) {
    throw InputError(fmt::format("{}: columns: {}", data.campaign.path.string(), e.what()));
  }
}

/// The diagnosis finds a rough road as an unknown; one that is known has no place beside it.
ManeuverSpec read_campaign_maneuver(const std::filesystem::path& file) {
  ManeuverSpec maneuver = read_maneuver(file);
  if (maneuver.profile.data) {
    throw InputError(
        fmt::format("{}: road: a campaign finds the roughness of the road itself; "
                    "leave the table out",
                    file.string()));
  }
  return maneuver;
}

void make_runs(CampaignData& data) {
  const Model model = read_model(data.campaign.model);
  for (std::size_t r = 0; r < data.run_count(); ++r) {
    const CampaignRun& entry = data.campaign.runs[r];
    const MeasuredTable& table = data.tables[r];
    MeasuredRun run{table.name, model, table.times, make_channels(data, table), true};
    if (!data.has_inputs()) run.setup.car().maneuver = read_campaign_maneuver(entry.maneuver);
    switch_on(data.campaign.effects.on, run.setup);
    name_table(data.campaign, "fit.fix", [&] {
      for (const auto& [name, value] : data.campaign.fit.fix) set_parameter(run.setup, name, value);
    });
    name_table(data.campaign, "run " + entry.name, [&] {
      for (const auto& [name, known] : entry.known) {
        if (name != kHitTimeName) set_parameter(run.setup, name, known.mean);
      }
    });
    if (data.has_inputs()) add_inputs(data, table, run);
    data.runs.push_back(std::move(run));
  }
  orient_force(data);
}

}  // namespace

const InputInfo& CampaignData::get_input(const CampaignColumn& column) const {
  return model().inputs[static_cast<std::size_t>(column.input.input)];
}

const NoiseEstimate& CampaignData::find_noise(int channel) const {
  for (std::size_t i = 0; i < noise.size(); ++i) {
    if (campaign.columns[i].channel == info(channel).name) return noise[i];
  }
  throw CheckError("find_noise: no column for " + info(channel).name);
}

std::vector<MeasuredRun> CampaignData::select(const std::vector<std::size_t>& chosen) const {
  std::vector<MeasuredRun> list;
  list.reserve(chosen.size());
  for (const std::size_t r : chosen) list.push_back(runs[r]);
  return list;
}

std::vector<std::size_t> CampaignData::list_runs(RunUse use) const {
  std::vector<std::size_t> list;
  list.reserve(run_count());
  for (std::size_t r = 0; r < run_count(); ++r) {
    if (campaign.runs[r].use == use) list.push_back(r);
  }
  return list;
}

const InputSignal* find_input(const MeasuredRun& run, const std::string& name) {
  for (const InputSignal& signal : run.setup.rig().inputs) {
    if (signal.channel == name) return &signal;
  }
  return nullptr;
}

CampaignData take_run(const CampaignData& data, std::size_t run) {
  CampaignData one;
  one.campaign = data.campaign;
  one.campaign.runs = {data.campaign.runs[run]};
  one.noise = data.noise;
  one.tables = {data.tables[run]};
  one.runs = {data.runs[run]};
  return one;
}

CampaignData read_campaign_data(const std::filesystem::path& path) {
  CampaignData data;
  data.campaign = read_campaign(path);
  data.tables.reserve(data.run_count());
  for (const CampaignRun& run : data.campaign.runs) {
    data.tables.push_back(read_measured_table(data.campaign, run));
    const std::vector<std::string>& notes = data.tables.back().notes;
    data.notes.insert(data.notes.end(), notes.begin(), notes.end());
  }
  fill_noise(data);
  make_runs(data);
  check_campaign_data(data);
  return data;
}

bool meets_bump(const CampaignData& data, std::size_t run) {
  if (data.has_inputs()) return true;
  const RoadSpec& road = data.runs[run].setup.car().maneuver.road;
  return road.shape != BumpShape::kNone && road.height != 0.0;
}

std::unique_ptr<ReadingModel> make_reading_model(const CampaignData& data,
                                                 const std::vector<std::size_t>& runs,
                                                 std::vector<Unknown> unknowns, int threads) {
  return make_reading_model(data.select(runs), std::move(unknowns), threads);
}

std::unique_ptr<ReadingModel> make_reading_model(std::vector<MeasuredRun> runs,
                                                 std::vector<Unknown> unknowns, int threads,
                                                 double relative_step) {
  LinearizeOptions options;
  options.rate = 1000.0;  // enough at the sensors and speeds of campaigns
  options.relative_step = relative_step;
  options.threads = threads;
  return make_readings(std::move(runs), std::move(unknowns), options);
}

InputSignal make_sampled_input(const std::string& channel, const std::vector<double>& times,
                               const std::vector<double>& values,
                               const LocalPolynomial& smoothing) {
  if (smoothing.half_width <= 0.0) {
    return make_signal(channel, times, values, Interpolation::kSpline);
  }
  const SmoothCurve curve = calc_local_polynomial(times, values, smoothing, CurveEnds::kOneSided);
  return make_signal(channel, times, curve.value, curve.rate);
}

}  // namespace strut
