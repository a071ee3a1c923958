#include "jobs/diagnose/json.h"

#include <cmath>

namespace strut {
namespace {

Json make_estimate(double value, double low, double high, const std::string& unit) {
  return Json::object()
      .set("value", value)
      .set("ci95", Json::array().push(low).push(high))
      .set("unit", unit.empty() ? "1" : unit);
}

Json make_cause(const Cause& cause) {
  Json parameters = Json::object();
  for (const CauseParameter& p : cause.parameters) {
    parameters.set(p.key, make_estimate(p.value, p.low, p.high, p.unit));
  }
  return Json::object()
      .set("effect", cause.effect)
      .set("place", cause.place)
      .set("probability", cause.probability)
      .set("chi2_gain", cause.gain)
      .set("parameters", parameters);
}

Json make_causes(const std::vector<Cause>& causes) {
  Json json = Json::array();
  for (const Cause& cause : causes) json.push(make_cause(cause));
  return json;
}

Json make_where(const Where& where) {
  return Json::object()
      .set("channel", where.channel)
      .set("time", where.time)
      .set("band", where.band)
      .set("depends_on", where.depends_on)
      .set("place", where.place);
}

/// The map's coefficients are in the extended model, its values in force_map.csv.
Json make_force(const std::optional<UnknownForce>& force) {
  if (!force) return {};
  const MapDependence& depends = force->depends;
  return Json::object()
      .set("place", force->place)
      .set("words", depends.words)
      .set("share_of_velocity", depends.of_velocity)
      .set("share_of_deflection", depends.of_deflection)
      .set("share_of_both", depends.of_both)
      .set("spread", depends.spread)
      .set("hold_out_share", force->share);
}

/// What only one of the models has is left out of the other.
Json make_parameters(const std::vector<ParameterChange>& parameters) {
  Json before = Json::object(), after = Json::object();
  for (const ParameterChange& p : parameters) {
    if (std::isfinite(p.before)) {
      before.set(p.name, make_estimate(p.before, p.before_low, p.before_high, p.unit));
    }
    if (std::isfinite(p.after)) {
      after.set(p.name, make_estimate(p.after, p.after_low, p.after_high, p.unit));
    }
  }
  return Json::object().set("before", before).set("after", after);
}

Json make_by_channel(const std::vector<ChannelGain>& channels, double ChannelGain::*member) {
  Json json = Json::object();
  for (const ChannelGain& c : channels) json.set(c.channel, c.*member);
  return json;
}

Json make_gain(const HoldOutGain& gain) {
  Json units = Json::object();
  for (const ChannelGain& c : gain.channels) units.set(c.channel, c.unit);
  return Json::object()
      .set("hold_out_rms_before", make_by_channel(gain.channels, &ChannelGain::rms_before))
      .set("hold_out_rms_after", make_by_channel(gain.channels, &ChannelGain::rms_after))
      .set("noise_floor", make_by_channel(gain.channels, &ChannelGain::noise_floor))
      .set("unit", units)
      .set("hold_out_nrmse_before", make_by_channel(gain.channels, &ChannelGain::nrmse_before))
      .set("hold_out_nrmse_after", make_by_channel(gain.channels, &ChannelGain::nrmse_after))
      .set("explained", gain.explained ? Json(*gain.explained) : Json())
      .set("log_likelihood_per_sample",
           Json::array().push(gain.log_likelihood_before).push(gain.log_likelihood_after));
}

}  // namespace

Json make_verdict_json(const CampaignData& data, const Diagnosis& diagnosis) {
  Json notes = Json::texts(data.notes);
  for (const std::string& note : diagnosis.notes) notes.push(note);
  Json json = Json::object();
  return json.set("verdict", get_name(diagnosis.kind))
      .set("sentence", diagnosis.sentence)
      .set("campaign", data.campaign.path.string())
      .set("model", data.campaign.model.string())
      .set("causes", make_causes(diagnosis.causes))
      .set("group", make_causes(diagnosis.group))
      .set("runners_up", make_causes(diagnosis.runners_up))
      .set("unknown_share", diagnosis.unknown_share)
      .set("where", make_where(diagnosis.where))
      .set("force_map", make_force(diagnosis.force))
      .set("parameters", make_parameters(diagnosis.parameters))
      .set("gain", make_gain(diagnosis.gain))
      .set("not_identifiable", Json::texts(diagnosis.not_identifiable))
      .set("next_measurement", diagnosis.next_measurement)
      .set("notes", notes)
      .set("extended_model", diagnosis.is_extended() ? "extended.toml" : "");
}

}  // namespace strut
