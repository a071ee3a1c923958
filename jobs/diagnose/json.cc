#include "jobs/diagnose/json.h"

#include <cmath>

#include "jobs/diagnose/folder.h"

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
  }
  return Json{{"effect", cause.effect},           {"place", cause.place},
              {"change", get_name(cause.change)}, {"converged", cause.converged},
              {"probability", cause.probability}, {"chi2_gain", cause.delta_chi2},
              {"parameters", parameters}};
}

Json make_causes(const std::vector<Cause>& causes) {
  Json json = Json::array();
  for (const Cause& cause : causes) json.push_back(make_cause(cause));
  return json;
}

Json make_where(const Where& where) {
  return Json{{"channel", where.channel},
              {"time", where.time},
              {"band", where.band},
              {"depends_on", where.depends_on},
              {"place", where.place}};
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
    }
    if (std::isfinite(p.after)) {
      after[p.name] = make_estimate(p.after, p.after_low, p.after_high, p.unit);
    }
  }
  return Json{{"before", before}, {"after", after}};
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
  json["verdict"] = get_name(diagnosis.kind);
  json["sentence"] = diagnosis.sentence;
  json["campaign"] = data.campaign.path.string();
  json["model"] = data.campaign.model.string();
  json["causes"] = make_causes(diagnosis.causes);
  json["group"] = make_causes(diagnosis.group);
  json["runners_up"] = make_causes(diagnosis.runners_up);
  json["unknown_share"] = diagnosis.unknown_share;
  json["where"] = make_where(diagnosis.where);
  json["force_map"] = make_force(diagnosis.force);
  json["parameters"] = make_parameters(diagnosis.parameters);
  json["gain"] = make_gain(diagnosis.improvement);
  json["not_identifiable"] = diagnosis.not_identifiable;
  json["next_measurement"] = diagnosis.next_measurement;
  json["notes"] = notes;
  json["extended_model"] = diagnosis.is_extended() ? kExtendedModelFile : "";
  return json;
}

}  // namespace strut
