// Wear in the output of `strut identify`: its options, table and JSON.
#pragma once

#include <filesystem>
#include <vector>

#include "identify/identified.h"
#include "io/format/json.h"
#include "jobs/cli/arguments.h"

namespace strut {

/// --new, --limit, --before
void add_wear_options(Arguments& arguments);

/// The files of --before: earlier measurements of the same car.
std::vector<std::filesystem::path> list_before(const Arguments& arguments);

/// Returns `rows` with their wear by --new (without it, by `vehicle`; where that is empty too,
/// there is no wear) and --limit, and its change since the rows `before`, which get their wear as
/// well and are as many, or none. Throws InputError.
std::vector<IdentifiedRow> add_wear_by_options(const Arguments& arguments,
                                               const std::filesystem::path& vehicle,
                                               std::vector<IdentifiedRow> rows,
                                               std::vector<IdentifiedRow>& before);

/// Adds "new", "wear_percent", "wear_ci95", with a limit "limit_percent" and
/// "probability_beyond_limit", after an earlier measurement "change_percent" and "change_ci95".
void add_wear_json(const IdentifiedParameter& parameter, Json& values);

/// Prints the wear of all rows as a table to standard output, if there is any.
void print_wear(const std::vector<IdentifiedRow>& rows);

}  // namespace strut
