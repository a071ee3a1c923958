#include "jobs/study/noise_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/format_number.h"
#include "base/text/range.h"
#include "jobs/study/noise_figure.h"

namespace strut {
namespace {

/// Three digits, without an exponent for large numbers.
std::string round(double value) {
  std::string text = format_cell("{:.3g}", value);
  if (text.find('e') == std::string::npos || std::abs(value) < 1.0) return text;
  return format_cell("{:.0f}", std::stod(text));
}

std::vector<std::string> make_header(const NoiseStudy& study) {
  std::vector<std::string> header = {"noise"};
  for (const std::string& preload : study.preloads) {
    header.push_back(preload + ": bound");
    header.emplace_back("network");
  }
  for (const char* name : {"window: bound", "network", "/ bound", "fit", "/ bound"}) {
    header.emplace_back(name);
  }
  return header;
}

std::vector<std::string> make_row(const NoisePoint& point, const NoiseErrors& errors) {
  std::vector<std::string> row = {format_number(point.scale)};
  for (const SnapshotErrors& snapshot : errors.snapshots) {
    row.push_back(round(snapshot.bound));
    row.push_back(round(snapshot.network));
  }
  const WindowErrors& window = errors.window;
  row.insert(row.end(), {round(window.bound), round(window.network),
                         format_cell("{:.2f}", window.network / window.bound), round(window.fit),
                         format_cell("{:.2f}", window.fit / window.bound)});
  return row;
}

ReportTable make_sensor_table(const NoiseStudy& study) {
  ReportTable table{"Sensors at noise 1, 1 sigma",
                    {"channel", "of", "unit", "each sample", "bias of a record"},
                    {},
                    {},
                    3};
  for (const NoiseSensor& sensor : study.sensors) {
    table.rows.push_back({sensor.channel, sensor.in_window ? "window" : "snapshot", sensor.unit,
                          round(sensor.sigma), sensor.bias > 0.0 ? round(sensor.bias) : ""});
  }
  table.notes = {
      "Accelerometers and gyroscopes of the MEMS class: 75 to 160 ug/sqrt(Hz) and 0.003 to 0.014 "
      "deg/s/sqrt(Hz) over about 250 Hz, zero offsets of 20 to 60 mg and 0.5 to 3 deg/s (data "
      "sheets of ICM-42688, ICM-20602, BMI160, BMI270, BMI088). Assumptions: height from a laser "
      "sensor, velocity integrated and corrected by it, pitch angle from a fused attitude. White "
      "noise is scaled; biases, hit time and speed are not."};
  return table;
}

ReportTable make_fit_table(const NoiseStudy& study) {
  ReportTable table{"Fits of the simulation to windows",
                    {"noise", "fits", "converged", "chi2 per degree of freedom", "s each"},
                    {},
                    {},
                    0};
  for (const NoisePoint& point : study.points) {
    table.rows.push_back(
        {format_number(point.scale), std::to_string(study.fits), std::to_string(point.converged),
         format_cell("{:.4f}", point.chi2_per_degree), format_cell("{:.2g}", point.fit_seconds)});
  }
  table.notes = {
      "Where the noise is far below that of real sensors, chi2 is above 1: the step of the "
      "simulation, finer in the records than in the fits, then causes errors that are no longer "
      "small against the noise."};
  return table;
}

double find_largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// "23 to 92 %": the range over the parameters of `get(errors)` as a fraction of the grid's spread.
template <class Get>
std::string describe_fractions(const NoiseStudy& study, const Get& get) {
  const NoisePoint& point = find_real_point(study);
  std::vector<double> percents;
  percents.reserve(point.errors.size());
  for (std::size_t p = 0; p < point.errors.size(); ++p) {
    percents.push_back(100.0 * get(point.errors[p]) / study.spread[p]);
  }
  const auto [low, high] = std::minmax_element(percents.begin(), percents.end());
  const auto describe = [](double percent) {
    return percent < 9.95 ? fmt::format("{:.2g}", percent) : fmt::format("{:.0f}", percent);
  };
  return fmt::format("{} to {} %", describe(*low), describe(*high));
}

std::string describe_measurements(const NoiseStudy& study) {
  return fmt::format(
      "The tables above are without noise. Here every network is trained and tested with it, on {} "
      "noisy copies of each case. A snapshot holds the main inputs at the sweep's own instant, "
      "with each preload. A window holds what the sensors on the body record at {} Hz from {} to "
      "{} s (preload {}); its hit time (1 sigma {} ms), the speed and the sensors' biases are "
      "unknown, too. Noise 1 is that of real sensors; the other rows scale it.",
      study.copies, format_number(study.rate), format_number(study.from), format_number(study.to),
      study.window_preload, format_number(1e3 * study.hit_time));
}

std::string describe_bounds(const NoiseStudy& study) {
  double snapshot = 0.0;
  for (const auto& variation : study.snapshot_variation) {
    snapshot = std::max(snapshot, find_largest(variation));
  }
  return fmt::format(
      "Bound: the Cramer-Rao bound, 1 sigma of the best unbiased estimate from the sensors alone. "
      "Over the test cases it varies by a factor of up to {:.2f} for snapshots and {:.2f} for "
      "windows, so the tables hold its root mean square over {} test cases, as errors are root "
      "mean squares. A network also knows the grid that its cases come from: where the bound "
      "exceeds the grid's spread, it answers with the middle, errs by the spread and has learned "
      "nothing. Where the cases stand on levels of a grid and the bound is below their distance, "
      "it rounds to the nearest level and errs less than the bound.",
      snapshot, find_largest(study.window_variation), study.fits);
}

std::string describe_result(const NoiseStudy& study) {
  const NoisePoint& point = find_real_point(study);
  const WindowRatios ratios = calc_window_ratios(point);
  std::string snapshots;
  for (std::size_t i = 0; i < study.preloads.size(); ++i) {
    snapshots += fmt::format(
        "{}by {} with preload {}", i == 0 ? "" : " and ",
        describe_fractions(study, [i](const auto& e) { return e.snapshots[i].network; }),
        study.preloads[i]);
  }
  return fmt::format(
      "At noise {}, relative to the spread of the grid, a network that sees one snapshot errs {}, "
      "depending on the parameter; 100 % is the error without any sensor. From a window it errs by "
      "{}. That is at most {:.2f} times the bound; the fitted simulation reaches at most {:.2f} "
      "times the bound (worst parameter; 1 sigma of a ratio from {} fits is {:.0f} %).",
      format_number(point.scale), snapshots,
      describe_fractions(study, [](const auto& e) { return e.window.network; }), ratios.network,
      ratios.fit, study.fits, 100.0 / std::sqrt(2.0 * static_cast<double>(study.fits)));
}

}  // namespace

std::vector<ReportTable> make_noise_tables(const NoiseStudy& study) {
  std::vector<ReportTable> tables;
  tables.reserve(study.parameters.size());
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    const ColumnInfo& parameter = study.parameters[p];
    ReportTable table;
    table.caption = fmt::format("Errors of {} [{}] with sensor noise; spread of the grid {}",
                                parameter.name, parameter.unit, round(study.spread[p]));
    table.header = make_header(study);
    for (const NoisePoint& point : study.points) {
      table.rows.push_back(make_row(point, point.errors[p]));
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

std::string describe_noise_result(const NoiseStudy& study) {
  const NoisePoint& point = find_real_point(study);
  const WindowRatios ratios = calc_window_ratios(point);
  double smallest = 1e300;
  for (const NoiseErrors& errors : point.errors) {
    for (const SnapshotErrors& snapshot : errors.snapshots) {
      smallest = std::min(smallest, snapshot.network / errors.window.network);
    }
  }
  return fmt::format(
      "noise {}: from a window the network errs by at most {:.2f}, the fit by at most {:.2f} times "
      "the Cramer-Rao bound ({} fits); from one snapshot at least {:.2g} times as much as from the "
      "window",
      format_number(point.scale), ratios.network, ratios.fit, study.fits, smallest);
}

ReportSection make_noise_section(const NoiseStudy& study, const FigureDrawer& drawer) {
  ReportSection section;
  section.heading = "Sensor noise";
  section.paragraphs = {describe_measurements(study), describe_result(study),
                        describe_bounds(study)};
  section.tables = make_noise_tables(study);
  section.tables.push_back(make_fit_table(study));
  section.tables.push_back(make_sensor_table(study));
  section.figures = {drawer.draw(make_noise_chart(study))};
  return section;
}

}  // namespace strut
