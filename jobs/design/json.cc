#include "jobs/design/json.h"

#include "io/table/csv.h"

namespace strut {
namespace {

Json make_bounds_json(const Sensitivity& s, const Bounds& bounds) {
  Json parameters = Json::object(), weakest = Json::object(), missing = Json::array();
  for (std::size_t p = 0; p < s.parameters.size(); ++p) {
    const SensitivityParameter& parameter = s.parameters[p];
    Json bound = Json::object();
    bound["bound"] = to_unit(parameter, bounds.bound[p]);
    bound["percent"] = bounds.bound[p];
    parameters[parameter.name] = bound;
    weakest[parameter.name] = bounds.weakest[p];
  }
  for (const std::string& name : list_not_identifiable(s, bounds)) missing.push_back(name);
  Json json = Json::object();
  json["rms_percent"] = bounds.rms;
  json["condition"] = bounds.condition;
  json["rank"] = bounds.rank;
  json["parameters"] = parameters;
  json["not_identifiable"] = missing;
  json["weakest"] = weakest;
  json["weakest_percent"] = bounds.weakest_bound;
  return json;
}

Json make_instants_json(const std::vector<const Instant*>& instants) {
  Json list = Json::array();
  for (const Instant* instant : instants) {
    Json json = Json::object();
    json["offset"] = instant->offset;
    json["time"] = instant->time;
    list.push_back(json);
  }
  return list;
}

Json make_choice_json(const Sensitivity& s, const DesignChoice& choice) {
  std::vector<const Instant*> instants;
  instants.reserve(choice.instants.size());
  for (const std::size_t i : choice.instants) instants.push_back(&s.instants[i]);
  Json json = make_bounds_json(s, choice.bounds);
  json["instants"] = make_instants_json(instants);
  return json;
}

Json make_sensors_json(const DesignReport& report) {
  Json list = Json::array();
  for (const SensorSet& set : report.design.sensors) {
    Json channels = Json::array();
    for (const int channel : set.channels) channels.push_back(get_channel(channel).name);
    Json json = Json::object();
    json["label"] = set.label;
    json["channels"] = channels;
    json["snapshot_rms_percent"] = set.snapshot.rms;
    json["best_rms_percent"] = set.best.bounds.rms;
    json["best_offset"] = report.sensitivity.instants[set.best.instants[0]].offset;
    json["window_rms_percent"] = set.window.rms;
    list.push_back(json);
  }
  return list;
}

Json make_scan_json(const DesignReport& report) {
  const Sensitivity& s = report.sensitivity;
  Json time = Json::array(), offset = Json::array(), condition = Json::array(), rms = Json::array(),
       bounds = Json::object();
  std::vector<Json> bound(s.parameters.size(), Json::array());
  for (std::size_t i = 0; i < s.instants.size(); ++i) {
    const Bounds& b = report.design.scan[i];
    time.push_back(s.instants[i].time);
    offset.push_back(s.instants[i].offset);
    condition.push_back(b.condition);
    rms.push_back(b.rms);
    for (std::size_t p = 0; p < bound.size(); ++p) bound[p].push_back(b.bound[p]);
  }
  for (std::size_t p = 0; p < bound.size(); ++p) bounds[s.parameters[p].name] = bound[p];
  Json scan = Json::object();
  scan["time"] = time;
  scan["offset"] = offset;
  scan["condition"] = condition;
  scan["rms_percent"] = rms;
  scan["percent"] = bounds;
  return scan;
}

Json make_head_json(const DesignReport& report) {
  const Sensitivity& s = report.sensitivity;
  Json base = Json::object(), noise = Json::object();
  for (const SensitivityParameter& p : s.parameters) base[p.name] = p.base;
  for (const int channel : report.channels) {
    noise[get_channel(channel).name] = report.noise[static_cast<std::size_t>(channel)];
  }
  Json json = Json::object();
  json["base"] = base;
  json["noise"] = noise;
  json["rate"] = s.rate;
  json["half_step_error"] = find_worst_curve(s, report.channels).error;
  return json;
}

}  // namespace

Json make_design_json(const DesignReport& report) {
  const Sensitivity& s = report.sensitivity;
  const Design& design = report.design;
  Json snapshot = make_bounds_json(s, design.snapshot);
  snapshot["offset"] = s.snapshot.offset;
  snapshot["time"] = s.snapshot.time;
  Json window = make_bounds_json(s, design.window);
  window["samples"] = s.instants.size();
  Json best = Json::array();
  for (const DesignChoice& choice : design.best) best.push_back(make_choice_json(s, choice));
  const auto [first, last] = find_good_range(design);
  Json range = Json::array();
  range.push_back(s.instants[first].offset);
  range.push_back(s.instants[last].offset);
  Json json = make_head_json(report);
  json["best_offset"] = s.instants[design.best[0].instants[0]].offset;
  json["best_range"] = range;
  json["snapshot"] = snapshot;
  json["best"] = best;
  json["window"] = window;
  json["sensors"] = make_sensors_json(report);
  json["scan"] = make_scan_json(report);
  return json;
}

void write_design_csv(const std::filesystem::path& file, const DesignReport& report) {
  const Sensitivity& s = report.sensitivity;
  std::vector<CsvColumn> columns{{"time", "s", {}}, {"offset", "m", {}}};
  for (const Instant& instant : s.instants) {
    columns[0].values.push_back(instant.time);
    columns[1].values.push_back(instant.offset);
  }
  for (const int channel : list_sensors(report.noise)) {
    const ChannelInfo& info = get_channel(channel);
    for (std::size_t p = 0; p < s.parameters.size(); ++p) {
      CsvColumn column{info.name + "/" + s.parameters[p].name, info.unit + " per %", {}};
      column.values.reserve(s.instants.size());
      for (const Instant& instant : s.instants) {
        column.values.push_back(s.get(instant, channel, p) * 0.01 * s.parameters[p].scale);
      }
      columns.push_back(std::move(column));
    }
  }
  write_csv(file, columns);
}

}  // namespace strut
