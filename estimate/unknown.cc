#include "estimate/unknown.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "model/channel/car_channels.h"
#include "model/error/model_error.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

using C = CarChannel;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const ChannelInfo& get_info(int channel) {
  return list_car_channels()[static_cast<std::size_t>(channel)];
}

std::string describe_run(const Unknown& u) {
  return u.run == kEveryRun ? "" : " of run " + std::to_string(u.run + 1);
}

}  // namespace

Unknown make_parameter(const std::vector<MeasuredRun>& runs, const std::string& name, int run) {
  const ParameterInfo& info = find_parameter(name);
  if (name == "duration") {
    throw InputError("duration: cannot be fitted, it is only how long is simulated");
  }
  const Case& setup = runs.at(run == kEveryRun ? 0 : static_cast<std::size_t>(run)).setup;
  Case probe = setup;
  info.set(probe, info.get(setup));  // refuses what this maneuver does not have
  Unknown u;
  u.name = name;
  u.unit = info.unit;
  u.run = run;
  u.start = info.get(setup);
  u.low = info.allowed.low;
  u.high = info.allowed.high;
  const double ordinary = info.typical > 0.0 ? info.typical : 0.5 * (u.high - u.low);
  u.scale = u.start != 0.0 ? std::abs(u.start) : ordinary;
  return u;
}

Unknown make_hit_time(int run, const Prior& prior) {
  Unknown u;
  u.kind = UnknownKind::kHitTime;
  u.name = "hit_time";
  u.unit = "s";
  u.run = run;
  u.start = prior.mean;
  u.scale = prior.sigma;
  u.low = prior.mean - kHitTimeReach * prior.sigma;
  u.high = prior.mean + kHitTimeReach * prior.sigma;
  u.prior = prior;
  return u;
}

Unknown make_bias(int run, int channel, const Prior& prior) {
  const ChannelInfo& info = get_info(channel);
  Unknown u;
  u.kind = UnknownKind::kBias;
  u.name = info.name + "_bias";
  u.unit = info.unit;
  u.run = run;
  u.channel = channel;
  u.start = prior.mean;
  u.scale = prior.informs() ? prior.sigma : 1.0;
  u.low = -kInfinity;
  u.high = kInfinity;
  u.prior = prior;
  return u;
}

Unknown make_map_unknown(const std::string& name, std::shared_ptr<const ForceMap> part,
                         const Prior& prior) {
  Unknown u;
  u.kind = UnknownKind::kForceMap;
  u.name = name;
  u.unit = "1";
  u.start = prior.mean;
  u.low = -kInfinity;
  u.high = kInfinity;
  u.prior = prior;
  u.part = std::move(part);
  return u;
}

void add_map_part(ForceMaps& maps, const ForceMap& part, double factor) {
  const auto found = std::find_if(maps.begin(), maps.end(),
                                  [&](const ForceMap& map) { return map.place == part.place; });
  const bool is_new = found == maps.end();
  ForceMap& map = is_new ? maps.emplace_back(part) : *found;
  if (is_new) map.coefficients.assign(part.coefficients.size(), 0.0);
  ForceMap grid = part;
  grid.coefficients = map.coefficients;
  if (!(grid == map)) {
    throw ModelError("force map" + (part.place.empty() ? "" : " at " + part.place) +
                     ": what is added has another grid");
  }
  for (std::size_t i = 0; i < part.coefficients.size(); ++i) {
    map.coefficients[i] += factor * part.coefficients[i];
  }
}

std::vector<Unknown> make_nuisances(const std::vector<MeasuredRun>& runs,
                                    const NuisanceSigmas& sigmas,
                                    const std::vector<Unknown>& chosen) {
  const SensorNoise bias = sigmas.bias.empty() ? make_default_bias() : sigmas.bias;
  const bool speed_chosen = std::any_of(chosen.begin(), chosen.end(), [](const Unknown& u) {
    return u.kind == UnknownKind::kParameter && u.name == "speed";
  });
  std::vector<Unknown> list;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const int run = static_cast<int>(r);
    if (sigmas.hit_time > 0.0) list.push_back(make_hit_time(run, {0.0, sigmas.hit_time}));
    if (sigmas.speed > 0.0 && !speed_chosen) {
      list.push_back(make_parameter(runs, "speed", run));
      list.back().prior = {list.back().start, sigmas.speed};
    }
    for (const MeasuredChannel& c : runs[r].channels) {
      const double sigma = bias[static_cast<std::size_t>(c.channel)];
      if (sigma > 0.0) list.push_back(make_bias(run, c.channel, {0.0, sigma}));
    }
  }
  return list;
}

std::vector<double> list_starts(const std::vector<Unknown>& unknowns) {
  std::vector<double> values;
  values.reserve(unknowns.size());
  for (const Unknown& u : unknowns) values.push_back(u.start);
  return values;
}

void set_parameters(Case& c, const std::vector<Unknown>& unknowns,
                    const std::vector<double>& values, int run) {
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Unknown& u = unknowns[i];
    if (!is_of_simulation(u) || (u.run != kEveryRun && u.run != run)) continue;
    if (u.kind == UnknownKind::kForceMap) {
      add_map_part(c.vehicle.force_maps, *u.part, values[i]);
    } else {
      set_parameter(c, u.name, values[i]);
    }
  }
}

void check_unknowns(const std::vector<Unknown>& unknowns, std::size_t run_count) {
  if (unknowns.empty()) throw InputError("fit: nothing is free");
  for (const Unknown& u : unknowns) {
    const auto same = [&](const Unknown& other) {
      return other.name == u.name &&
             (other.run == u.run || other.run == kEveryRun || u.run == kEveryRun);
    };
    const std::string name = u.name + describe_run(u);
    if (std::count_if(unknowns.begin(), unknowns.end(), same) > 1) {
      throw InputError(name + ": free twice; allowed: once");
    }
    if (u.run != kEveryRun && (u.run < 0 || static_cast<std::size_t>(u.run) >= run_count)) {
      throw InputError(name + ": there are " + std::to_string(run_count) + " runs");
    }
    if (!(u.start >= u.low && u.start <= u.high)) {
      throw InputError(name + " = " + format_number(u.start) + ": must start within [" +
                       format_number(u.low) + ", " + format_number(u.high) + "]");
    }
    if (!(u.prior.sigma > 0.0) || !(u.scale > 0.0)) {
      throw InputError(name + ": sigma " + format_number(u.prior.sigma) +
                       " of what is known must be > 0");
    }
  }
}

}  // namespace strut
