#include "estimate/nuisances.h"

#include <algorithm>
#include <cmath>

#include "base/math/spread.h"
#include "estimate/simulate_run.h"

namespace strut {
namespace {

// --- cars on a road --------------------------------------------------------------------------

void add_crossing(const std::vector<MeasuredRun>& runs, std::size_t r, const NuisanceSigmas& sigmas,
                  const std::vector<Unknown>& chosen, std::vector<Unknown>& list) {
  const SensorNoise bias = sigmas.bias.empty() ? make_default_bias() : sigmas.bias;
  const int run = static_cast<int>(r);
  if (sigmas.hit_time > 0.0) list.push_back(make_hit_time(run, {0.0, sigmas.hit_time}));
  if (sigmas.speed > 0.0 && !is_among(chosen, kSpeedName)) {
    list.push_back(make_parameter(runs, kSpeedName, run));
    list.back().prior = {list.back().start, sigmas.speed};
  }
  for (const MeasuredChannel& c : runs[r].channels) {
    const double sigma = bias[static_cast<std::size_t>(c.channel)];
    if (!(sigma > 0.0)) continue;
    Unknown u = make_bias(runs[r].setup.info(), run, c.channel, {0.0, sigma});
    if (!is_among(chosen, u.name)) list.push_back(std::move(u));
  }
}

// --- runs that recorded inputs drive ---------------------------------------------------------

/// The first reading of a position relative to the ground [m]; 0 where it is not measured.
double read_first_offset(const MeasuredRun& run, int position) {
  for (const MeasuredChannel& c : run.channels) {
    if (c.channel != position) continue;
    const auto there =
        std::find_if(c.values.begin(), c.values.end(), [](double v) { return std::isfinite(v); });
    if (there == c.values.end()) return 0.0;
    double ground = 0.0;
    const ModelInfo& model = run.setup.info();
    for (const InputSignal& signal : run.setup.rig().inputs) {
      const auto input = static_cast<std::size_t>(find_input(model, signal.channel));
      if (model.inputs[input].is_ground) ground = calc_signal(signal, 0.0).value;
    }
    return *there - ground;
  }
  return 0.0;
}

/// `state` as in Unknown::state.
Unknown make_initial_state(const MeasuredRun& run, int index, const RunCurves& curves, int state) {
  const ModelInfo& model = run.setup.info();
  const int masses = static_cast<int>(model.masses.size());
  const bool is_rate = state >= masses;
  const MassInfo& mass = model.masses[static_cast<std::size_t>(state % masses)];
  const int channel = is_rate ? mass.velocity : mass.position;
  const auto at = static_cast<std::size_t>(channel);
  Unknown u;
  u.kind = UnknownKind::kInitialState;
  u.name = "initial_" + model.channels[at].name;
  u.unit = model.channels[at].unit;
  u.run = index;
  u.state = state;
  const double spread = curves.failure.empty() ? calc_spread(curves.channel[at]) : 0.0;
  u.start = is_rate ? 0.0 : read_first_offset(run, channel);
  u.scale = std::max(spread, std::abs(u.start));
  if (u.scale == 0.0) u.scale = 1e-3;  // nothing moves, so any small number will do
  u.prior = {u.start, u.scale};
  u.low = u.start - 100.0 * u.scale;
  u.high = u.start + 100.0 * u.scale;
  return u;
}

void add_initial_states(const MeasuredRun& run, int index, std::vector<Unknown>& list) {
  const int count = 2 * static_cast<int>(run.setup.info().masses.size());
  if (count == 0) return;
  const RunCurves curves = simulate_run(run, {}, {});
  for (int i = 0; i < count; ++i) list.push_back(make_initial_state(run, index, curves, i));
}

void add_biases(const MeasuredRun& run, int index, const std::vector<Unknown>& chosen,
                std::vector<Unknown>& list) {
  for (const MeasuredChannel& c : run.channels) {
    const double wide = std::max(calc_spread(c.values), c.sigma);
    Unknown u = make_bias(run.setup.info(), index, c.channel, {0.0, wide});
    if (!is_among(chosen, u.name)) list.push_back(std::move(u));
  }
}

}  // namespace

std::vector<Unknown> make_nuisances(const std::vector<MeasuredRun>& runs,
                                    const NuisanceSigmas& sigmas,
                                    const std::vector<Unknown>& chosen) {
  std::vector<Unknown> list;
  const auto is_driven = [&](std::size_t r) { return runs[r].setup.info().is_driven_by_inputs(); };
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (is_driven(r)) add_initial_states(runs[r], static_cast<int>(r), list);
  }
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (is_driven(r)) {
      add_biases(runs[r], static_cast<int>(r), chosen, list);
    } else {
      add_crossing(runs, r, sigmas, chosen, list);
    }
  }
  return list;
}

}  // namespace strut
