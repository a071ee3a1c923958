// What `strut identify` found, by whatever method, and how it is shown.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "io/format/json.h"
#include "jobs/cli/arguments.h"

namespace strut {

/// One parameter; NaN where something is not told.
struct IdentifiedParameter {
  std::string name, unit;
  double value = std::numeric_limits<double>::quiet_NaN();
  double half_width = std::numeric_limits<double>::quiet_NaN();  // of the 95 % interval
  bool in_range = true;  // false: outside of what the model knows
};

/// A measured channel outside of the range that a model was trained on.
struct OutsideChannel {
  std::string name, unit;
  double value = 0.0, low = 0.0, high = 0.0;
  double excess = 0.0;  // beyond low (negative) or high, as a share of high - low
};

/// What one snapshot, window or set of runs told.
struct IdentifiedRow {
  std::string place;  // where it was measured, "drive.csv:12"
  std::vector<IdentifiedParameter> parameters;
  std::vector<OutsideChannel> outside;

  /// All channels and parameters are.
  bool in_range() const;
};

/// One row: {"parameters": {NAME: {"value":, "ci95": [low, high], "unit":, "in_range":}},
/// "in_range":, "outside": [{"channel":, ...}]}. Several: {"rows": [such with "place"],
/// "in_range": all of them}. Whatever is not told is null.
Json make_identified_json(const std::vector<IdentifiedRow>& rows);

/// To standard output: one row as a table of parameters, several as a line each; why a row is not
/// in range goes to standard error.
void print_identified(const std::vector<IdentifiedRow>& rows);

/// Columns row (from 0), NAME, NAME_low, NAME_high for each parameter, in_range (1 or 0); nan where
/// something is not told. Throws EnvironmentError.
void write_identified_csv(const std::filesystem::path& path,
                          const std::vector<IdentifiedRow>& rows);

/// --output, --force, --json
void add_result_options(Arguments& arguments);

/// Names as next command the simulation of what was identified, in place of the words
/// "VEHICLE.toml" and "MANEUVER.toml" of one of these where they are known.
void suggest_next_simulation(const std::vector<IdentifiedRow>& rows,
                             const std::string& vehicle = "VEHICLE.toml",
                             const std::string& maneuver = "MANEUVER.toml");

/// As those options ask, for one row or more: JSON or a table to standard output, CSV into a file.
/// Returns kExitDone, kExitNegative where a row is not in range.
int show_identified(const Arguments& arguments, const std::vector<IdentifiedRow>& rows);

}  // namespace strut
