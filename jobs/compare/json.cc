#include "jobs/compare/json.h"

#include "base/math/normal.h"
#include "diagnose/baseline/sensor_findings.h"
#include "jobs/compare/tables.h"

namespace strut {
namespace {

Json make_interval(double value, double sigma) {
  return Json::array({value - kNormal95 * sigma, value + kNormal95 * sigma});
}

Json make_parameters(const Baseline& baseline) {
  Json json = Json::object();
  for (std::size_t i = 0; i < baseline.shared_count(); ++i) {
    const Unknown& u = baseline.calibrated.unknowns[i];
    if (is_sensor_tolerance(u)) continue;
    const double value = baseline.calibrated.values[i];
    json[u.name] = Json{{"nominal", baseline.nominal.values[i]},
                        {"value", value},
                        {"ci95", make_interval(value, baseline.calc_sigma(i))},
                        {"unit", u.unit},
                        {"at_bound", static_cast<bool>(baseline.fit.at_bound[i])}};
  }
  return json;
}

Json make_windows(const ChannelComparison& c) {
  Json json = Json::object();
  for (const WindowResidual& w : c.windows) {
    json[w.window.name] = Json{{"from", w.window.from},
                               {"to", w.window.to},
                               {"count", w.count},
                               {"rms", w.rms},
                               {"nrmse", w.nrmse}};
  }
  return json;
}

Json make_bands(const ChannelComparison& c) {
  Json json = Json::object();
  for (const BandResidual& b : c.bands) {
    json[describe(b.band)] =
        Json{{"rms", b.residual_rms}, {"measured_rms", b.measured_rms}, {"noise_rms", b.noise_rms}};
  }
  return json;
}

Json make_states(const std::vector<StateResidual>& states) {
  Json json = Json::object();
  for (const StateResidual& state : states) {
    Json centers = Json::array(), means = Json::array(), rms = Json::array(), n = Json::array();
    for (const StateBin& bin : state.bins) {
      centers.push_back(bin.center);
      means.push_back(bin.mean);
      rms.push_back(bin.rms);
      n.push_back(static_cast<long>(bin.count));
    }
    json[state.state] = Json{{"unit", state.unit},
                             {"center", centers},
                             {"mean", means},
                             {"rms", rms},
                             {"count", n},
                             {"mean_negative", state.mean_negative},
                             {"mean_positive", state.mean_positive},
                             {"difference_sigma", state.difference_sigma},
                             {"explained", state.explained}};
  }
  return json;
}

Json make_channel(const ChannelComparison& c) {
  return Json{{"count", c.count},
              {"rms", c.rms},
              {"nrmse", c.nrmse},
              {"mean", c.mean},
              {"noise", c.sigma},
              {"noise_floor", c.adequacy.floor.sigma},
              {"chi2_per_reading", c.chi2_per_reading},
              {"limit", c.limit},
              {"adequate", c.is_adequate()},
              {"neighbor_correlation", c.neighbor_correlation},
              {"time", make_windows(c)},
              {"band", make_bands(c)},
              {"state", make_states(c.states)}};
}

Json make_model(const CampaignData& data, const ModelComparison& model) {
  Json json = Json::object();
  if (!model.evaluation.failure.empty()) {
    json["failure"] = model.evaluation.failure;
    return json;
  }
  Json channels = Json::object(), own = Json::object();
  for (const ChannelComparison& c : model.channels) {
    channels[data.info(c.channel).name] = make_channel(c);
  }
  for (std::size_t i = 0; i < model.evaluation.unknowns.size(); ++i) {
    own[model.evaluation.unknowns[i].name] = model.evaluation.values[i];
  }
  json["channels"] = channels;
  json["run_values"] = own;
  return json;
}

Json make_balance(const BodyBalance& b) {
  Json kinematics = Json::object();
  for (const KinematicResidual& k : b.kinematics) {
    kinematics[k.channel] = Json{{"rms", k.rms}, {"spread", k.spread}, {"gain", k.gain}};
  }
  return Json{
      {"half_width", b.half_width},
      {"rms", b.rms},
      {"nrmse", b.nrmse},
      {"noise_rms", b.noise_rms},
      {"stiffness",
       Json{{"value", b.stiffness}, {"ci95", make_interval(b.stiffness, b.stiffness_sigma)}}},
      {"damping", Json{{"value", b.damping}, {"ci95", make_interval(b.damping, b.damping_sigma)}}},
      {"state", make_states(b.states)},
      {"kinematics", kinematics}};
}

Json make_balance(const CarBalance& b) {
  Json parameters = Json::object();
  for (const BalanceParameter& p : b.parameters) {
    parameters[p.name] =
        Json{{"value", p.value}, {"ci95", make_interval(p.value, p.sigma)}, {"unit", p.unit}};
  }
  return Json{{"chi2_per_reading", b.chi2_per_reading}, {"parameters", parameters}};
}

Json make_runs(const CampaignData& data, const Comparison& comparison) {
  Json runs = Json::array();
  for (const RunComparison& run : comparison.runs) {
    const CampaignRun& entry = data.campaign.runs[run.run];
    Json json = Json::object();
    json["file"] = entry.name;
    json["use"] = get_name(entry.use);
    json["nominal"] = make_model(data, run.nominal);
    json["calibrated"] = make_model(data, run.calibrated);
    if (run.balance) json["balance"] = make_balance(*run.balance);
    if (run.car_balance) json["balance"] = make_balance(*run.car_balance);
    runs.push_back(json);
  }
  return runs;
}

}  // namespace

Json make_noise(const CampaignData& data) {
  Json json = Json::object();
  for (std::size_t i = 0; i < data.noise.size(); ++i) {
    const CampaignColumn& c = data.campaign.columns[i];
    if (c.role != ColumnRole::kOutput || data.noise[i].sigma == 0.0) continue;
    json[c.channel] = Json{{"sigma", data.noise[i].sigma},
                           {"unit", c.si},
                           {"quantum", data.noise[i].quantum},
                           {"source", find_name(kNoiseSources, data.noise[i].source)}};
  }
  return json;
}

Json make_sensor_errors(const FitResult& fit) {
  Json json = Json::object();
  for (const SensorFinding& f : list_sensor_findings(fit)) {
    json[f.name] = Json{{"value", f.value},
                        {"ci95", Json::array({f.low, f.high})},
                        {"unit", f.unit},
                        {"tolerance", f.tolerance}};
  }
  return json;
}

Json make_compare_json(const CampaignData& data, const Comparison& comparison) {
  Json json = Json::object();
  json["campaign"] = data.campaign.path.string();
  json["model"] = data.campaign.model.string();
  json["adequate"] = comparison.is_adequate();
  json["verdict"] = make_verdict_text(data, comparison);
  json["parameters"] = make_parameters(comparison.baseline);
  if (comparison.baseline.is_fitted) {
    const FitResult& fit = comparison.baseline.fit;
    json["fit"] = Json{{"converged", fit.converged},
                       {"chi2_per_degree", fit.chi2_per_degree()},
                       {"iterations", fit.iterations},
                       {"simulations", fit.simulations}};
  }
  json["not_identifiable"] = comparison.not_identifiable;
  json["sensor_errors"] = make_sensor_errors(comparison.baseline.fit);
  json["noise"] = make_noise(data);
  Json notes = data.notes;
  for (const std::string& note : comparison.notes) notes.push_back(note);
  json["notes"] = notes;
  json["runs"] = make_runs(data, comparison);
  return json;
}

}  // namespace strut
