#include "jobs/diagnose/figures.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "diagnose/model_states.h"
#include "jobs/compare/figures.h"
#include "jobs/diagnose/force_map.h"
#include "jobs/diagnose/tables.h"
#include "jobs/report/panels.h"

namespace strut {
namespace {

using Values = std::vector<double>;
using Points = std::vector<Values>;

std::string make_label(const std::string& name, const std::string& unit) {
  return make_words(name) + " [" + unit + "]";
}

/// How deflection and velocity are called depends on the model; the tire is not of interest here.
bool is_motion(const StateCurve& state) { return state.name.find("tire") == std::string::npos; }

bool is_rate(const StateCurve& state) { return state.name.find("velocity") != std::string::npos; }

std::vector<const DiagnosedRun*> list_held_out(const CampaignData& data,
                                               const Diagnosis& diagnosis) {
  std::vector<const DiagnosedRun*> runs;
  for (const DiagnosedRun& run : diagnosis.runs) {
    if (data.campaign.runs[run.run].use == RunUse::kHoldOut) runs.push_back(&run);
  }
  return runs;
}

/// What a model leaves of a channel beside one of its states, over all runs.
struct PooledState {
  std::string name, unit;
  Values state, residual;
};
using PooledChannels = std::map<int, std::vector<PooledState>>;  // by channel of the model

void pool(const CampaignData& data, std::size_t run, const RunEvaluation& evaluation,
          PooledChannels& pooled) {
  const std::vector<StateCurve> states = list_states(data, evaluation.curves);
  const std::vector<MeasuredChannel>& channels = data.channels(run);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    std::vector<PooledState>& all = pooled[channels[k].channel];
    if (all.empty()) {
      for (const StateCurve& s : states) {
        if (is_motion(s)) all.push_back({s.name, s.unit, {}, {}});
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

PanelLine make_mean_line(const PooledState& pooled, const ModelCurves& model) {
  PanelLine line{
      model.name,
      "linespoints linetype " + std::to_string(model.line_type) + " pointtype 7 pointsize 0.5",
      {}};
  for (const StateBin& bin :
       calc_state_residual(pooled.name, pooled.unit, pooled.state, pooled.residual).bins) {
    if (bin.count > 0) line.points.push_back({bin.center, bin.mean});
  }
  return line;
}

/// One model's residuals by channel and state, into panels that those before it have made.
void add_state_lines(const CampaignData& data, const PooledChannels& pooled,
                     const ModelCurves& model, std::vector<Panel>& panels) {
  const bool is_first = panels.empty();
  std::size_t panel = 0;
  for (const auto& [channel, states] : pooled) {
    const ChannelInfo& info = data.info(channel);
    for (std::size_t s = 0; s < states.size(); ++s, ++panel) {
      if (is_first) {
        panels.push_back({make_label(states[s].name, states[s].unit),
                          s == 0 ? make_label(info.name, info.unit) : "",
                          {}});
      }
      panels[panel].lines.push_back(make_mean_line(states[s], model));
    }
  }
}

/// Points of a force over a motion.
struct ForceLaw {
  std::string x_label, y_label;
  Points points;
};

void add_points(const Values& x, const Values& y, Points& points) {
  const std::size_t stride = choose_stride(x.size());
  for (std::size_t t = 0; t < x.size(); t += stride) points.push_back({x[t], y[t]});
}

const Values& get_channel(const CampaignData& data, const RunCurves& curves,
                          const std::string& name) {
  const std::vector<ChannelInfo>& all = list_channels(data.campaign.rig);
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const ChannelInfo& c) { return c.name == name; });
  return curves.channel[static_cast<std::size_t>(found - all.begin())];
}

std::vector<ForceLaw> list_rig_laws(const CampaignData& data, const RunCurves& curves) {
  std::vector<ForceLaw> laws;
  for (const StateCurve& state : list_states(data, curves)) {
    if (!is_motion(state)) continue;
    const std::string force = *data.campaign.rig == RigKind::kStrutRig ? "force"
                              : is_rate(state)                         ? "damper_force"
                                                                       : "spring_force";
    ForceLaw law{make_label(state.name, state.unit), make_label(force, "N"), {}};
    add_points(state.values, get_channel(data, curves, force), law.points);
    laws.push_back(std::move(law));
  }
  return laws;
}

std::vector<ForceLaw> list_car_laws(const CampaignData& data, const RunCurves& curves) {
  std::vector<ForceLaw> laws;
  for (const std::string axle : {"front_", "rear_"}) {
    for (const auto& [motion, unit, force] :
         {std::array{"suspension_deflection", "m", "spring_force"},
          std::array{"suspension_velocity", "m/s", "damper_force"}}) {
      ForceLaw law{make_label(axle + motion, unit), make_label(axle + force, "N"), {}};
      for (const char* side : {"left_", "right_"}) {
        add_points(get_channel(data, curves, axle + side + motion),
                   get_channel(data, curves, axle + side + force), law.points);
      }
      laws.push_back(std::move(law));
    }
  }
  return laws;
}

std::vector<ForceLaw> list_laws(const CampaignData& data, const RunCurves& curves) {
  return data.is_rig() ? list_rig_laws(data, curves) : list_car_laws(data, curves);
}

/// What a strut rig measures over the motion that drives it.
void add_measured_force(const CampaignData& data, const DiagnosedRun& run,
                        std::vector<Panel>& panels) {
  if (data.campaign.rig != RigKind::kStrutRig) return;
  for (const MeasuredChannel& c : data.channels(run.run)) {
    if (c.channel != StrutRigChannel::kForce) continue;
    auto panel = panels.begin();
    for (const StateCurve& state : list_states(data, run.before.curves)) {
      Points points;
      add_points(state.values, c.values, points);
      (panel++)->lines.push_back(
          {"measured", "points linetype 1 pointtype 7 pointsize 0.15", std::move(points)});
    }
  }
}

Figure make_law_figure(const CampaignData& data, const Diagnosis& diagnosis,
                       const DiagnosedRun& run) {
  std::vector<Panel> panels;
  for (const ForceLaw& law : list_laws(data, run.before.curves)) {
    panels.push_back({law.x_label, law.y_label, {}});
  }
  add_measured_force(data, run, panels);
  for (const ModelCurves& model : list_model_curves(diagnosis, run)) {
    if (!model.is_simulated()) continue;
    std::size_t panel = 0;
    for (ForceLaw& law : list_laws(data, model.evaluation->curves)) {
      panels[panel++].lines.push_back(
          {model.name,
           "points linetype " + std::to_string(model.line_type) + " pointtype 7 pointsize 0.25",
           std::move(law.points)});
    }
  }
  return make_panel_figure("force_law", 2, panels);
}

std::optional<BodyBalance> calc_balance(const CampaignData& data, std::size_t run,
                                        const WhitenedFit& fit) {
  if (!data.is_rig() || fit.runs.empty()) return std::nullopt;
  const SharedValues shared = fit.shared();
  return calc_body_balance(set_rig_unknowns(data.rigs[run], shared.unknowns, shared.values));
}

}  // namespace

std::vector<CaptionedFigure> make_run_figures(const CampaignData& data, const Diagnosis& diagnosis,
                                              const DiagnosedRun& run) {
  const std::vector<ModelCurves> models = list_model_curves(diagnosis, run);
  if (!models.front().is_simulated()) return {};
  std::vector<CaptionedFigure> figures;
  figures.emplace_back(make_curve_figure(data, run.run, models),
                       "Measured and simulated, and what is left, over time.");
  const auto before = calc_balance(data, run.run, diagnosis.selection.base);
  const auto after = calc_balance(data, run.run, diagnosis.selection.extended);
  if (!before) return figures;
  std::vector<BalancePoints> balances = {{models.front().name, models.front().line_type, &*before}};
  if (after && models.size() > 1) {
    balances.push_back({models.back().name, models.back().line_type, &*after});
  }
  figures.emplace_back(
      make_panel_figure(make_run_name(data, run.run) + "_balance", 2,
                        make_balance_panels(balances)),
      "Body balance without road: the force that the sprung mass shows and the strut does not "
      "give.");
  return figures;
}

std::vector<CaptionedFigure> make_map_figures(const Diagnosis& diagnosis) {
  if (!diagnosis.force) return {};
  return {{make_force_map_figure(*diagnosis.force),
           "Force map of the " + diagnosis.force->states.describe() +
               " beside its spring and damper: over velocity, over deflection, as far as the runs "
               "for fitting went; and where they went."}};
}

std::vector<CaptionedFigure> make_motion_figures(const CampaignData& data,
                                                 const Diagnosis& diagnosis) {
  std::vector<const DiagnosedRun*> runs;
  for (const DiagnosedRun* run : list_held_out(data, diagnosis)) {
    const std::vector<ModelCurves> models = list_model_curves(diagnosis, *run);
    if (std::all_of(models.begin(), models.end(),
                    [](const ModelCurves& model) { return model.is_simulated(); })) {
      runs.push_back(run);
    }
  }
  if (runs.empty()) return {};
  std::vector<Panel> panels;
  std::size_t columns = 1;
  const std::size_t model_count = list_model_curves(diagnosis, *runs.front()).size();
  for (std::size_t m = 0; m < model_count; ++m) {
    PooledChannels pooled;
    for (const DiagnosedRun* run : runs) {
      pool(data, run->run, *list_model_curves(diagnosis, *run)[m].evaluation, pooled);
    }
    add_state_lines(data, pooled, list_model_curves(diagnosis, *runs.front())[m], panels);
    columns = pooled.begin()->second.size();
  }
  return {{make_panel_figure("states", columns, panels),
           "What the models leave of the runs held out, by the motion: the mean."},
          {make_law_figure(data, diagnosis, *runs.front()),
           "Forces of the models over the motion, as their sensors read it, in " +
               data.campaign.runs[runs.front()->run].name + "."}};
}

}  // namespace strut
