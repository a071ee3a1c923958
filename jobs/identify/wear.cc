#include "jobs/identify/wear.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <utility>

#include "base/error/input_error.h"
#include "base/text/parse_number.h"
#include "identify/wear.h"
#include "jobs/cli/settings.h"
#include "jobs/identify/result.h"
#include "model_files/read_vehicle.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Reads PERCENT or NAME=PERCENT and sets it.
void apply_limit(const std::string& setting, std::vector<WearScale>& scales) {
  const auto equals = setting.find('=');
  const std::string name = equals == std::string::npos ? "" : setting.substr(0, equals);
  const std::string number = equals == std::string::npos ? setting : setting.substr(equals + 1);
  const auto limit = parse_number<double>(number);
  if (!limit) {
    throw InputError(fmt::format(
        "'{}': must be PERCENT for all, or NAME=PERCENT, as front_damping=30", setting));
  }
  set_wear_limit(scales, name, *limit);
}

std::vector<WearScale> read_scales(const Arguments& arguments, const fs::path& vehicle,
                                   const IdentifiedRow& row) {
  const fs::path file = arguments.has("new") ? fs::path(arguments.text("new")) : vehicle;
  if (file.empty()) {
    for (const char* option : {"limit", "before"}) {
      if (!arguments.has(option)) continue;
      throw InputError(fmt::format(
          "--{}: needs --new VEHICLE.toml, the car in new condition; a model does not hold it",
          option));
    }
    return {};
  }
  std::vector<std::string> names;
  for (const IdentifiedParameter& p : row.parameters) names.push_back(p.name);
  std::vector<WearScale> scales = make_wear_scales({read_vehicle(file), {}}, names);
  // Limits for all first, so that those of single parts hold in any order.
  std::vector<std::string> limits = arguments.list("limit");
  std::stable_partition(limits.begin(), limits.end(), [](const std::string& setting) {
    return setting.find('=') == std::string::npos;
  });
  for (const std::string& limit : limits) {
    name_option("limit", [&] { apply_limit(limit, scales); });
  }
  return scales;
}

/// A number with its half width; "-" where it is unknown.
std::string format_interval(double value, double half_width) {
  constexpr double kShown = 0.005;
  if (std::abs(value) < kShown) value = 0.0;  // not "-0.00"
  if (!std::isfinite(value)) return fmt::format("{:>9}{:>9}", "-", "-");
  if (!std::isfinite(half_width)) return fmt::format("{:>9.2f}{:>9}", value, "-");
  return fmt::format("{:>9.2f}{:>9.2f}", value, half_width);
}

/// The limit and the probability of a loss beyond it.
std::string format_beyond(const Wear& wear) {
  if (std::isnan(wear.limit)) return "";
  if (std::isnan(wear.beyond)) return fmt::format("{:>8g}{:>12}", wear.limit, "-");
  std::string text = fmt::format("{:.3f}", wear.beyond);
  if (wear.beyond <= kLeastBeyond) text = fmt::format("< {:g}", kLeastBeyond);
  if (wear.beyond >= 1.0 - kLeastBeyond) text = fmt::format("> {:g}", 1.0 - kLeastBeyond);
  return fmt::format("{:>8g}{:>12}", wear.limit, text);
}

}  // namespace

void add_wear_options(Arguments& arguments) {
  arguments.add_option("new", ArgumentValue::file("VEHICLE.toml", {"toml"}),
                       "the car in new condition, for wear in per cent of new (default for a fit:\n"
                       "its VEHICLE; for a model: none, no wear)");
  arguments.add_list("limit", "[NAME=]PERCENT",
                     "report the probability that the wear of all parts, or of NAME, exceeds\n"
                     "PERCENT of new");
  arguments.add_list("before", ArgumentValue::file("MEASURED", {"csv", "txt", "h5", "hdf5", "mat"}),
                     "an earlier measurement of the same car: report the change of wear");
}

std::vector<fs::path> list_before(const Arguments& arguments) {
  const std::vector<std::string> files = arguments.list("before");
  return {files.begin(), files.end()};
}

std::vector<IdentifiedRow> add_wear_by_options(const Arguments& arguments, const fs::path& vehicle,
                                               std::vector<IdentifiedRow> rows,
                                               std::vector<IdentifiedRow>& before) {
  if (!before.empty() && before.size() != rows.size()) {
    throw InputError(fmt::format("--before: {} measurements, after them {}; allowed: as many",
                                 before.size(), rows.size()));
  }
  const std::vector<WearScale> scales = read_scales(arguments, vehicle, rows.front());
  for (IdentifiedRow& row : rows) add_wear(row, scales);
  for (std::size_t i = 0; i < before.size(); ++i) {
    add_wear(before[i], scales);
    add_wear_change(rows[i], before[i]);
  }
  return rows;
}

void add_wear_json(const IdentifiedParameter& parameter, Json& values) {
  const auto add_interval = [&](const std::string& name, double value, double half_width) {
    values[name + "_percent"] = value;
    values[name + "_ci95"] = make_interval_json(value, half_width);
  };
  if (!parameter.wear) return;
  const Wear& wear = *parameter.wear;
  values["new"] = wear.fresh;
  add_interval("wear", wear.percent, wear.half_width);
  if (!std::isnan(wear.limit)) {
    values["limit_percent"] = wear.limit;
    values["probability_beyond_limit"] = wear.beyond;
  }
  if (parameter.change) {
    add_interval("change", parameter.change->percent, parameter.change->half_width);
  }
}

void print_wear(const std::vector<IdentifiedRow>& rows) {
  std::size_t width = 28;
  bool any = false, limited = false, changed = false;
  const auto name_line = [&](const IdentifiedRow& row, const IdentifiedParameter& p) {
    return rows.size() == 1 ? p.name : row.source + " " + p.name;
  };
  for (const IdentifiedRow& row : rows) {
    for (const IdentifiedParameter& p : row.parameters) {
      if (!p.wear) continue;
      any = true;
      limited = limited || !std::isnan(p.wear->limit);
      changed = changed || p.change.has_value();
      width = std::max(width, name_line(row, p).size() + 2);
    }
  }
  if (!any) return;
  std::cout << fmt::format("\n{:<{}}{:>12}{:>9}{:>9}", "wear", width, "new", "%", "+-")
            << (changed ? fmt::format("{:>9}{:>9}", "change", "+-") : "")
            << (limited ? fmt::format("{:>8}{:>12}", "limit", "P(beyond)") : "") << "\n";
  for (const IdentifiedRow& row : rows) {
    for (const IdentifiedParameter& p : row.parameters) {
      if (!p.wear) continue;
      std::cout << fmt::format("{:<{}}{:>12g}", name_line(row, p), width, p.wear->fresh)
                << format_interval(p.wear->percent, p.wear->half_width)
                << (p.change ? format_interval(p.change->percent, p.change->half_width) : "")
                << format_beyond(*p.wear) << "\n";
    }
  }
}

}  // namespace strut
