#include "diagnose/campaign/campaign_data.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error/check.h"
#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "diagnose/campaign/check_campaign_data.h"
#include "diagnose/campaign/local_cubic.h"
#include "diagnose/campaign/spread.h"
#include "estimate/linearize.h"
#include "model/error/model_error.h"
#include "model_files/parameters.h"
#include "model_files/read_maneuver.h"
#include "model_files/read_rig.h"
#include "model_files/read_vehicle.h"

namespace strut {
namespace {

int find_channel(const CampaignData& data, const std::string& name) {
  const std::vector<ChannelInfo>& infos = list_channels(data.campaign.rig);
  const auto found = std::find_if(infos.begin(), infos.end(),
                                  [&](const ChannelInfo& info) { return info.name == name; });
  return static_cast<int>(found - infos.begin());
}

/// Calls `function`; an InputError of it names the campaign's table it came from.
template <class Function>
auto name_table(const CampaignData& data, const std::string& table, const Function& function) {
  try {
    return function();
  } catch (const InputError& e) {
    throw InputError(data.campaign.path.string() + ": " + table + ": " + e.what());
  }
}

/// Root mean square of the runs' estimates: of those for fitting, of all where those lack it.
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
      bool there = false;
      for (const MeasuredTable& table : data.tables)
        there = there || table.find(data.campaign.columns, c.channel);
      if (there) {
        throw InputError(data.campaign.path.string() + ": columns." + c.channel +
                         ": no noise can be estimated from the data; give noise = SIGMA");
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
    channels.push_back({find_channel(data, c.channel), data.noise[column.at].sigma, column.values});
  }
  if (channels.empty()) throw InputError(table.name + ": none of the channels to compare is there");
  return channels;
}

/// The readings that are there, as a signal over a clock that begins at 0; smoothed as far as that
/// takes nothing but noise away (choose_half_width), since rates drive forces.
InputSignal make_input(const CampaignData& data, const MeasuredTable& table,
                       const MeasuredColumn& column, InputNoise& noise) {
  const CampaignColumn& c = data.campaign.columns[column.at];
  const double gain = c.gain.sigma == 0.0 ? c.gain.mean : 1.0;
  std::vector<double> times, values;
  times.reserve(table.times.size());
  values.reserve(table.times.size());
  for (std::size_t i = 0; i < table.times.size(); ++i) {
    if (std::isnan(column.values[i])) continue;
    times.push_back(table.times[i] - table.times.front());
    values.push_back(gain * column.values[i]);
  }
  noise.sigma = c.noise ? *c.noise : estimate_noise(values).sigma;
  // Masses smooth what they are driven by; a strut's force follows the velocity itself.
  const bool smooths = data.campaign.rig != RigKind::kStrutRig;
  noise.half_width = c.smooth  ? *c.smooth
                     : smooths ? 0.0
                               : choose_half_width(times, values, noise.sigma);
  try {
    return make_sampled_input(c.channel, times, values, noise.half_width);
  } catch (const std::invalid_argument& e) {
    throw InputError(table.name + ": " + e.what());
  }
}

/// Mean power that goes into the strut over its ends, less that of mean force; 1 where force and
/// velocity are alike.
double calc_absorption(const RigRun& run, const MeasuredChannel& force, const InputSignal& moves) {
  const double mean = calc_mean(force.values);
  double power = 0.0, forces = 0.0, rates = 0.0;
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    if (std::isnan(force.values[i])) continue;
    const double f = force.values[i] - mean, v = calc_signal(moves, run.times[i]).rate;
    power += f * v;
    forces += f * f;
    rates += v * v;
  }
  const double scale = std::sqrt(forces * rates);
  return scale > 0.0 ? power / scale : 0.0;
}

/// A strut takes energy in. Where every run of a dynamometer says the opposite, force and
/// displacement count in opposite directions; unless the campaign gives the sign, it is turned.
void turn_force(CampaignData& data) {
  constexpr double kClearly = -0.3;
  if (data.campaign.rig != RigKind::kStrutRig) return;
  const int channel = find_channel(data, "force");
  for (RigRun& run : data.rigs) {
    for (const MeasuredChannel& c : run.channels) {
      if (c.channel == channel && calc_absorption(run, c, run.inputs[0]) > kClearly) return;
    }
  }
  for (CampaignColumn& c : data.campaign.columns) {
    if (c.channel != "force") continue;
    if (c.has_sign) {
      data.notes.push_back(
          "force: in every run the strut gives energy out, as no strut does; is "
          "sign = " +
          format_number(c.sign) + " right?");
      return;
    }
    c.sign = -1.0;
    data.notes.push_back(
        "force: in every run the strut would give energy out, as no strut does; "
        "force is taken with sign = -1, against displacement");
  }
  for (RigRun& run : data.rigs) {
    for (MeasuredChannel& c : run.channels) {
      for (double& value : c.values) value = c.channel == channel ? -value : value;
    }
  }
}

void make_rigs(CampaignData& data) {
  RigSpec spec = read_rig(data.campaign.model);
  name_table(data, "fit.fix", [&] {
    for (const auto& [name, value] : data.campaign.fit.fix) set_rig_parameter(spec, name, value);
  });
  for (const MeasuredTable& table : data.tables) {
    RigRun run{table.name, spec, {}, table.times, make_channels(data, table)};
    for (double& t : run.times) t -= table.times.front();
    for (const MeasuredColumn& column : table.columns) {
      if (data.campaign.columns[column.at].role != ColumnRole::kInput) continue;
      InputNoise noise;
      run.inputs.push_back(make_input(data, table, column, noise));
      run.input_noise.push_back(noise);
    }
    try {
      assign_rig_inputs(spec.kind, run.inputs);
    } catch (const ModelError& e) {
      throw InputError(data.campaign.path.string() + ": columns: " + e.what());
    }
    data.rigs.push_back(std::move(run));
  }
  turn_force(data);
}

void make_cars(CampaignData& data) {
  const VehicleSpec vehicle = read_vehicle(data.campaign.model);
  for (std::size_t r = 0; r < data.run_count(); ++r) {
    const CampaignRun& about = data.campaign.runs[r];
    MeasuredRun run{data.tables[r].name,
                    {vehicle, read_maneuver(about.maneuver)},
                    data.tables[r].times,
                    make_channels(data, data.tables[r])};
    run.may_miss = true;
    name_table(data, "fit.fix", [&] {
      for (const auto& [name, value] : data.campaign.fit.fix) set_parameter(run.setup, name, value);
    });
    name_table(data, "run " + about.name, [&] {
      for (const auto& [name, known] : about.known) {
        if (name != "hit_time") set_parameter(run.setup, name, known.mean);
      }
    });
    data.cars.push_back(std::move(run));
  }
}

template <class Run>
std::vector<Run> select(const std::vector<Run>& runs, const std::vector<std::size_t>& chosen) {
  std::vector<Run> list;
  list.reserve(chosen.size());
  for (const std::size_t r : chosen) list.push_back(runs[r]);
  return list;
}

bool is_among(const std::vector<Unknown>& unknowns, const std::string& name) {
  return std::any_of(unknowns.begin(), unknowns.end(),
                     [&](const Unknown& u) { return u.name == name; });
}

/// Replaces what make_nuisances supposes about run number `at` of a subset by what is known.
void apply_known(const std::vector<MeasuredRun>& runs, int at, const std::string& name,
                 const Prior& known, std::vector<Unknown>& unknowns) {
  const auto same = [&](const Unknown& u) { return u.name == name && u.run == at; };
  const auto found = std::find_if(unknowns.begin(), unknowns.end(), same);
  if (known.sigma == 0.0) {
    if (found != unknowns.end()) unknowns.erase(found);
    return;
  }
  Unknown u = name == "hit_time" ? make_hit_time(at, known) : make_parameter(runs, name, at);
  u.prior = known;
  if (found == unknowns.end()) {
    unknowns.push_back(std::move(u));
  } else {
    *found = std::move(u);
  }
}

std::vector<Unknown> make_car_unknowns(const CampaignData& data,
                                       const std::vector<std::size_t>& chosen,
                                       const std::vector<Unknown>& free) {
  const std::vector<MeasuredRun> runs = select(data.cars, chosen);
  // An offset of a sensor must never speak for a cause, so it is all but free.
  constexpr double kWide = 10.0;
  NuisanceSigmas sigmas;
  sigmas.bias = make_default_bias();
  for (double& sigma : sigmas.bias) sigma *= kWide;
  std::vector<Unknown> unknowns = make_nuisances(runs, sigmas, free);
  for (std::size_t r = 0; r < chosen.size(); ++r) {
    for (const auto& [name, known] : data.campaign.runs[chosen[r]].known) {
      if (is_among(free, name)) continue;
      apply_known(runs, static_cast<int>(r), name, known, unknowns);
    }
  }
  return unknowns;
}

std::vector<Unknown> make_rig_nuisances(const CampaignData& data,
                                        const std::vector<std::size_t>& chosen,
                                        const std::vector<Unknown>& free) {
  const std::vector<RigRun> runs = select(data.rigs, chosen);
  std::vector<Unknown> unknowns = make_initial_states(runs);
  for (Unknown& u : make_rig_biases(runs)) {
    if (!is_among(free, u.name)) unknowns.push_back(std::move(u));
  }
  return unknowns;
}

}  // namespace

const NoiseEstimate& CampaignData::find_noise(int channel) const {
  for (std::size_t i = 0; i < noise.size(); ++i) {
    if (campaign.columns[i].channel == info(channel).name) return noise[i];
  }
  throw CheckError("find_noise: no column for " + info(channel).name);
}

std::vector<std::size_t> CampaignData::list_runs(RunUse use) const {
  std::vector<std::size_t> list;
  list.reserve(run_count());
  for (std::size_t r = 0; r < run_count(); ++r) {
    if (campaign.runs[r].use == use) list.push_back(r);
  }
  return list;
}

CampaignData take_run(const CampaignData& data, std::size_t run) {
  CampaignData one;
  one.campaign = data.campaign;
  one.campaign.runs = {data.campaign.runs[run]};
  one.noise = data.noise;
  one.tables = {data.tables[run]};
  if (data.is_rig()) one.rigs = {data.rigs[run]};
  if (!data.is_rig()) one.cars = {data.cars[run]};
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
  data.is_rig() ? make_rigs(data) : make_cars(data);
  check_campaign_data(data);
  make_free_unknowns(data, data.list_runs(RunUse::kFit));  // names what cannot be free
  return data;
}

namespace {

bool is_driven_by(const RigRun& run, const std::string& input) {
  return std::any_of(run.inputs.begin(), run.inputs.end(),
                     [&](const InputSignal& signal) { return signal.channel == input; });
}

/// Gains of inputs that are not known exactly, where they drive some of the runs.
void add_gains(const CampaignData& data, const std::vector<RigRun>& runs,
               std::vector<Unknown>& unknowns) {
  for (const CampaignColumn& c : data.campaign.columns) {
    if (c.role != ColumnRole::kInput || c.gain.sigma == 0.0) continue;
    Unknown u = make_rig_unknown(runs, c.channel + "_gain");
    const auto driven = [&](const RigRun& run) { return is_driven_by(run, c.channel); };
    if (is_among(unknowns, u.name) || std::none_of(runs.begin(), runs.end(), driven)) continue;
    u.prior = c.gain;
    u.start = c.gain.mean;
    unknowns.push_back(std::move(u));
  }
}

}  // namespace

std::vector<Unknown> make_free_unknowns(const CampaignData& data,
                                        const std::vector<std::size_t>& chosen) {
  return name_table(data, "fit.free", [&] {
    std::vector<Unknown> unknowns;
    for (const std::string& name : data.campaign.fit.free) {
      unknowns.push_back(data.is_rig() ? make_rig_unknown(select(data.rigs, chosen), name)
                                       : make_parameter(select(data.cars, chosen), name));
      for (const auto& [of, prior] : data.campaign.fit.prior) {
        if (of != name) continue;
        unknowns.back().prior = prior;
        unknowns.back().start = std::clamp(prior.mean, unknowns.back().low, unknowns.back().high);
      }
    }
    if (data.is_rig()) add_gains(data, select(data.rigs, chosen), unknowns);
    return unknowns;
  });
}

double get_nominal(const CampaignData& data, const Unknown& unknown) {
  if (unknown.kind != UnknownKind::kParameter)
    return unknown.kind == UnknownKind::kInputGain ? 1.0 : 0.0;
  return data.is_rig() ? get_rig_parameter(data.rigs[0].setup, unknown.name)
                       : get_parameter(data.cars[0].setup, unknown.name);
}

std::vector<Unknown> make_run_unknowns(const CampaignData& data,
                                       const std::vector<std::size_t>& runs,
                                       const std::vector<Unknown>& chosen) {
  return data.is_rig() ? make_rig_nuisances(data, runs, chosen)
                       : make_car_unknowns(data, runs, chosen);
}

bool meets_bump(const CampaignData& data, std::size_t run) {
  if (data.is_rig()) return true;
  const RoadSpec& road = data.cars[run].setup.maneuver.road;
  return road.shape != BumpShape::kNone && road.height != 0.0;
}

std::unique_ptr<ReadingModel> make_reading_model(const CampaignData& data,
                                                 const std::vector<std::size_t>& runs,
                                                 std::vector<Unknown> unknowns, int threads) {
  if (data.is_rig()) {
    RigOptions options;
    options.threads = threads;
    return std::make_unique<RigReadings>(select(data.rigs, runs), std::move(unknowns), options);
  }
  LinearizeOptions options;
  options.rate = 1000.0;  // at a campaign's sensors and speeds
  options.threads = threads;
  return std::make_unique<ReadingSimulator>(select(data.cars, runs), std::move(unknowns), options);
}

}  // namespace strut
