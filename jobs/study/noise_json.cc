// A noise study as JSON and CSV.
#include "base/text/format_number.h"
#include "jobs/study/noise_study.h"

namespace strut {
namespace {

Json make_errors(const NoiseStudy& study, const NoiseErrors& errors) {
  Json snapshots = Json::object();
  for (std::size_t i = 0; i < study.preloads.size(); ++i) {
    snapshots.set(study.preloads[i], Json::object()
                                         .set("bound", errors.snapshots[i].bound)
                                         .set("network", errors.snapshots[i].network));
  }
  return Json::object()
      .set("snapshot", snapshots)
      .set("window", Json::object()
                         .set("bound", errors.window.bound)
                         .set("network", errors.window.network)
                         .set("fit", errors.window.fit));
}

Json make_point(const NoiseStudy& study, const NoisePoint& point) {
  Json parameters = Json::object();
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    parameters.set(study.parameters[p].name, make_errors(study, point.errors[p]));
  }
  const WindowRatios ratios = calc_window_ratios(point);
  return Json::object()
      .set("scale", point.scale)
      .set("parameters", parameters)
      .set("largest_network_ratio", ratios.network)
      .set("largest_fit_ratio", ratios.fit)
      .set("converged", static_cast<long>(point.converged))
      .set("chi2_per_degree", point.chi2_per_degree)
      .set("fit_seconds", point.fit_seconds);
}

Json make_variations(const NoiseStudy& study, std::size_t p) {
  Json snapshots = Json::object();
  for (std::size_t i = 0; i < study.preloads.size(); ++i) {
    snapshots.set(study.preloads[i], study.snapshot_variation[i][p]);
  }
  return Json::object().set("snapshot", snapshots).set("window", study.window_variation[p]);
}

Json list_sensors(const NoiseStudy& study) {
  Json sensors = Json::array();
  for (const NoiseSensor& sensor : study.sensors) {
    sensors.push(Json::object()
                     .set("channel", sensor.channel)
                     .set("of", sensor.in_window ? "window" : "snapshot")
                     .set("unit", sensor.unit)
                     .set("sigma", sensor.sigma)
                     .set("bias", sensor.bias));
  }
  return sensors;
}

std::string make_line(const std::string& start, const char* what, const char* measure,
                      double value) {
  return start + what + "," + measure + "," + format_number(value) + "\n";
}

}  // namespace

Json make_json(const NoiseStudy& study) {
  Json spread = Json::object(), variation = Json::object(), scales = Json::array();
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    spread.set(study.parameters[p].name, study.spread[p]);
    variation.set(study.parameters[p].name, make_variations(study, p));
  }
  for (const NoisePoint& point : study.points) scales.push(make_point(study, point));
  return Json::object()
      .set("sensors", list_sensors(study))
      .set("window_from", study.from)
      .set("window_to", study.to)
      .set("hit_time", study.hit_time)
      .set("copies", study.copies)
      .set("fits", static_cast<long>(study.fits))
      .set("grid_spread", spread)
      .set("bound_variation", variation)
      .set("scales", scales);
}

std::string make_csv(const NoiseStudy& study) {
  std::string text = "scale,parameter,unit,preload,measurement,quantity,value\n";
  for (const NoisePoint& point : study.points) {
    for (std::size_t p = 0; p < study.parameters.size(); ++p) {
      const NoiseErrors& errors = point.errors[p];
      const std::string start = format_number(point.scale) + "," + study.parameters[p].name + "," +
                                study.parameters[p].unit + ",";
      for (std::size_t i = 0; i < study.preloads.size(); ++i) {
        const std::string here = start + study.preloads[i] + ",";
        text += make_line(here, "snapshot", "bound", errors.snapshots[i].bound) +
                make_line(here, "snapshot", "network", errors.snapshots[i].network);
      }
      const std::string here = start + study.window_preload + ",";
      text += make_line(here, "window", "bound", errors.window.bound) +
              make_line(here, "window", "network", errors.window.network) +
              make_line(here, "window", "fit", errors.window.fit) +
              make_line(here, "grid", "spread", study.spread[p]);
    }
  }
  return text;
}

}  // namespace strut
