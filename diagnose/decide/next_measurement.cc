#include "diagnose/decide/next_measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/text/format_number.h"

namespace strut {
namespace {

/// A possible run.
struct Proposal {
  std::string description;
  CampaignData data;  // with that run alone
};

void add_crossings(const CampaignData& data, std::size_t run, std::vector<Proposal>& menu) {
  constexpr double kKilometersPerHour = 3.6;
  for (const double factor : {0.5, 0.75, 1.5, 2.0}) {
    CampaignData one = take_run(data, run);
    ManeuverSpec& m = one.runs[0].setup.car().maneuver;
    if (m.road.shape == BumpShape::kNone) return;
    // The car reaches the bump at the same time.
    m.speed *= factor;
    m.bump_distance *= factor;
    menu.push_back({fmt::format("repeat {} at {} km/h", data.campaign.runs[run].name,
                                format_rounded(std::round(kKilometersPerHour * m.speed))),
                    std::move(one)});
  }
  for (const double factor : {0.5, 1.5}) {
    CampaignData one = take_run(data, run);
    RoadSpec& road = one.runs[0].setup.car().maneuver.road;
    road.height *= factor;
    menu.push_back({fmt::format("repeat {} over a bump of {} mm", data.campaign.runs[run].name,
                                format_rounded(std::round(1e3 * road.height))),
                    std::move(one)});
  }
}

void add_amplitudes(const CampaignData& data, std::size_t run, std::vector<Proposal>& menu) {
  for (const double factor : {0.3, 2.0, 4.0}) {
    CampaignData one = take_run(data, run);
    for (InputSignal& signal : one.runs[0].setup.rig().inputs) {
      const auto input = static_cast<std::size_t>(find_input(data.model(), signal.channel));
      if (data.model().inputs[input].moves) scale_signal(signal, factor);
    }
    menu.push_back({fmt::format("repeat {} at {} times its amplitude", data.campaign.runs[run].name,
                                format_rounded(factor)),
                    std::move(one)});
  }
}

const Candidate* find_candidate(const SelectRound& round, const Cause& cause) {
  const auto found =
      std::find_if(round.candidates.begin(), round.candidates.end(), [&](const Candidate& c) {
        return c.hypothesis.effect == cause.effect && c.hypothesis.place == cause.place;
      });
  return found == round.candidates.end() ? nullptr : &*found;
}

/// The shared values of the model with either of two hypotheses.
struct Rivals {
  SharedValues a, b;
};

/// The rivals as fitted in one round: those of two rounds also differ by the causes found between.
std::optional<Rivals> find_rivals(const Selection& selection, const Cause& a, const Cause& b) {
  for (const SelectRound& round : selection.rounds) {
    const Candidate *first = find_candidate(round, a), *second = find_candidate(round, b);
    if (first != nullptr && second != nullptr) return Rivals{first->shared, second->shared};
  }
  return std::nullopt;
}

/// Sum over the readings of the squared difference of two models in units of the sensors' noise.
double calc_difference(const CampaignData& one, const SharedValues& a, const SharedValues& b) {
  const RunCurves first = simulate_run(one.runs[0], a.unknowns, a.values);
  const RunCurves second = simulate_run(one.runs[0], b.unknowns, b.values);
  if (!first.failure.empty() || !second.failure.empty()) return 0.0;
  double sum = 0.0;
  for (const MeasuredChannel& c : one.channels(0)) {
    const auto at = static_cast<std::size_t>(c.channel);
    for (std::size_t t = 0; t < first.channel[at].size(); ++t) {
      const double d = (first.channel[at][t] - second.channel[at][t]) / c.sigma;
      if (std::isfinite(d)) sum += d * d;
    }
  }
  return sum;
}

/// The proposal without a group to be distinguished.
std::string propose_confirmation(const Selection& selection) {
  if (!selection.causes.empty()) {
    return "repeat one of the held-out runs at another speed or amplitude: the cause and its "
           "parameters should stay the same";
  }
  if (selection.is_left) {
    return "repeat a run at half and at twice its amplitude, and once unchanged: this shows "
           "whether the unknown cause grows with the motion, stays constant, or disappears";
  }
  return "none is needed for these runs; larger bumps or amplitudes would show effects that are "
         "hidden here";
}

}  // namespace

std::string propose_measurement(const CampaignData& data, const Selection& selection,
                                const std::vector<Cause>& group) {
  if (group.size() < 2) return propose_confirmation(selection);
  const std::optional<Rivals> rivals = find_rivals(selection, group[0], group[1]);
  const std::string pair =
      fmt::format("{} from {}", describe_effect(group[0].effect, group[0].place),
                  describe_effect(group[1].effect, group[1].place));
  if (!rivals) return "separate " + pair;
  const auto& [a, b] = *rivals;
  std::vector<Proposal> menu;
  double existing = 0.0;
  for (const std::size_t r : data.list_runs(RunUse::kFit)) {
    existing = std::max(existing, calc_difference(take_run(data, r), a, b));
    data.has_inputs() ? add_amplitudes(data, r, menu) : add_crossings(data, r, menu);
  }
  double max_difference = existing;
  std::string best;
  for (const Proposal& proposal : menu) {
    const double difference = calc_difference(proposal.data, a, b);
    if (difference <= max_difference) continue;
    max_difference = difference;
    best = proposal.description;
  }
  if (best.empty()) {
    return fmt::format(
        "no other speed, bump or amplitude separates {} better than these runs; add another sensor",
        pair);
  }
  return fmt::format("{}: separates {} ({} standard deviations, {} in the existing runs)", best,
                     pair, format_rounded(std::sqrt(max_difference)),
                     format_rounded(std::sqrt(existing)));
}

}  // namespace strut
