#include "jobs/compare/json.h"

#include "base/math/normal.h"
#include "jobs/compare/tables.h"

namespace strut {
namespace {

Json make_interval(double value, double sigma) {
  return Json::array().push(value - kNormal95 * sigma).push(value + kNormal95 * sigma);
}

Json make_parameters(const Baseline& baseline) {
  Json json = Json::object();
  for (std::size_t i = 0; i < baseline.shared_count(); ++i) {
    const Unknown& u = baseline.calibrated.unknowns[i];
    const double value = baseline.calibrated.values[i];
    json.set(u.name, Json::object()
                         .set("nominal", baseline.nominal.values[i])
                         .set("value", value)
                         .set("ci95", make_interval(value, baseline.calc_sigma(i)))
                         .set("unit", u.unit)
                         .set("at_bound", static_cast<bool>(baseline.fit.at_bound[i])));
  }
  return json;
}

Json make_windows(const ChannelComparison& c) {
  Json json = Json::object();
  for (const WindowResidual& w : c.windows) {
    json.set(w.window.name, Json::object()
                                .set("from", w.window.from)
                                .set("to", w.window.to)
                                .set("count", static_cast<long>(w.count))
                                .set("rms", w.rms)
                                .set("nrmse", w.nrmse));
  }
  return json;
}

Json make_bands(const ChannelComparison& c) {
  Json json = Json::object();
  for (const BandResidual& b : c.bands) {
    json.set(describe(b.band), Json::object()
                                   .set("rms", b.residual_rms)
                                   .set("measured_rms", b.measured_rms)
                                   .set("noise_rms", b.noise_rms));
  }
  return json;
}

Json make_states(const std::vector<StateResidual>& states) {
  Json json = Json::object();
  for (const StateResidual& state : states) {
    Json centers = Json::array(), means = Json::array(), rms = Json::array(), n = Json::array();
    for (const StateBin& bin : state.bins) {
      centers.push(bin.center);
      means.push(bin.mean);
      rms.push(bin.rms);
      n.push(static_cast<long>(bin.count));
    }
    json.set(state.state, Json::object()
                              .set("unit", state.unit)
                              .set("center", centers)
                              .set("mean", means)
                              .set("rms", rms)
                              .set("count", n)
                              .set("mean_negative", state.mean_negative)
                              .set("mean_positive", state.mean_positive)
                              .set("difference_sigma", state.difference_sigma)
                              .set("explained", state.explained));
  }
  return json;
}

Json make_channel(const ChannelComparison& c) {
  return Json::object()
      .set("count", static_cast<long>(c.count))
      .set("rms", c.rms)
      .set("nrmse", c.nrmse)
      .set("mean", c.mean)
      .set("noise", c.sigma)
      .set("chi2_per_reading", c.chi2_per_reading)
      .set("limit", c.limit)
      .set("adequate", c.is_adequate())
      .set("neighbor_correlation", c.neighbor_correlation)
      .set("time", make_windows(c))
      .set("band", make_bands(c))
      .set("state", make_states(c.states));
}

Json make_model(const CampaignData& data, const ModelComparison& model) {
  Json json = Json::object();
  if (!model.evaluation.failure.empty()) return json.set("failure", model.evaluation.failure);
  Json channels = Json::object(), own = Json::object();
  for (const ChannelComparison& c : model.channels) {
    channels.set(data.info(c.channel).name, make_channel(c));
  }
  for (std::size_t i = 0; i < model.evaluation.unknowns.size(); ++i) {
    own.set(model.evaluation.unknowns[i].name, model.evaluation.values[i]);
  }
  return json.set("channels", channels).set("run_values", own);
}

Json make_balance(const BodyBalance& b) {
  Json kinematics = Json::object();
  for (const KinematicResidual& k : b.kinematics) {
    kinematics.set(k.channel,
                   Json::object().set("rms", k.rms).set("spread", k.spread).set("gain", k.gain));
  }
  return Json::object()
      .set("half_width", b.half_width)
      .set("rms", b.rms)
      .set("nrmse", b.nrmse)
      .set("noise_rms", b.noise_rms)
      .set("stiffness", Json::object()
                            .set("value", b.stiffness)
                            .set("ci95", make_interval(b.stiffness, b.stiffness_sigma)))
      .set("damping", Json::object()
                          .set("value", b.damping)
                          .set("ci95", make_interval(b.damping, b.damping_sigma)))
      .set("state", make_states(b.states))
      .set("kinematics", kinematics);
}

Json make_balance(const CarBalance& b) {
  Json parameters = Json::object();
  for (const BalanceParameter& p : b.parameters) {
    parameters.set(p.name, Json::object()
                               .set("value", p.value)
                               .set("ci95", make_interval(p.value, p.sigma))
                               .set("unit", p.unit));
  }
  return Json::object().set("chi2_per_reading", b.chi2_per_reading).set("parameters", parameters);
}

Json make_runs(const CampaignData& data, const Comparison& comparison) {
  Json runs = Json::array();
  for (const RunComparison& run : comparison.runs) {
    const CampaignRun& about = data.campaign.runs[run.run];
    Json json = Json::object();
    json.set("file", about.name)
        .set("use", get_name(about.use))
        .set("nominal", make_model(data, run.nominal))
        .set("calibrated", make_model(data, run.calibrated));
    if (run.balance) json.set("balance", make_balance(*run.balance));
    if (run.car_balance) json.set("balance", make_balance(*run.car_balance));
    runs.push(json);
  }
  return runs;
}

const char* get_name(NoiseSource source) {
  switch (source) {
    case NoiseSource::kGiven:
      return "given";
    case NoiseSource::kEstimated:
      return "estimated";
    case NoiseSource::kQuantized:
      break;
  }
  return "quantized";
}

Json make_noise(const CampaignData& data) {
  Json json = Json::object();
  for (std::size_t i = 0; i < data.noise.size(); ++i) {
    const CampaignColumn& c = data.campaign.columns[i];
    if (c.role != ColumnRole::kOutput || data.noise[i].sigma == 0.0) continue;
    json.set(c.channel, Json::object()
                            .set("sigma", data.noise[i].sigma)
                            .set("unit", c.si)
                            .set("quantum", data.noise[i].quantum)
                            .set("source", get_name(data.noise[i].source)));
  }
  return json;
}

}  // namespace

Json make_compare_json(const CampaignData& data, const Comparison& comparison) {
  Json json = Json::object();
  json.set("campaign", data.campaign.path.string())
      .set("model", data.campaign.model.string())
      .set("adequate", comparison.is_adequate())
      .set("verdict", make_verdict_text(data, comparison))
      .set("parameters", make_parameters(comparison.baseline));
  if (comparison.baseline.is_fitted) {
    const FitResult& fit = comparison.baseline.fit;
    json.set("fit", Json::object()
                        .set("converged", fit.converged)
                        .set("chi2_per_degree", fit.chi2_per_degree())
                        .set("iterations", fit.iterations)
                        .set("simulations", fit.simulations));
  }
  return json.set("not_identifiable", Json::texts(comparison.not_identifiable))
      .set("noise", make_noise(data))
      .set("notes", Json::texts(data.notes))
      .set("runs", make_runs(data, comparison));
}

}  // namespace strut
