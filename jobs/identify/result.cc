#include "jobs/identify/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "base/text/format_number.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/standard_output.h"
#include "jobs/identify/wear.h"

namespace strut {
namespace {

/// Maximum number of rows out of range that are reported one by one.
constexpr std::size_t kMaxReported = 10;

/// Number of decimals that show `digits` significant digits of a value.
int count_decimals(double value, int digits) {
  if (!std::isfinite(value) || value == 0.0) return 6;
  return std::clamp(digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value)))), 0, 12);
}

/// Two significant digits of the half width; without one, six of the value.
int count_decimals(const IdentifiedParameter& p) {
  const bool known = std::isfinite(p.half_width) && p.half_width > 0.0;
  return known ? count_decimals(p.half_width, 2) : count_decimals(p.value, 6);
}

/// "-" for a number that is not finite.
std::string format_fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  return fmt::format("{:.{}f}", value, decimals);
}

std::string format_value(const IdentifiedParameter& p) {
  return format_fixed(p.value, count_decimals(p));
}

std::string format_width(const IdentifiedParameter& p) {
  return format_fixed(p.half_width, count_decimals(p));
}

Json make_row_json(const IdentifiedRow& row) {
  Json parameters = Json::object();
  for (const IdentifiedParameter& p : row.parameters) {
    Json values = Json::object();
    add_estimate_json(p, values);
    values["in_range"] = p.in_range;
    add_wear_json(p, values);
    parameters[p.name] = values;
  }
  Json outside = Json::array();
  for (const OutsideChannel& channel : row.outside) {
    Json json = Json::object();
    json["channel"] = channel.name;
    json["value"] = channel.value;
    json["low"] = channel.low;
    json["high"] = channel.high;
    json["excess"] = channel.excess;
    outside.push_back(json);
  }
  Json json = Json::object();
  json["parameters"] = parameters;
  json["in_range"] = row.in_range();
  json["outside"] = outside;
  return json;
}

void print_one(const IdentifiedRow& row) {
  std::size_t width = 26;
  for (const IdentifiedParameter& p : row.parameters) width = std::max(width, p.name.size());
  const bool in_range = row.in_range();
  const auto print = [&](const std::string& name, const std::string& value, const std::string& half,
                         const std::string& unit, const char* is_inside) {
    std::cout << fmt::format("{:<{}}{:>16}{:>14}  ", name, width + 2, value, half)
              << (in_range ? fmt::format("{}\n", unit)
                           : fmt::format("{:<12}{}\n", unit, is_inside));
  };
  print("parameter", "value", "+- (95 %)", "unit", "in range");
  for (const IdentifiedParameter& p : row.parameters) {
    print(p.name, format_value(p), format_width(p), p.unit, p.in_range ? "yes" : "no");
  }
}

void print_many(const std::vector<IdentifiedRow>& rows) {
  std::size_t width = 3;
  for (const IdentifiedRow& row : rows) width = std::max(width, row.source.size());
  std::cout << fmt::format("{:<{}}", "row", width);
  for (const IdentifiedParameter& p : rows.front().parameters) {
    std::cout << fmt::format("{:>26}{:>12}", p.name + " " + p.unit, "+- (95 %)");
  }
  std::cout << "  in range\n";
  for (const IdentifiedRow& row : rows) {
    std::cout << fmt::format("{:<{}}", row.source, width);
    for (const IdentifiedParameter& p : row.parameters) {
      std::cout << fmt::format("{:>26}{:>12}", format_value(p), format_width(p));
    }
    std::cout << (row.in_range() ? "  yes\n" : "  no\n");
  }
}

std::string describe_excess(const OutsideChannel& channel) {
  if (channel.excess == 0.0) return "beyond the reach of the alignment with the reference";
  const bool below = channel.excess < 0.0;
  return fmt::format("{:.3g} % of the training range {} its {}, {}",
                     100.0 * std::abs(channel.excess), below ? "below" : "above",
                     below ? "minimum" : "maximum",
                     format_significant(below ? channel.low : channel.high, 4));
}

void report_row(const IdentifiedRow& row) {
  for (const OutsideChannel& channel : row.outside) {
    print_error(fmt::format("{}: {} = {} {}: {}", row.source, channel.name,
                            format_significant(channel.value, 4), channel.unit,
                            describe_excess(channel)));
  }
  for (const IdentifiedParameter& p : row.parameters) {
    if (p.in_range || !row.outside.empty()) continue;
    print_error(fmt::format("{}: {} = {} {}: outside of the range trained on", row.source, p.name,
                            format_number(p.value), p.unit));
  }
}

void report_out_of_range(const std::vector<IdentifiedRow>& rows) {
  std::size_t count = 0;
  for (const IdentifiedRow& row : rows) {
    if (row.in_range()) continue;
    if (count++ < kMaxReported) report_row(row);
  }
  if (rows.size() > 1 && count > 0) {
    print_error(fmt::format("{} of {} rows are outside of the range trained on",
                            format_count(static_cast<std::int64_t>(count)),
                            format_count(static_cast<std::int64_t>(rows.size()))));
  }
}

}  // namespace

Json make_interval_json(double value, double half_width) {
  Json bounds = Json::array();
  bounds.push_back(value - half_width);
  bounds.push_back(value + half_width);
  return bounds;
}

void add_estimate_json(const IdentifiedParameter& parameter, Json& values) {
  values["value"] = parameter.value;
  values["ci95"] = make_interval_json(parameter.value, parameter.half_width);
  values["unit"] = parameter.unit;
}

Json make_identified_json(const std::vector<IdentifiedRow>& rows) {
  if (rows.size() == 1) return make_row_json(rows.front());
  Json list = Json::array();
  for (const IdentifiedRow& row : rows) {
    Json json = make_row_json(row);
    json["place"] = row.source;
    list.push_back(json);
  }
  Json json = Json::object();
  json["rows"] = list;
  json["in_range"] = are_in_range(rows);
  return json;
}

void print_identified(const std::vector<IdentifiedRow>& rows) {
  rows.size() == 1 ? print_one(rows.front()) : print_many(rows);
  print_wear(rows);
  report_out_of_range(rows);
}

void add_result_options(Arguments& arguments) {
  arguments.add_option("output,o", ArgumentValue::file("FILE", {"csv"}), "write a table (CSV)");
  arguments.add_switch("force", "replace FILE where it exists");
  arguments.add_switch("json", "print JSON");
}

void suggest_next_simulation(const std::vector<IdentifiedRow>& rows, const std::string& vehicle,
                             const std::string& maneuver) {
  std::vector<std::string> words = {"strut", "simulate", vehicle, maneuver, "-o", "identified.csv"};
  for (const IdentifiedParameter& p : rows.front().parameters) {
    words.insert(words.end(), {"--set", p.name + "=" + format_value(p)});
  }
  suggest_next(words, rows.size() == 1 ? "" : "the car of the first row");
}

int show_identified(const Arguments& arguments, const std::vector<IdentifiedRow>& identified,
                    std::vector<IdentifiedRow> before) {
  const std::vector<IdentifiedRow> rows = add_wear_by_options(arguments, {}, identified, before);
  if (arguments.has("output")) {
    write_identified_csv(find_output_file(arguments, arguments.positional()), rows);
  }
  if (arguments.is_on("json")) {
    std::cout << format_json(make_identified_json(rows)) << "\n";
  } else {
    print_identified(rows);
  }
  if (!are_in_range(rows) || !are_in_range(before)) {
    report_out_of_range(before);
    suggest_next({"strut", "plan", "SWEEP.toml", "-o", "cars"},
                 "a sweep whose grid covers the measurements, to train a network on");
    return kExitNegative;
  }
  suggest_next_simulation(rows);
  return kExitDone;
}

}  // namespace strut
