#include "jobs/diagnose/json.h"

#include <cmath>

#include "jobs/compare/json.h"
#include "jobs/diagnose/folder.h"
#include "model/effects/catalogue.h"

namespace strut {
namespace {

Json make_estimate(double value, double low, double high, const std::string& unit) {
  return Json{
      {"value", value}, {"ci95", Json::array({low, high})}, {"unit", unit.empty() ? "1" : unit}};
}

Json make_cause(const Cause& cause) {
  Json parameters = Json::object();
  for (const CauseParameter& p : cause.parameters) {
    parameters[p.key] = make_estimate(p.value, p.low, p.high, p.unit);
    parameters[p.key]["at_bound"] = p.at_bound;
  }
  const EffectInfo* effect = find_effect(cause.effect);
  return Json{{"effect", cause.effect},
              {"place", cause.place},
              {"change", get_name(cause.change)},
              {"converged", cause.converged},
              {"description", effect == nullptr ? "" : effect->description},
              {"law", effect == nullptr ? "" : effect->equation},
              {"reference", "docs/effects.md#" + cause.effect},
              {"probability", cause.probability},
              {"chi2_gain", cause.delta_chi2},
              {"parameters", parameters}};
}

Json make_causes(const std::vector<Cause>& causes) {
  Json json = Json::array();
  for (const Cause& cause : causes) json.push_back(make_cause(cause));
  return json;
}

/// Every position with its candidates: with `unknown_share` their probabilities sum to 1.
Json make_positions(const std::vector<CausePosition>& positions) {
  Json json = Json::array();
  for (const CausePosition& p : positions) {
    json.push_back(Json{
        {"cause", describe_effect(p.get_cause().effect, p.get_cause().place, p.get_cause().change)},
        {"not_distinguished", make_causes(p.list_close())},
        {"candidates", make_causes(p.candidates)},
        {"unknown_share", p.unknown}});
  }
  return json;
}

Json make_misfits(const CampaignData& data, const std::vector<Misfit>& misfits) {
  Json json = Json::array();
  for (const Misfit& m : misfits) {
    const CampaignRun& entry = data.campaign.runs[m.run];
    Json one{{"file", entry.name}, {"use", get_name(entry.use)}, {"reason", m.failure}};
    if (m.failure.empty()) {
      one["reason"] = describe_misfit(data, m);
      one["channel"] = data.info(m.channel).name;
      one["times_noise"] = m.times_noise;
      one["limit"] = m.limit;
    }
    json.push_back(one);
  }
  return json;
}

Json make_adequacy(const CampaignData& data, const std::vector<Misfit>& misfits) {
  return Json{{"adequate", misfits.empty()}, {"misfits", make_misfits(data, misfits)}};
}

Json make_channel_errors(const CampaignData& data, const ModelComparison& model) {
  Json json = Json::object();
  for (const ChannelComparison& c : model.channels) {
    json[data.info(c.channel).name] = Json{{"rms", c.rms},
                                           {"nrmse", c.nrmse},
                                           {"noise", c.adequacy.floor.sigma},
                                           {"adequate", c.is_adequate()}};
  }
  return json;
}

Json make_runs(const CampaignData& data, const std::vector<DiagnosedRun>& runs) {
  Json json = Json::array();
  for (const DiagnosedRun& run : runs) {
    const CampaignRun& entry = data.campaign.runs[run.run];
    json.push_back(Json{{"file", entry.name},
                        {"use", get_name(entry.use)},
                        {"nominal", make_channel_errors(data, run.nominal)},
                        {"calibrated", make_channel_errors(data, run.before)},
                        {"extended", make_channel_errors(data, run.after)}});
  }
  return json;
}

Json make_conflicts(const CampaignData& data, const std::vector<PriorConflict>& conflicts) {
  Json json = Json::array();
  for (const PriorConflict& c : conflicts) {
    json.push_back(Json{{"name", c.name},
                        {"file", c.is_shared ? "" : data.campaign.runs[c.run].name},
                        {"value", c.value},
                        {"prior", Json::array({c.mean, c.sigma})},
                        {"distance", c.calc_distance()}});
  }
  return json;
}

Json make_where(const Where& where) {
  return Json{{"run", where.run},   {"channel", where.channel},       {"time", where.time},
              {"band", where.band}, {"depends_on", where.depends_on}, {"place", where.place}};
}

/// The map's coefficients are in the extended model, its values in force_map.csv.
Json make_force(const std::optional<UnknownForce>& force) {
  if (!force) return {};
  const MapDependence& depends = force->depends;
  return Json{{"place", force->place},
              {"words", depends.words},
              {"share_of_velocity", depends.of_velocity},
              {"share_of_deflection", depends.of_deflection},
              {"share_of_both", depends.of_both},
              {"spread", depends.spread},
              {"hold_out_share", force->fraction}};
}

/// A parameter of only one of the models is left out of the other.
Json make_parameters(const std::vector<ParameterChange>& parameters) {
  Json before = Json::object(), after = Json::object();
  for (const ParameterChange& p : parameters) {
    if (std::isfinite(p.before)) {
      before[p.name] = make_estimate(p.before, p.before_low, p.before_high, p.unit);
      before[p.name]["at_bound"] = p.before_at_bound;
    }
    if (std::isfinite(p.after)) {
      after[p.name] = make_estimate(p.after, p.after_low, p.after_high, p.unit);
      after[p.name]["at_bound"] = p.after_at_bound;
      after[p.name]["differs_in_group"] = p.differs;
    }
  }
  return Json{{"before", before}, {"after", after}};
}

/// With the drift and the lines of the mains that the diagnosis found.
Json make_colored_noise(const CampaignData& data, const WhitenedFit& fit) {
  Json noise = make_noise(data);
  if (fit.spectra.empty()) return noise;
  for (const SensorColor& color : fit.spectra.front().color) {
    Json& channel = noise[data.info(color.channel).name];
    channel["drift_corner"] = color.corner;
    Json lines = Json::array();
    for (const MainsLine& line : color.lines) {
      lines.push_back(Json{{"frequency", line.frequency}, {"rms_over_sigma", line.rms}});
    }
    channel["mains"] = lines;
  }
  return noise;
}

Json make_secants(const std::vector<StrutSecant>& secants) {
  Json json = Json::object();
  for (const StrutSecant& s : secants) {
    json[s.place.empty() ? "strut" : s.place] = Json{
        {"stiffness", make_estimate(s.stiffness.value, s.stiffness.low, s.stiffness.high, "N/m")},
        {"damping", make_estimate(s.damping.value, s.damping.low, s.damping.high, "N s/m")}};
  }
  return json;
}

/// The test whether anything is there at all, beside the calibrated model.
Json make_existence(const SelectRound& first) {
  return Json{{"best_score", first.best_score},
              {"p_value", first.p_value},
              {"threshold", first.threshold},
              {"misfit", first.misfit}};
}

Json make_by_channel(const std::vector<ChannelImprovement>& channels,
                     double ChannelImprovement::*member) {
  Json json = Json::object();
  for (const ChannelImprovement& c : channels) json[c.channel] = c.*member;
  return json;
}

Json make_gain(const Improvement& improvement) {
  Json units = Json::object();
  for (const ChannelImprovement& c : improvement.channels) units[c.channel] = c.unit;
  return Json{
      {"hold_out_rms_before",
       make_by_channel(improvement.channels, &ChannelImprovement::rms_before)},
      {"hold_out_rms_after", make_by_channel(improvement.channels, &ChannelImprovement::rms_after)},
      {"noise_floor", make_by_channel(improvement.channels, &ChannelImprovement::noise_floor)},
      {"unit", units},
      {"hold_out_nrmse_before",
       make_by_channel(improvement.channels, &ChannelImprovement::nrmse_before)},
      {"hold_out_nrmse_after",
       make_by_channel(improvement.channels, &ChannelImprovement::nrmse_after)},
      {"explained", improvement.explained ? Json(*improvement.explained) : Json()},
      {"log_likelihood_per_sample",
       Json::array({improvement.log_likelihood_before, improvement.log_likelihood_after})}};
}

}  // namespace

Json make_verdict_json(const CampaignData& data, const Diagnosis& diagnosis) {
  Json notes = data.notes;
  for (const std::string& note : diagnosis.notes) notes.push_back(note);
  Json json = Json::object();
  const Verdict& verdict = diagnosis.verdict;
  json["verdict"] = get_name(verdict.kind);
  json["badge"] = get_badge(verdict.kind);
  json["sentence"] = diagnosis.sentence;
  json["campaign"] = data.campaign.path.string();
  json["model"] = data.campaign.model.string();
  json["causes"] = make_causes(verdict.list_causes());
  json["group"] = make_causes(verdict.list_group());
  json["positions"] = make_positions(verdict.positions);
  json["runners_up"] = make_causes(verdict.list_runners_up());
  json["unknown_share"] = verdict.unknown_share;
  const std::vector<SelectRound>& rounds = diagnosis.selection.rounds;
  json["existence"] = rounds.empty() ? Json() : make_existence(rounds.front());
  json["calibrated_model"] = make_adequacy(data, diagnosis.misfits_before);
  json["final_model"] = make_adequacy(data, verdict.misfits);
  json["prior_conflicts"] = make_conflicts(data, diagnosis.conflicts);
  json["where"] = make_where(diagnosis.where);
  json["force_map"] = make_force(diagnosis.force);
  json["parameters"] = make_parameters(diagnosis.parameters);
  json["sensor_errors"] = make_sensor_errors(diagnosis.selection.extended.fit);
  json["noise"] = make_colored_noise(data, diagnosis.selection.base);
  json["secants"] = make_secants(diagnosis.secants);
  json["gain"] = make_gain(diagnosis.improvement);
  json["runs"] = make_runs(data, diagnosis.runs);
  json["not_identifiable"] = diagnosis.not_identifiable;
  json["next_measurement"] = diagnosis.next_measurement;
  json["notes"] = notes;
  json["extended_model"] = diagnosis.is_extended() ? kExtendedModelFile : "";
  return json;
}

}  // namespace strut
