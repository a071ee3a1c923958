#include "estimate/road_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/parallel/team.h"
#include "estimate/jump_difference.h"
#include "estimate/run_prepared.h"
#include "model/error/model_error.h"

namespace strut {
namespace {

constexpr double kInterval = 4e-3;  // s, between samples: eight in a period of 31 Hz
constexpr double kStep = 4e-3;      // s
/// Samples of a section. Each section costs a simulation for every state and for every coefficient
/// under a wheel; in a longer one, wheels meet more.
constexpr std::size_t kSection = 10;
constexpr double kLength = kInterval * static_cast<double>(kSection);  // s, of a section
/// m, by which a wheel may leave its place along the car as it swings and the chassis pitches.
constexpr double kPlay = 0.05;
constexpr double kChange = 1e-6;  // of a state, in its SI unit
constexpr double kHeight = 2e-5;  // m, of a coefficient's change

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Coefficients of a track: [begin, end).
struct Range {
  Index begin = 0, end = 0;
};

/// A section of the run over the road as it is.
struct Section {
  State<double> start;
  SampledRun samples{};           // kSection + 1 of each channel
  std::array<Range, 2> tracks{};  // by track, all coefficients from the rear wheel to the front
  struct Place {
    std::size_t track;
    Index number;
  };
  std::vector<Place> met{};  // coefficients under a wheel
  /// Whether a wheel lifts off, lands or meets a kink, here or in a section beside.
  bool has_own_event = false, has_event = false;
};

class Simulator {
 public:
  Simulator(const MeasuredRun& run, const Case& setup, const LinearizeOptions& options,
            CasePreparer& preparer)
      : run_(run), setup_(setup), options_(options) {
    base_ = preparer.prepare(remove_sensors(setup));
    options_.integrate.solver = Solver::kLanes;  // CVODE ignores PreparedCase::rough
    options_.integrate.options.step.step = kStep;
    options_.integrate.options.step.locate_events = true;  // which counts them
    options_.integrate.options.step.coarse_step = 0.0;
    plan_.interval = kInterval;
    plan_.snapshot = false;
    plan_.recorded = list_recorded({run});
    section_count_ = static_cast<std::size_t>(std::ceil(base_.duration / kLength));
    base_.duration = kLength;
    for (const RoughTrack& track : setup.maneuver.rough) {
      columns_.push_back(columns_.back() + static_cast<Index>(track.coefficients.size()));
    }
  }

  std::string run(RoadResponse& response) {
    std::string failure = drive();
    if (!failure.empty()) return failure;
    response.interval = kInterval;
    response.samples = static_cast<Index>(section_count_ * kSection + 1);
    response.derivatives = MatrixXd::Zero(
        static_cast<Index>(run_.channels.size()) * response.samples, columns_.back());
    // As many as fill some threads: the cases of more would not stay in a cache.
    constexpr std::size_t kAtOnce = 4;
    std::vector<PreparedCase> cases;
    MatrixXd states = MatrixXd::Zero(state_count_, columns_.back());
    std::size_t simulated = 0;
    for (std::size_t begin = 0; begin < section_count_; begin += kAtOnce) {
      const std::size_t end = std::min(begin + kAtOnce, section_count_);
      cases.clear();
      for (std::size_t s = begin; s < end; ++s) add_changed(sections_[s], cases);
      const std::vector<LaneRun> runs =
          run_prepared(cases, options_.integrate, plan_, options_.threads);
      simulated += runs.size();
      for (const LaneRun& r : runs) {
        failure = explain(r);
        if (!failure.empty()) return failure;
      }
      const LaneRun* of_section = runs.data();
      for (std::size_t s = begin; s < end; ++s) {
        pass_section(s, of_section, states, response.derivatives);
        of_section += count_changed(sections_[s]);
      }
    }
    if (has_sensors(setup_)) apply_sensors(response.derivatives);
    response.simulation_count = static_cast<long>(1 + simulated / section_count_);
    return "";
  }

 private:
  /// The whole run over the road as it is, section by section.
  std::string drive() {
    State<double> start = base_.start;
    for (std::size_t s = 0; s < section_count_; ++s) {
      Section section{start};
      find_coefficients(section);
      const std::vector<LaneRun> runs =
          run_prepared({make_case(section)}, options_.integrate, plan_);
      std::string failure = explain(runs.front());
      if (!failure.empty()) return failure;
      const LaneResults& results = *runs.front().results;
      state_count_ = static_cast<Index>(results.final_state.size()) / results.lanes;
      section.has_own_event = section.has_event = results.event_count > 0;
      section.samples = get_channels(run_, runs.front());
      start = get_final_state(runs.front());
      sections_.push_back(std::move(section));
    }
    sections_.push_back({start});
    // A change may move an event across a section's end.
    for (std::size_t s = 0; s + 1 < section_count_; ++s) {
      const bool is_near = sections_[s].has_own_event || sections_[s + 1].has_own_event;
      sections_[s].has_event |= is_near;
      sections_[s + 1].has_event |= is_near;
    }
    return "";
  }

  /// Number of samples of section `s`. The sample at its end belongs to the next section, if any.
  std::size_t count_samples(std::size_t s) const {
    return kSection + (s + 1 == section_count_ ? 1 : 0);
  }

  /// Sets the coefficients that the wheels may meet during a section.
  void find_coefficients(Section& section) const {
    const ManeuverSpec& m = setup_.maneuver;
    const double front = -m.bump_distance - calc_lead(m) + section.start[StateIndex::kPosition];
    const double rear = front - setup_.vehicle.whole.wheelbase();
    constexpr double kFaster = 1.2;
    const double way = kFaster * std::abs(section.start[StateIndex::kVelocity]) * kLength;
    for (std::size_t track = 0; track < 2; ++track) {
      const Range behind = find_under(m.rough[track], rear - kPlay, rear + way + kPlay);
      const Range ahead = find_under(m.rough[track], front - kPlay, front + way + kPlay);
      section.tracks[track] = {behind.begin, ahead.end};
      for (Index i = behind.begin; i < ahead.end; ++i) {
        if (i < behind.end || i >= ahead.begin) section.met.push_back({track, i});
      }
    }
  }

  /// The coefficients whose splines reach between two places [m] from the bump's center.
  static Range find_under(const RoughTrack& track, double from, double to) {
    constexpr double kSupport = 4.0;
    const auto find = [&](double number) {
      const auto count = static_cast<double>(track.coefficients.size());
      return static_cast<Index>(std::clamp(number, 0.0, count));
    };
    return {find(std::floor((from - track.begin) / track.spacing) - kSupport + 1.0),
            find(std::ceil((to - track.begin) / track.spacing))};
  }

  PreparedCase make_case(const Section& section) const {
    PreparedCase c = base_;
    c.start = section.start;
    for (std::size_t side = 0; side < 2; ++side) {
      const RoughTrack& track = base_.rough[side];
      const auto [begin, end] = section.tracks[side];
      c.rough[side] = {track.begin + track.spacing * static_cast<double>(begin),
                       track.spacing,
                       {track.coefficients.begin() + begin, track.coefficients.begin() + end}};
    }
    return c;
  }

  /// Cases for each state, up and, where there is an event, down; then one for each coefficient
  /// under a wheel.
  void add_changed(const Section& section, std::vector<PreparedCase>& cases) const {
    const std::size_t begin = cases.size();
    cases.insert(cases.end(), count_changed(section), make_case(section));
    PreparedCase* c = cases.data() + begin;
    for (Index i = 0; i < state_count_; ++i) {
      (c++)->start[static_cast<std::size_t>(i)] += kChange;
      if (section.has_event) (c++)->start[static_cast<std::size_t>(i)] -= kChange;
    }
    for (const auto& [track, number] : section.met) {
      const Index at = number - section.tracks[track].begin;
      (c++)->rough[track].coefficients[static_cast<std::size_t>(at)] += kHeight;
    }
  }

  Index count_changed_states(const Section& section) const {
    return section.has_event ? 2 * state_count_ : state_count_;
  }

  std::size_t count_changed(const Section& section) const {
    return static_cast<std::size_t>(count_changed_states(section)) + section.met.size();
  }

  /// Differences of a changed section from the one over the road as it is: samples, channel by
  /// channel, then the states at its end.
  VectorXd calc_change(std::size_t s, const LaneRun& changed) const {
    const Section& section = sections_[s];
    const SampledRun sampled = get_channels(run_, changed);
    const State<double> end = get_final_state(changed);
    const std::size_t samples = count_samples(s);
    VectorXd change(static_cast<Index>(sampled.size() * samples) + state_count_);
    Index row = 0;
    for (std::size_t c = 0; c < sampled.size(); ++c) {
      for (std::size_t i = 0; i < samples; ++i) {
        change(row++) = sampled[c][i] - section.samples[c][i];
      }
    }
    for (std::size_t i = 0; row < change.size(); ++i) {
      change(row++) = end[i] - sections_[s + 1].start[i];
    }
    return change;
  }

  /// The derivative by a state. A wheel that lands as a sample is taken makes that one jump: then
  /// by the side without it.
  VectorXd calc_by_state(std::size_t s, const LaneRun* up_and_down) const {
    const VectorXd up = calc_change(s, up_and_down[0]), down = calc_change(s, up_and_down[1]);
    const auto samples = static_cast<Index>(count_samples(s));
    VectorXd derivative(up.size());
    for (Index row = 0; row < up.size(); ++row) {
      const auto channel = static_cast<std::size_t>(row / samples);
      const double unit = channel < run_.channels.size() ? run_.channels[channel].sigma : 1.0;
      derivative(row) =
          unit * calc_jump_free_difference(-down(row) / unit, up(row) / unit) / (2.0 * kChange);
    }
    return derivative;
  }

  /// Propagates the derivatives through a section. `states`: of the states at its begin, then at
  /// its end; sets the rows of its samples in `derivatives`.
  void pass_section(std::size_t s, const LaneRun* changed, MatrixXd& states,
                    MatrixXd& derivatives) const {
    const Section& section = sections_[s];
    const auto samples = static_cast<Index>(count_samples(s));
    const auto channels = static_cast<Index>(section.samples.size());
    const auto met = static_cast<Index>(section.met.size());
    // Rows: the samples, channel by channel, then the states at the end.
    MatrixXd by_states(channels * samples + state_count_, state_count_);
    MatrixXd by_met(by_states.rows(), met);
    for (Index i = 0; i < state_count_; ++i) {
      by_states.col(i) = section.has_event ? calc_by_state(s, changed + 2 * i)
                                           : VectorXd(calc_change(s, changed[i]) / kChange);
    }
    const LaneRun* changed_road = changed + count_changed_states(section);
    for (Index i = 0; i < met; ++i) by_met.col(i) = calc_change(s, changed_road[i]) / kHeight;
    for (std::size_t track = 0; track < 2; ++track) {
      // The wheels have met no coefficient beyond the section's last.
      const Index first = columns_[track], count = section.tracks[track].end;
      MatrixXd after = by_states * states.middleCols(first, count);
      for (Index i = 0; i < met; ++i) {
        const Section::Place& place = section.met[static_cast<std::size_t>(i)];
        if (place.track == track) after.col(place.number) += by_met.col(i);
      }
      for (Index c = 0; c < channels; ++c) {
        const Index begin = c * (derivatives.rows() / channels) + static_cast<Index>(s * kSection);
        derivatives.block(begin, first, samples, count) = after.middleRows(c * samples, samples);
      }
      states.middleCols(first, count) = after.bottomRows(state_count_);
    }
  }

  /// Replaces derivatives of the true values by those of the sensors' readings, which are a linear
  /// function of the true values plus a bias.
  void apply_sensors(MatrixXd& derivatives) const {
    const auto samples = static_cast<std::size_t>(derivatives.rows()) / run_.channels.size();
    const SampledRun zero(run_.channels.size(), std::vector<double>(samples, 0.0));
    const SampledRun bias = read_sensors(setup_, run_, kInterval, zero);
    share_items(options_.threads, static_cast<std::size_t>(derivatives.cols()),
                [&](std::size_t k, int) {
                  auto column = derivatives.col(static_cast<Index>(k));
                  SampledRun sampled = zero;
                  Index row = 0;
                  for (std::vector<double>& channel : sampled) {
                    for (double& value : channel) value = column(row++);
                  }
                  sampled = read_sensors(setup_, run_, kInterval, std::move(sampled));
                  row = 0;
                  for (std::size_t c = 0; c < sampled.size(); ++c) {
                    for (std::size_t i = 0; i < samples; ++i) {
                      column(row++) = sampled[c][i] - bias[c][i];
                    }
                  }
                });
  }

  /// Zero beyond the states that the car has.
  State<double> get_final_state(const LaneRun& result) const {
    State<double> state{};
    for (Index i = 0; i < state_count_; ++i) {
      state[static_cast<std::size_t>(i)] =
          result.results->get_final_state(static_cast<int>(i), result.lane);
    }
    return state;
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
  std::size_t section_count_ = 0;
  std::vector<Section> sections_;  // the last only holds the state at the run's end
  Index state_count_ = 0;
  std::vector<Index> columns_ = {0};  // the first of each track, and the number of all
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
