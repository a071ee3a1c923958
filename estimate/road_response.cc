#include "estimate/road_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimate/run_prepared.h"
#include "model/error/model_error.h"

namespace strut {
namespace {

constexpr double kInterval = 4e-3;  // s, between samples: a tenth of the period of 25 Hz
constexpr double kStep = 4e-3;      // s
/// Samples of a section, at whose ends the car's state is known.
constexpr std::size_t kSection = 60;
/// s, before the front wheels meet a coefficient, since the car's speed is not quite constant.
constexpr double kBefore = 0.1;

/// A coefficient of a track.
struct Place {
  std::size_t track, number;
};

class Simulator {
 public:
  Simulator(const MeasuredRun& run, const Case& setup, const LinearizeOptions& options,
            CasePreparer& preparer)
      : run_(run), setup_(setup), options_(options) {
    base_ = preparer.prepare(remove_sensors(setup));
    options_.integrate.options.step.step = kStep;
    options_.integrate.options.step.coarse_step = 0.0;
    plan_.interval = kInterval;
    plan_.snapshot = false;
    plan_.recorded = list_recorded({run});
    sections_ = static_cast<std::size_t>(
        std::ceil(base_.duration / (kInterval * static_cast<double>(kSection))));
  }

  std::string run(RoadResponse& response) {
    response.interval = kInterval;
    std::string failure = drive(response);
    if (!failure.empty()) return failure;
    for (std::size_t track = 0; track < setup_.maneuver.rough.size(); ++track) {
      const std::size_t count = setup_.maneuver.rough[track].coefficients.size();
      for (std::size_t i = 0; i < count; ++i) places_.push_back({track, i});
    }
    response.pulses.resize(places_.size());
    std::vector<std::size_t> order, begins;  // the latter: the section in which each begins
    for (std::size_t k = 0; k < places_.size(); ++k) {
      begins.push_back(find_begin(places_[k]));
      if (begins[k] < sections_) order.push_back(k);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return begins[a] < begins[b]; });
    std::vector<PreparedCase> cases;
    std::vector<std::size_t> rests;  // by number in `order`: the case without a pulse
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::size_t begin = begins[order[k]];
      if (k == 0 || begin != begins[order[k - 1]]) {
        rests.push_back(cases.size());
        cases.push_back(make_case(begin));
      } else {
        rests.push_back(rests.back());
      }
      cases.push_back(make_case(begin));
      const Place& place = places_[order[k]];
      cases.back().rough[place.track].coefficients[place.number] += kRoadPulseHeight;
    }
    const std::vector<LaneRun> runs =
        run_prepared(cases, options_.integrate, plan_, options_.threads);
    response.simulation_count += static_cast<long>(runs.size());
    SampledRun rest;
    std::size_t at = 0;
    for (std::size_t k = 0; k < order.size(); ++k, ++at) {
      if (at == rests[k]) {
        failure = explain(runs[at]);
        if (!failure.empty()) return failure;
        rest = get_channels(run_, runs[at++]);
      }
      failure = explain(runs[at]);
      if (!failure.empty()) return failure;
      RoadPulse& pulse = response.pulses[order[k]];
      pulse.first = begins[order[k]] * kSection;
      pulse.change = get_channels(run_, runs[at]);
      for (std::size_t c = 0; c < pulse.change.size(); ++c) {
        std::vector<double>& change = pulse.change[c];
        change.resize(std::min(change.size(), response.rest[c].size() - pulse.first));
        for (std::size_t i = 0; i < change.size(); ++i) change[i] -= rest[c][i];
      }
    }
    return "";
  }

 private:
  /// The whole run without a pulse, section by section.
  std::string drive(RoadResponse& response) {
    response.rest.resize(run_.channels.size());
    starts_ = {base_.start};
    for (std::size_t s = 0; s < sections_; ++s) {
      PreparedCase section = base_;
      section.start = starts_.back();
      section.duration = kInterval * static_cast<double>(kSection);
      const std::vector<LaneRun> runs = run_prepared({section}, options_.integrate, plan_);
      std::string failure = explain(runs.front());
      if (!failure.empty()) return failure;
      for (std::size_t i = 0; i < section.start.size(); ++i) {
        section.start[i] =
            runs.front().results->get_final_state(static_cast<int>(i), runs.front().lane);
      }
      starts_.push_back(section.start);
      const SampledRun sampled = get_channels(run_, runs.front());
      for (std::size_t c = 0; c < sampled.size(); ++c) {
        const std::vector<double>& part = sampled[c];
        const bool is_last = s + 1 == sections_;
        response.rest[c].insert(
            response.rest[c].end(), part.begin(),
            part.begin() + static_cast<std::ptrdiff_t>(is_last ? part.size() : kSection));
      }
    }
    response.simulation_count += 1;
    return "";
  }

  /// The section in which a coefficient's simulation begins; the number of all where no wheel meets
  /// it.
  std::size_t find_begin(const Place& place) const {
    const ManeuverSpec& m = setup_.maneuver;
    const RoughTrack& track = m.rough[place.track];
    const double front = -m.bump_distance - calc_lead(m);
    const double rear = front - setup_.vehicle.whole.wheelbase();
    const double begin = track.begin + track.spacing * static_cast<double>(place.number);
    const double meets = (begin - front) / m.speed;
    const double leaves = (begin + 4.0 * track.spacing - rear) / m.speed;
    if (leaves + kBefore < 0.0 || meets > base_.duration + kBefore) return sections_;
    const double length = kInterval * static_cast<double>(kSection);
    return std::min(static_cast<std::size_t>(std::max(0.0, (meets - kBefore) / length)), sections_);
  }

  /// To the end of the run: road that is long beside the car moves it by many coefficients
  /// together, of whose last motion nothing may be missing.
  PreparedCase make_case(std::size_t begin) const {
    PreparedCase c = base_;
    c.start = starts_[begin];
    c.duration = kInterval * static_cast<double>(kSection * (sections_ - begin));
    return c;
  }

  std::string explain(const LaneRun& result) const {
    if (result.status() == RunStatus::kDone) return "";
    return fmt::format("{}: the simulation of its rough road ends early: {}", run_.name,
                       get_name(result.status()));
  }

  const MeasuredRun& run_;
  const Case& setup_;
  LinearizeOptions options_;
  PreparedCase base_;
  SamplePlan plan_;
  std::size_t sections_ = 0;
  std::vector<State<double>> starts_;  // at the begin of each section
  std::vector<Place> places_;          // of the coefficients
};

}  // namespace

std::string simulate_road_response(const MeasuredRun& run, const Case& setup,
                                   const LinearizeOptions& options, CasePreparer& preparer,
                                   RoadResponse& response) {
  try {
    return Simulator(run, setup, options, preparer).run(response);
  } catch (const ModelError& e) {
    return fmt::format("{}: {}", run.name, e.what());
  }
}

}  // namespace strut
