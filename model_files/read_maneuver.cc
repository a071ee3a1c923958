#include "model_files/read_maneuver.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "io/format/toml_document.h"
#include "io/table/csv.h"
#include "model/error/model_error.h"
#include "model_files/choices.h"
#include "model_files/file_kind.h"
#include "model_files/parameters.h"

namespace strut {

namespace {

double read_parameter(const Table& table, const std::string& key, const std::string& parameter) {
  return table.number(key, find_parameter(parameter).allowed);
}

void read_profile(const Table& bump, RoadSpec& road) {
  const CsvTable csv = read_csv(bump.file("file"));
  road.table_x = csv.column("position").values;
  road.table_z = csv.column("height").values;
  for (std::size_t i = 1; i < road.table_x.size(); ++i) {
    if (road.table_x[i] > road.table_x[i - 1]) continue;
    throw InputError(fmt::format("{}:{}: position = {}: must be > {} m, the previous position",
                                 csv.path.string(), csv.lines[i], format_number(road.table_x[i]),
                                 format_number(road.table_x[i - 1])));
  }
  if (road.table_x.size() < 2) {
    throw InputError(
        fmt::format("{}: {} rows: must be at least 3", csv.path.string(), road.table_x.size()));
  }
  road.height = *std::max_element(road.table_z.begin(), road.table_z.end());
  road.length = road.table_x.back() - road.table_x.front();
}

void read_shape(const Table& bump, RoadSpec& road) {
  switch (road.shape) {
    case BumpShape::kNone:
      return;
    case BumpShape::kTable:
      return read_profile(bump, road);
    case BumpShape::kTrapezoid:
      road.ramp = read_parameter(bump, "ramp", "bump_ramp");
      [[fallthrough]];
    default:
      road.height = read_parameter(bump, "height", "bump_height");
      road.length = read_parameter(bump, "length", "bump_length");
  }
}

void read_bump(const Table& bump, ManeuverSpec& maneuver) {
  RoadSpec& road = maneuver.road;
  road.shape = static_cast<BumpShape>(bump.choice("shape", list_names(kBumpShapes)));
  read_shape(bump, road);
  if (road.shape == BumpShape::kNone) return;
  road.side = static_cast<BumpSide>(bump.choice_or("side", 0, list_names(kBumpSides)));
  maneuver.bump_distance = read_parameter(bump, "distance", "bump_distance");
  try {
    validate(road);
  } catch (const ModelError& e) {
    throw bump.error(e.what());
  }
}

}  // namespace

ManeuverSpec read_maneuver(const std::filesystem::path& path) {
  const Document document(path);
  const Table root = open_root(document, kManeuverFile);
  ManeuverSpec maneuver;
  maneuver.speed = read_parameter(root, "speed", "speed");
  maneuver.duration = read_parameter(root, "duration", "duration");
  maneuver.drive_torque = read_parameter(root, "drive_torque", "drive_torque");
  maneuver.drive_reaction = root.number_or("drive_reaction", maneuver.drive_reaction,
                                           find_parameter("drive_reaction").allowed);
  maneuver.gravity = root.number_or("gravity", maneuver.gravity, find_parameter("gravity").allowed);
  maneuver.trim = static_cast<TrimKind>(root.choice_or("trim", 0, list_names(kTrims)));
  read_bump(root.table("bump"), maneuver);
  document.check_all_read();
  return maneuver;
}

}  // namespace strut
