// Output of `strut identify`, the same for all methods: table, JSON, CSV, next command.
#pragma once

#include <string>
#include <vector>

#include "identify/identified.h"
#include "io/format/json.h"
#include "jobs/cli/arguments.h"

namespace strut {

/// [value - half_width, value + half_width]
Json make_interval_json(double value, double half_width);

/// Adds "value", "ci95" and "unit".
void add_estimate_json(const IdentifiedParameter& parameter, Json& values);

/// One row: {"parameters": {NAME: {"value":, "ci95": [low, high], "unit":, "in_range":, and those
/// of add_wear_json}}, "in_range":, "outside": [{"channel":, ...}]}. Several: {"rows": [the same
/// with "place"], "in_range": true if all are}. Unknown numbers are null.
Json make_identified_json(const std::vector<IdentifiedRow>& rows);

/// Prints one row as a table of parameters, several as one line each, and the wear where it is
/// known, to standard output, and why a row is not in range to standard error.
void print_identified(const std::vector<IdentifiedRow>& rows);

/// --output, --force, --json
void add_result_options(Arguments& arguments);

/// Suggests the simulation of the car that was identified; without files, with placeholders for
/// them.
void suggest_next_simulation(const std::vector<IdentifiedRow>& rows,
                             const std::string& vehicle = "VEHICLE.toml",
                             const std::string& maneuver = "MANEUVER.toml");

/// Prints and writes one row or more of a network as the options ask, with the change since the
/// rows `before`, as many or none. Returns kExitDone, or kExitNegative where a row is not in range.
int show_identified(const Arguments& arguments, const std::vector<IdentifiedRow>& identified,
                    std::vector<IdentifiedRow> before);

}  // namespace strut
