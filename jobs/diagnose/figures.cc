#include "jobs/diagnose/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "diagnose/baseline/model_states.h"
#include "jobs/compare/figures.h"
#include "jobs/diagnose/force_map.h"
#include "jobs/diagnose/tables.h"

namespace strut {
namespace {

using Values = std::vector<double>;

bool is_motion(const StateCurve& state) { return state.info->kind != StateKind::kTireLoad; }

std::vector<const DiagnosedRun*> list_held_out(const CampaignData& data,
                                               const Diagnosis& diagnosis) {
  std::vector<const DiagnosedRun*> runs;
  for (const DiagnosedRun& run : diagnosis.runs) {
    if (data.campaign.runs[run.run].use == RunUse::kHoldOut) runs.push_back(&run);
  }
  return runs;
}

/// The residual of a channel with a state of the model, over all runs.
struct PooledState {
  std::string name, unit;
  Values state, residual;
};
using PooledChannels = std::map<int, std::vector<PooledState>>;  // by index in ModelInfo::channels

void pool(const CampaignData& data, std::size_t run, const RunEvaluation& evaluation,
          PooledChannels& pooled) {
  const std::vector<StateCurve> states = list_states(data, evaluation.curves);
  const std::vector<MeasuredChannel>& channels = data.channels(run);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    std::vector<PooledState>& all = pooled[channels[k].channel];
    if (all.empty()) {
      for (const StateCurve& s : states) {
        if (is_motion(s)) all.push_back({s.info->name, s.info->unit, {}, {}});
      }
    }
    const Values& residual = evaluation.residual[k];
    auto into = all.begin();
    for (const StateCurve& s : states) {
      if (!is_motion(s)) continue;
      into->state.insert(into->state.end(), s.values.begin(), s.values.end());
      into->residual.insert(into->residual.end(), residual.begin(), residual.end());
      ++into;
    }
  }
}

ChartSeries make_mean_line(const PooledState& pooled, const ModelCurves& model) {
  ChartSeries line{model.name, SeriesKind::kLinePoints, model.color};
  for (const StateBin& bin :
       calc_state_residual(pooled.name, pooled.unit, pooled.state, pooled.residual).bins) {
    if (bin.count == 0) continue;
    line.x.push_back(bin.center);
    line.y.push_back(bin.mean);
  }
  return line;
}

/// Adds one model's residuals by channel and state to the panels, which the first model creates.
void add_state_lines(const CampaignData& data, const PooledChannels& pooled,
                     const ModelCurves& model, std::vector<ChartPanel>& panels) {
  const bool is_first = panels.empty();
  std::size_t panel = 0;
  for (const auto& [channel, states] : pooled) {
    const ChannelInfo& info = data.info(channel);
    for (std::size_t s = 0; s < states.size(); ++s, ++panel) {
      if (is_first) {
        panels.push_back(
            {{make_label(states[s].name, states[s].unit)}, {make_residual_label(info)}, {}});
      }
      panels[panel].series.push_back(make_mean_line(states[s], model));
    }
  }
}

/// Points of a force over a motion.
struct ForceLaw {
  std::string x_label, y_label;
  ChartSeries points{"", SeriesKind::kPoints};
};

void add_points(const Values& x, const Values& y, ChartSeries& points) {
  const std::size_t stride = choose_stride(x.size());
  for (std::size_t t = 0; t < x.size(); t += stride) {
    points.x.push_back(x[t]);
    points.y.push_back(y[t]);
  }
}

/// The law with these labels, created if new: the corners of an axle share theirs.
ForceLaw& find_law(std::vector<ForceLaw>& laws, const std::string& x_label,
                   const std::string& y_label) {
  const auto found = std::find_if(laws.begin(), laws.end(),
                                  [&](const ForceLaw& law) { return law.x_label == x_label; });
  return found != laws.end() ? *found : laws.emplace_back(ForceLaw{x_label, y_label});
}

/// Spring force over deflection and damper force over velocity, by axle; where a stand measures the
/// force of the whole strut, that over both.
std::vector<ForceLaw> list_laws(const CampaignData& data, const RunCurves& curves) {
  const ModelInfo& model = data.model();
  std::vector<ForceLaw> laws;
  const auto add = [&](const StrutInfo& strut, const std::string& motion, const std::string& unit,
                       const ChannelSum& sum, int own_force, const char* own_name) {
    const bool is_whole = model.stand_force >= 0;
    const int force = is_whole ? model.stand_force : own_force;
    const std::string prefix = strut.place.empty() ? "" : strut.place + "_";
    const std::string name = is_whole ? data.info(force).name : prefix + own_name;
    add_points(calc_sum(sum, curves.channel), curves.channel[static_cast<std::size_t>(force)],
               find_law(laws, make_label(motion, unit), make_label(name, "N")).points);
  };
  for (const StrutInfo& s : model.struts) {
    add(s, s.deflection_name, "m", s.deflection, s.spring_force, "spring_force");
    add(s, s.velocity_name, "m/s", s.velocity, s.damper_force, "damper_force");
  }
  return laws;
}

/// Adds the measured force of the whole strut over the motion that a stand imposes.
void add_measured_force(const CampaignData& data, const DiagnosedRun& run,
                        std::vector<ChartPanel>& panels) {
  const ModelInfo& model = data.model();
  if (model.stand_force < 0) return;
  for (const MeasuredChannel& c : data.channels(run.run)) {
    if (c.channel != model.stand_force) continue;
    auto panel = panels.begin();
    for (const ChannelSum& sum : {model.struts[0].deflection, model.struts[0].velocity}) {
      ChartSeries points{"measured", SeriesKind::kPoints, kMeasuredColor};
      add_points(calc_sum(sum, run.before.evaluation.curves.channel), c.values, points);
      (panel++)->series.push_back(std::move(points));
    }
  }
}

Chart make_law_chart(const CampaignData& data, const Diagnosis& diagnosis,
                     const DiagnosedRun& run) {
  Chart chart{"force_law", {}, 2};
  chart.caption =
      fmt::format("Forces of the models over the motion, as read by their sensors, in {}.",
                  data.campaign.runs[run.run].name);
  for (const ForceLaw& law : list_laws(data, run.before.evaluation.curves)) {
    chart.panels.push_back({{law.x_label}, {law.y_label}, {}});
  }
  add_measured_force(data, run, chart.panels);  // a cloud, under the lines of the models
  for (const ModelCurves& model : list_model_curves(diagnosis, run)) {
    if (!model.is_simulated()) continue;
    std::size_t panel = 0;
    for (ForceLaw& law : list_laws(data, model.evaluation->curves)) {
      law.points.name = model.name;
      law.points.color = model.color;
      chart.panels[panel++].series.push_back(std::move(law.points));
    }
  }
  return chart;
}

std::optional<BodyBalance> calc_balance(const CampaignData& data, std::size_t run,
                                        const WhitenedFit& fit) {
  if (fit.runs.empty()) return std::nullopt;
  const SharedValues shared = fit.shared();
  return calc_body_balance(set_unknowns(data.runs[run], shared.unknowns, shared.values));
}

}  // namespace

std::vector<Chart> make_run_charts(const CampaignData& data, const Diagnosis& diagnosis,
                                   const DiagnosedRun& run) {
  const std::vector<ModelCurves> models = list_model_curves(diagnosis, run);
  if (!models.front().is_simulated()) return {};
  std::vector<Chart> charts = {make_curve_chart(data, run.run, models)};
  const auto before = calc_balance(data, run.run, diagnosis.selection.base);
  const auto after = calc_balance(data, run.run, diagnosis.selection.extended);
  if (!before) return charts;
  std::vector<BalancePoints> balances = {{models.front().name, models.front().color, &*before}};
  if (after && models.size() > 1) {
    balances.push_back({models.back().name, models.back().color, &*after});
  }
  charts.push_back(make_balance_chart(make_run_name(data, run.run) + "_balance", balances));
  charts.back().caption =
      "Body balance without the road: the force on the sprung mass that the strut does not "
      "explain.";
  return charts;
}

std::vector<Chart> make_cause_charts(const Diagnosis& diagnosis) {
  constexpr double kMinVisible = 0.005;
  ChartPanel panel{{""}, {"probability"}, {}};
  const auto add = [&](const std::vector<Cause>& causes, const std::string& role, int color) {
    ChartSeries bars{role, SeriesKind::kBars, color};
    bars.width = kBarWidth;
    for (const Cause& cause : causes) {
      std::string label = cause.effect + (cause.place.empty() ? "" : ", " + cause.place);
      const auto& seen = panel.x.categories;
      const bool is_new = std::find(seen.begin(), seen.end(), label) == seen.end();
      if (cause.probability < kMinVisible || !is_new) continue;
      panel.x.categories.push_back(std::move(label));
      bars.x.push_back(static_cast<double>(panel.x.categories.size()));
      bars.y.push_back(cause.probability);
    }
    if (!bars.x.empty()) panel.series.push_back(std::move(bars));
  };
  add(diagnosis.verdict.list_causes(), "cause", 1);
  add(diagnosis.verdict.list_group(), "not distinguished", 6);
  add(diagnosis.verdict.list_runners_up(), "runner-up", 5);
  if (panel.series.empty()) return {};
  ChartSeries unknown{"unknown", SeriesKind::kBars, 4};
  unknown.width = kBarWidth;
  const auto add_unknown = [&](const std::string& label, double probability) {
    panel.x.categories.push_back(label);
    unknown.x.push_back(static_cast<double>(panel.x.categories.size()));
    unknown.y.push_back(probability);
  };
  const std::vector<CausePosition>& positions = diagnosis.verdict.positions;
  if (positions.size() < 2) add_unknown("none of the catalogue", diagnosis.verdict.unknown_share);
  for (std::size_t i = 0; positions.size() > 1 && i < positions.size(); ++i) {
    add_unknown(fmt::format("none, for cause {}", i + 1), positions[i].unknown);
  }
  panel.series.push_back(std::move(unknown));
  panel.y.range = {0.0, 1.0};
  Chart chart{"probabilities", {std::move(panel)}};
  chart.caption =
      "Probabilities of the causes; where several act at once, the probability of being one of "
      "them.";
  return {chart};
}

std::vector<Chart> make_improvement_charts(const Diagnosis& diagnosis) {
  if (diagnosis.improvement.channels.empty() || !diagnosis.is_extended()) return {};
  constexpr double kWidth = 0.26;
  ChartPanel panel{{""}, {"rms error on held-out runs [% of spread]"}, {}};
  ChartSeries before{"calibrated", SeriesKind::kBars, kCalibratedColor};
  ChartSeries after{"extended", SeriesKind::kBars, kExtendedColor};
  ChartSeries noise{"noise", SeriesKind::kBars, kNoiseColor};
  before.width = after.width = noise.width = kWidth;
  for (const ChannelImprovement& c : diagnosis.improvement.channels) {
    panel.x.categories.push_back(make_words(c.channel));
    const auto x = static_cast<double>(panel.x.categories.size());
    const double spread = c.rms_before / c.nrmse_before;
    before.x.push_back(x - kWidth);
    before.y.push_back(100.0 * c.nrmse_before);
    after.x.push_back(x);
    after.y.push_back(100.0 * c.nrmse_after);
    noise.x.push_back(x + kWidth);
    noise.y.push_back(100.0 * c.noise_floor / spread);
  }
  panel.series = {std::move(before), std::move(after), std::move(noise)};
  Chart chart{"gain", {std::move(panel)}};
  chart.caption = "Errors on the held-out runs, before and after the extension.";
  return {chart};
}

std::vector<Chart> make_map_charts(const Diagnosis& diagnosis) {
  if (!diagnosis.force) return {};
  return {make_force_map_chart(*diagnosis.force)};
}

namespace {

/// The held-out runs that every model could simulate.
std::vector<const DiagnosedRun*> list_simulated(const CampaignData& data,
                                                const Diagnosis& diagnosis) {
  std::vector<const DiagnosedRun*> runs;
  for (const DiagnosedRun* run : list_held_out(data, diagnosis)) {
    const std::vector<ModelCurves> models = list_model_curves(diagnosis, *run);
    if (std::all_of(models.begin(), models.end(),
                    [](const ModelCurves& model) { return model.is_simulated(); })) {
      runs.push_back(run);
    }
  }
  return runs;
}

}  // namespace

std::vector<Chart> make_law_charts(const CampaignData& data, const Diagnosis& diagnosis) {
  const std::vector<const DiagnosedRun*> runs = list_simulated(data, diagnosis);
  if (runs.empty()) return {};
  return {make_law_chart(data, diagnosis, *runs.front())};
}

std::vector<Chart> make_motion_charts(const CampaignData& data, const Diagnosis& diagnosis) {
  const std::vector<const DiagnosedRun*> runs = list_simulated(data, diagnosis);
  if (runs.empty()) return {};
  Chart states{"states", {}};
  states.caption = "Mean residuals of the models on the held-out runs, by the motion.";
  const std::size_t model_count = list_model_curves(diagnosis, *runs.front()).size();
  for (std::size_t m = 0; m < model_count; ++m) {
    PooledChannels pooled;
    for (const DiagnosedRun* run : runs) {
      pool(data, run->run, *list_model_curves(diagnosis, *run)[m].evaluation, pooled);
    }
    add_state_lines(data, pooled, list_model_curves(diagnosis, *runs.front())[m], states.panels);
    states.columns = choose_columns(pooled.begin()->second.size());
  }
  return {states};
}

}  // namespace strut
