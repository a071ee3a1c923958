#include "jobs/identify/result.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "base/text/format_number.h"
#include "io/format/csv.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/standard_output.h"

namespace strut {
namespace {

/// Rows of a longer list whose trouble is told one by one.
constexpr std::size_t kMostTold = 10;

double get_low(const IdentifiedParameter& p) { return p.value - p.half_width; }
double get_high(const IdentifiedParameter& p) { return p.value + p.half_width; }

/// Decimals that show so many digits of a number.
int count_decimals(double value, int digits) {
  if (!std::isfinite(value) || value == 0.0) return 6;
  return std::clamp(digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value)))), 0, 12);
}

/// As many as show two digits of the half width; without one, six of the value.
int count_decimals(const IdentifiedParameter& p) {
  const bool known = std::isfinite(p.half_width) && p.half_width > 0.0;
  return known ? count_decimals(p.half_width, 2) : count_decimals(p.value, 6);
}

/// "-" where it is not told.
std::string format_fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
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
    Json bounds = Json::array();
    bounds.push_back(get_low(p));
    bounds.push_back(get_high(p));
    Json values = Json::object();
    values["value"] = p.value;
    values["ci95"] = bounds;
    values["unit"] = p.unit;
    values["in_range"] = p.in_range;
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

bool are_in_range(const std::vector<IdentifiedRow>& rows) {
  return std::all_of(rows.begin(), rows.end(),
                     [](const IdentifiedRow& row) { return row.in_range(); });
}

void print_one(const IdentifiedRow& row) {
  std::size_t longest = 26;
  for (const IdentifiedParameter& p : row.parameters) longest = std::max(longest, p.name.size());
  const int width = static_cast<int>(longest) + 2;
  const auto print = [&](const std::string& name, const std::string& value, const std::string& half,
                         const std::string& unit, const char* in_range) {
    print_format("%-*s%16s%14s  ", width, name.c_str(), value.c_str(), half.c_str());
    row.in_range() ? print_format("%s\n", unit.c_str())
                   : print_format("%-12s%s\n", unit.c_str(), in_range);
  };
  print("parameter", "value", "+-", "unit", "in range");
  for (const IdentifiedParameter& p : row.parameters) {
    print(p.name, format_value(p), format_width(p), p.unit, p.in_range ? "yes" : "no");
  }
}

void print_many(const std::vector<IdentifiedRow>& rows) {
  std::size_t width = 3;
  for (const IdentifiedRow& row : rows) width = std::max(width, row.place.size());
  const int place = static_cast<int>(width);
  print_format("%-*s", place, "row");
  for (const IdentifiedParameter& p : rows.front().parameters) {
    const std::string title = p.name + " " + p.unit;
    print_format("%26s%12s", title.c_str(), "+-");
  }
  print_format("  in range\n");
  for (const IdentifiedRow& row : rows) {
    print_format("%-*s", place, row.place.c_str());
    for (const IdentifiedParameter& p : row.parameters) {
      print_format("%26s%12s", format_value(p).c_str(), format_width(p).c_str());
    }
    print_format("  %s\n", row.in_range() ? "yes" : "no");
  }
}

std::string describe_excess(const OutsideChannel& channel) {
  if (channel.excess == 0.0) return "outside of what the model knows";
  const bool below = channel.excess < 0.0;
  char share[32];
  std::snprintf(share, sizeof share, "%.3g", 100.0 * std::abs(channel.excess));
  return std::string(share) + " % of the range trained on " + (below ? "below" : "above") +
         " its " + (below ? "lowest, " : "highest, ") +
         format_number(below ? channel.low : channel.high);
}

void tell_outside(const IdentifiedRow& row) {
  for (const OutsideChannel& channel : row.outside) {
    print_error(row.place + ": " + channel.name + " = " + format_number(channel.value) + " " +
                channel.unit + ": " + describe_excess(channel));
  }
  for (const IdentifiedParameter& p : row.parameters) {
    if (p.in_range || !row.outside.empty()) continue;
    print_error(row.place + ": " + p.name + " = " + format_number(p.value) + " " + p.unit +
                " lies outside of the range trained on");
  }
}

void tell_trouble(const std::vector<IdentifiedRow>& rows) {
  std::size_t told = 0, troubled = 0;
  for (const IdentifiedRow& row : rows) {
    if (row.in_range()) continue;
    ++troubled;
    if (told++ < kMostTold) tell_outside(row);
  }
  if (rows.size() > 1 && troubled > 0) {
    print_error(format_count(static_cast<std::int64_t>(troubled)) + " of " +
                format_count(static_cast<std::int64_t>(rows.size())) +
                " rows are outside of the range trained on");
  }
}

}  // namespace

bool IdentifiedRow::in_range() const {
  return outside.empty() && std::all_of(parameters.begin(), parameters.end(),
                                        [](const auto& p) { return p.in_range; });
}

Json make_identified_json(const std::vector<IdentifiedRow>& rows) {
  if (rows.size() == 1) return make_row_json(rows.front());
  Json list = Json::array();
  for (const IdentifiedRow& row : rows) {
    Json json = make_row_json(row);
    json["place"] = row.place;
    list.push_back(json);
  }
  Json json = Json::object();
  json["rows"] = list;
  json["in_range"] = are_in_range(rows);
  return json;
}

void print_identified(const std::vector<IdentifiedRow>& rows) {
  rows.size() == 1 ? print_one(rows.front()) : print_many(rows);
  tell_trouble(rows);
}

void write_identified_csv(const std::filesystem::path& path,
                          const std::vector<IdentifiedRow>& rows) {
  std::vector<CsvColumn> columns = {{"row", "1", {}}};
  columns.reserve(3 * rows.front().parameters.size() + 2);
  for (const IdentifiedParameter& p : rows.front().parameters) {
    for (const char* end : {"", "_low", "_high"}) columns.push_back({p.name + end, p.unit, {}});
  }
  columns.push_back({"in_range", "1", {}});
  for (const IdentifiedRow& row : rows) {
    std::size_t c = 0;
    const auto add = [&](double value) { columns[c++].values.push_back(value); };
    add(static_cast<double>(&row - rows.data()));
    for (const IdentifiedParameter& p : row.parameters) {
      add(p.value);
      add(get_low(p));
      add(get_high(p));
    }
    add(row.in_range() ? 1.0 : 0.0);
  }
  write_csv(path, columns);
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
  suggest_next(words, rows.size() == 1 ? "" : "the first of these rows");
}

int show_identified(const Arguments& arguments, const std::vector<IdentifiedRow>& rows) {
  if (arguments.has("output")) {
    write_identified_csv(find_output_file(arguments, arguments.positional()), rows);
  }
  if (arguments.is_on("json")) {
    std::cout << format_json(make_identified_json(rows)) << "\n";
  } else {
    print_identified(rows);
  }
  if (!are_in_range(rows)) {
    suggest_next({"strut", "plan", "SWEEP.toml", "-o", "cars"},
                 "a sweep whose grid reaches to what was measured, for a network that knows it");
    return kExitNegative;
  }
  suggest_next_simulation(rows);
  return kExitDone;
}

}  // namespace strut
