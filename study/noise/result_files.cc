#include "study/noise/result_files.h"

#include <fmt/format.h>

#include "base/text/format_number.h"

namespace strut {
namespace {

Json make_errors(const NoiseStudy& study, const NoiseErrors& errors) {
  Json snapshots = Json::object();
  for (std::size_t i = 0; i < study.preloads.size(); ++i) {
    snapshots[study.preloads[i]] =
        Json{{"bound", errors.snapshots[i].bound}, {"network", errors.snapshots[i].network}};
  }
  return Json{{"snapshot", snapshots},
              {"window", Json{{"bound", errors.window.bound},
                              {"network", errors.window.network},
                              {"fit", errors.window.fit}}}};
}

Json make_point(const NoiseStudy& study, const NoisePoint& point) {
  Json parameters = Json::object();
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    parameters[study.parameters[p].name] = make_errors(study, point.errors[p]);
  }
  const WindowRatios ratios = calc_window_ratios(point);
  return Json{{"scale", point.scale},
              {"parameters", parameters},
              {"largest_network_ratio", ratios.network},
              {"largest_fit_ratio", ratios.fit},
              {"converged", point.converged},
              {"chi2_per_degree", point.chi2_per_degree},
              {"fit_seconds", point.fit_seconds}};
}

Json make_variations(const NoiseStudy& study, std::size_t p) {
  Json snapshots = Json::object();
  for (std::size_t i = 0; i < study.preloads.size(); ++i) {
    snapshots[study.preloads[i]] = study.snapshot_variation[i][p];
  }
  return Json{{"snapshot", snapshots}, {"window", study.window_variation[p]}};
}

Json list_sensors(const NoiseStudy& study) {
  Json sensors = Json::array();
  for (const NoiseSensor& sensor : study.sensors) {
    sensors.push_back(Json{{"channel", sensor.channel},
                           {"of", sensor.in_window ? "window" : "snapshot"},
                           {"unit", sensor.unit},
                           {"sigma", sensor.sigma},
                           {"bias", sensor.bias}});
  }
  return sensors;
}

/// `start`: the first cells of the row.
std::string make_row(const std::string& start, const char* measurement, const char* quantity,
                     double value) {
  return fmt::format("{},{},{},{}\n", start, measurement, quantity, format_number(value));
}

}  // namespace

Json make_json(const NoiseStudy& study) {
  Json spread = Json::object(), variation = Json::object(), scales = Json::array();
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    spread[study.parameters[p].name] = study.spread[p];
    variation[study.parameters[p].name] = make_variations(study, p);
  }
  for (const NoisePoint& point : study.points) scales.push_back(make_point(study, point));
  return Json{
      {"sensors", list_sensors(study)}, {"window_from", study.from},    {"window_to", study.to},
      {"hit_time", study.hit_time},     {"copies", study.copies},       {"fits", study.fits},
      {"grid_spread", spread},          {"bound_variation", variation}, {"scales", scales}};
}

std::string make_csv(const NoiseStudy& study) {
  std::string text = "scale,parameter,unit,preload,measurement,quantity,value\n";
  for (const NoisePoint& point : study.points) {
    for (std::size_t p = 0; p < study.parameters.size(); ++p) {
      const NoiseErrors& errors = point.errors[p];
      const ColumnInfo& parameter = study.parameters[p];
      const std::string start =
          fmt::format("{},{},{}", format_number(point.scale), parameter.name, parameter.unit);
      for (std::size_t i = 0; i < study.preloads.size(); ++i) {
        const std::string here = start + "," + study.preloads[i];
        text += make_row(here, "snapshot", "bound", errors.snapshots[i].bound) +
                make_row(here, "snapshot", "network", errors.snapshots[i].network);
      }
      const std::string here = start + "," + study.window_preload;
      text += make_row(here, "window", "bound", errors.window.bound) +
              make_row(here, "window", "network", errors.window.network) +
              make_row(here, "window", "fit", errors.window.fit) +
              make_row(here, "grid", "spread", study.spread[p]);
    }
  }
  return text;
}

}  // namespace strut
