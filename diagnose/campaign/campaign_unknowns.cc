#include "diagnose/campaign/campaign_unknowns.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/math/spread.h"
#include "diagnose/campaign/name_table.h"
#include "estimate/nuisances.h"
#include "model_files/read_model.h"

namespace strut {
namespace {

/// Replaces an unknown of run number `at` by the campaign's prior; removes it if known exactly.
void apply_known(const std::vector<MeasuredRun>& runs, int at, const std::string& name,
                 const Prior& known, std::vector<Unknown>& unknowns) {
  const auto same = [&](const Unknown& u) { return u.name == name && u.run == at; };
  const auto found = std::find_if(unknowns.begin(), unknowns.end(), same);
  if (known.sigma == 0.0) {
    if (found != unknowns.end()) unknowns.erase(found);
    return;
  }
  Unknown u = name == kHitTimeName ? make_hit_time(at, known) : make_parameter(runs, name, at);
  u.prior = known;
  if (found == unknowns.end()) {
    unknowns.push_back(std::move(u));
  } else {
    *found = std::move(u);
  }
}

/// Whether two runs cross bumps of the same size, on one side or both.
bool cross_same_bump(const MeasuredRun& a, const MeasuredRun& b) {
  RoadSpec of_a = a.setup.car().maneuver.road, of_b = b.setup.car().maneuver.road;
  of_a.side = of_b.side;
  return of_a == of_b;
}

/// A bump that n runs cross was surveyed once: all of them have that one error. Each run has an
/// unknown of its own; with sqrt(n) times the survey's sigma, what they have in common is as
/// uncertain as the survey, and what they do not is for the readings to say.
void share_surveys(const std::vector<MeasuredRun>& runs, std::vector<Unknown>& unknowns) {
  std::vector<double> widths(unknowns.size(), 1.0);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Unknown& u = unknowns[i];
    if (u.run == kEveryRun || (u.name != "bump_height" && u.name != "bump_length")) continue;
    const auto count = std::count_if(unknowns.begin(), unknowns.end(), [&](const Unknown& other) {
      return other.name == u.name && other.prior.mean == u.prior.mean &&
             other.prior.sigma == u.prior.sigma &&
             cross_same_bump(runs[static_cast<std::size_t>(u.run)],
                             runs[static_cast<std::size_t>(other.run)]);
    });
    widths[i] = std::sqrt(static_cast<double>(count));
  }
  for (std::size_t i = 0; i < unknowns.size(); ++i) unknowns[i].prior.sigma *= widths[i];
}

/// Adds the gains of inputs that are not known exactly and drive any of the runs.
void add_gains(const CampaignData& data, const std::vector<MeasuredRun>& runs,
               std::vector<Unknown>& unknowns) {
  for (const CampaignColumn& c : data.campaign.columns) {
    if (c.role != ColumnRole::kInput || c.gain.sigma == 0.0) continue;
    const std::string& input = data.get_input(c).name;
    Unknown u = make_shared_unknown(runs, input + "_gain");
    const auto driven = [&](const MeasuredRun& run) { return find_input(run, input) != nullptr; };
    if (is_among(unknowns, u.name) || std::none_of(runs.begin(), runs.end(), driven)) continue;
    u.prior = c.gain;
    u.start = c.gain.mean;
    unknowns.push_back(std::move(u));
  }
}

/// Adds the gain errors and skews of all channels of the runs. Recorded inputs have errors as large
/// as those of the outputs; a linear rig responds to them as if they were the outputs' own.
void add_sensor_errors(const CampaignData& data, const std::vector<MeasuredRun>& runs,
                       std::vector<Unknown>& unknowns) {
  const SensorTolerance& tolerance = data.campaign.noise.sensor;
  const auto add = [&](UnknownKind kind, int channel, double sigma) {
    if (!(sigma > 0.0)) return;
    const double both = data.has_inputs() ? std::numbers::sqrt2 * sigma : sigma;
    Unknown u = make_sensor_unknown(kind, data.model(), kEveryRun, channel, both);
    if (!is_among(unknowns, u.name)) unknowns.push_back(std::move(u));
  };
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) {
      add(UnknownKind::kSensorGain, c.channel, tolerance.gain);
      add(UnknownKind::kSensorSkew, c.channel, tolerance.skew);
    }
  }
}

/// The bias of an input's sensor in a run and, of an acceleration, the initial velocity, too. Where
/// nothing is known of a bias, it may be as large as the readings.
void add_input_biases(const CampaignData& data, std::size_t run, int index,
                      std::vector<Unknown>& unknowns) {
  for (const MeasuredColumn& column : data.tables[run].columns) {
    const CampaignColumn& c = data.campaign.columns[column.at];
    if (c.role != ColumnRole::kInput || c.bias.sigma == 0.0) continue;
    const auto add = [&](int derivative, const Prior& known, double spread) {
      const Prior prior = known.informs() ? known : Prior{known.mean, spread};
      if (!(prior.sigma > 0.0)) return;
      const InputDerivative sensor{c.input.input, derivative};
      Unknown u = make_input_bias(data.model(), index, sensor, prior, 0.0);
      if (!is_among(unknowns, u.name)) unknowns.push_back(std::move(u));
    };
    add(c.input.derivative, c.bias, calc_spread(column.values));
    if (c.input.derivative < kMaxInputDerivative) continue;
    const InputSignal& signal = *find_input(data.runs[run], data.get_input(c).name);
    std::vector<double> rates;
    rates.reserve(data.times(run).size());
    for (const double t : data.times(run)) rates.push_back(calc_signal(signal, t).rate);
    add(c.input.derivative - 1, {}, calc_spread(rates));
  }
}

}  // namespace

std::vector<Unknown> make_free_unknowns(const CampaignData& data,
                                        const std::vector<std::size_t>& chosen) {
  return name_table(data.campaign, "fit.free", [&] {
    const std::vector<MeasuredRun> runs = data.select(chosen);
    std::vector<Unknown> unknowns;
    for (const std::string& name : data.campaign.fit.free) {
      unknowns.push_back(make_shared_unknown(runs, name));
      for (const auto& [key, prior] : data.campaign.fit.prior) {
        if (key != name) continue;
        unknowns.back().prior = prior;
        unknowns.back().start = std::clamp(prior.mean, unknowns.back().low, unknowns.back().high);
      }
    }
    add_gains(data, runs, unknowns);
    if (!unknowns.empty()) add_sensor_errors(data, runs, unknowns);
    return unknowns;
  });
}

double get_nominal(const CampaignData& data, const Unknown& unknown) {
  if (unknown.kind == UnknownKind::kParameter) {
    return get_parameter(data.runs[0].setup, unknown.name);
  }
  return unknown.kind == UnknownKind::kInputGain ? 1.0 : 0.0;
}

std::vector<Unknown> make_run_unknowns(const CampaignData& data,
                                       const std::vector<std::size_t>& runs,
                                       const std::vector<Unknown>& chosen) {
  const std::vector<MeasuredRun> selected = data.select(runs);
  // Nearly free, so that the offset of a sensor never counts as evidence for a cause.
  constexpr double kWide = 10.0;
  NuisanceSigmas sigmas;
  sigmas.bias = make_default_bias();
  for (double& sigma : sigmas.bias) sigma *= kWide;
  std::vector<Unknown> unknowns = make_nuisances(selected, sigmas, chosen);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    std::vector<Unknown> biases;
    add_input_biases(data, runs[r], static_cast<int>(r), biases);
    for (Unknown& u : biases) {
      if (!is_among(chosen, u.name)) unknowns.push_back(std::move(u));
    }
  }
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const auto& [name, known] : data.campaign.runs[runs[r]].known) {
      if (is_among(chosen, name)) continue;
      apply_known(selected, static_cast<int>(r), name, known, unknowns);
    }
  }
  share_surveys(selected, unknowns);
  return unknowns;
}

}  // namespace strut
