#include "model_files/read_maneuver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error/input_error.h"
#include "base/math/linear.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "io/format/toml_document.h"
#include "io/table/csv.h"
#include "io/table/units.h"
#include "model/error/model_error.h"
#include "model/scenario/iso_road.h"
#include "model_files/choices.h"
#include "model_files/file_kind.h"
#include "model_files/parameters.h"

namespace strut {

namespace {

double read_parameter(const Table& table, const std::string& key, const std::string& parameter) {
  return table.number(key, find_parameter(parameter).allowed);
}

/// A column of lengths in its own unit, without one in meters.
std::vector<double> read_meters(const CsvTable& csv, const std::string& name) {
  const CsvColumn& column = csv.column(name);
  const UnitScale unit = [&] {
    try {
      return find_unit_scale(column.unit, "m");
    } catch (const InputError& e) {
      throw InputError(fmt::format("{}: column {}: {}", csv.path.string(), name, e.what()));
    }
  }();
  std::vector<double> values = column.values;
  for (double& value : values) value = unit.factor * value + unit.offset;
  return values;
}

/// Throws InputError unless the positions ascend. Called last, so that a missing column is named.
std::vector<double> read_positions(const CsvTable& csv) {
  std::vector<double> x = read_meters(csv, "position");
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (x[i] > x[i - 1]) continue;
    throw InputError(fmt::format("{}:{}: position = {}: must be > {} m, the previous position",
                                 csv.path.string(), csv.lines[i], format_number(x[i]),
                                 format_number(x[i - 1])));
  }
  if (x.size() < 3) {
    throw InputError(fmt::format("{}: {} rows: must be at least 3", csv.path.string(), x.size()));
  }
  return x;
}

void read_profile(const Table& bump, RoadSpec& road) {
  const CsvTable csv = read_csv(bump.file("file"));
  road.table_z = read_meters(csv, "height");
  road.table_x = read_positions(csv);
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
  road.count = static_cast<int>(bump.integer_or("count", 1, 1, 20));
  if (road.count > 1) road.spacing = read_parameter(bump, "spacing", "bump_spacing");
  try {
    validate(road);
  } catch (const ModelError& e) {
    throw bump.error(e.what());
  }
}

/// Spacing of a surveyed road; a finer survey keeps its own, down to a half of this.
constexpr double kFinestSurvey = 0.01;  // m

constexpr std::array<const char*, 8> kIsoClasses = {"A", "B", "C", "D", "E", "F", "G", "H"};

/// By its class, or by the density itself.
double read_roughness(const Table& road) {
  if (!road.has("class")) return road.number("roughness", between(0.0, 1.0, "m^3"));
  if (road.has("roughness")) {
    throw road.error("class and roughness are both given: give one of them");
  }
  return 16e-6 * std::pow(4.0, road.choice("class", {kIsoClasses.begin(), kIsoClasses.end()}));
}

RoadProfile read_iso_road(const Table& road) {
  IsoRoad iso;
  iso.roughness = read_roughness(road);
  iso.length = road.number_or("length", iso.length, between(20.0, 2000.0, "m"));
  iso.begin = road.number_or("begin", iso.begin, between(0.0, 1000.0, "m"));
  iso.track_width = road.number_or("track_width", iso.track_width, between(0.1, 5.0, "m"));
  iso.seed = static_cast<std::uint64_t>(
      road.integer_or("seed", 1, 0, std::numeric_limits<std::int64_t>::max()));
  return make_iso_road(iso);
}

/// Heights at equally spaced points, linear between those of the file.
std::vector<double> resample(const std::vector<double>& x, const std::vector<double>& z,
                             double spacing, std::size_t count) {
  std::vector<double> heights;
  for (std::size_t i = 0, j = 1; i < count; ++i) {
    const double at = std::min(x.front() + spacing * static_cast<double>(i), x.back());
    heights.push_back(interpolate_line(x, z, at, j));
  }
  return heights;
}

/// Throws InputError, which names the file and its columns, unless it has positions and one or two
/// heights.
std::array<std::string, 2> find_height_columns(const CsvTable& csv) {
  const bool has_tracks = csv.has("left") && csv.has("right");
  if (csv.has("position") && (has_tracks || csv.has("height"))) {
    return has_tracks ? std::array<std::string, 2>{"left", "right"}
                      : std::array<std::string, 2>{"height", "height"};
  }
  std::vector<std::string> names;
  for (const CsvColumn& column : csv.columns) names.push_back(column.name);
  throw InputError(fmt::format("{}: columns {}; must have position, and left and right or height",
                               csv.path.string(), join_names(names)));
}

/// Throws InputError for a survey that a road cannot have: its message names file, row and column.
void check_survey(const CsvTable& csv, const std::vector<double>& x, const std::string& name,
                  const std::vector<double>& z) {
  const auto refuse = [&](std::size_t row, const std::string& column, double value,
                          const std::string& allowed) {
    throw InputError(fmt::format("{}:{}: {} = {} m: {}", csv.path.string(), csv.lines[row], column,
                                 format_number(value), allowed));
  };
  if (x.front() < 0.0 || x.front() > kMaxRoadBegin) {
    refuse(0, "position", x.front(),
           fmt::format("must lie in [0, {}] m: it counts from the front wheels at the start",
                       format_number(kMaxRoadBegin)));
  }
  const double longest = kFinestSurvey * static_cast<double>(kMaxRoadPoints - 1);
  if (x.back() - x.front() > longest) {
    refuse(x.size() - 1, "position", x.back(),
           fmt::format("a survey may be {} m long", format_rounded(longest)));
  }
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (std::fabs(z[i] - z.front()) <= kMaxRoadHeight) continue;
    refuse(
        i, name, z[i],
        fmt::format("must be within {} m of the first; heights in another unit need it beside the "
                    "name, as in \"{} [mm]\"",
                    format_number(kMaxRoadHeight), name));
  }
}

/// Throws InputError where the fading of an end would be a slope that no road has.
void check_fade(const CsvTable& csv, const std::string& name, double height, double fade,
                const char* end) {
  constexpr double kSteepest = 0.2, kStep = 0.02;
  if (std::fabs(height) <= std::max(kSteepest * fade, kStep)) return;
  throw InputError(fmt::format(
      "{}: {} {} {} m above the level road, to which it fades over {} m; give a longer fade, or a "
      "survey without grade and crossfall",
      csv.path.string(), name, end, format_rounded(height), format_number(fade)));
}

/// A survey has its own zero of height and may end anywhere: heights count from the first on the
/// left, and both ends fade into the level road.
RoadProfile read_survey(const Table& road) {
  for (const char* key : {"class", "roughness", "seed", "length", "begin", "track_width"}) {
    if (road.has(key)) {
      throw road.error(
          fmt::format("{} and file are both given: a road is random or surveyed", key));
    }
  }
  const CsvTable csv = read_csv(road.file("file"));
  const double fade = road.number_or("fade", 1.0, between(0.0, 100.0, "m"));
  const std::array<std::string, 2> names = find_height_columns(csv);
  std::array<std::vector<double>, 2> heights = {read_meters(csv, names[0]),
                                                read_meters(csv, names[1])};
  const std::vector<double> x = read_positions(csv);
  for (std::size_t side = 0; side < 2; ++side) check_survey(csv, x, names[side], heights[side]);
  const double length = x.back() - x.front();
  double closest = length;
  for (std::size_t i = 1; i < x.size(); ++i) closest = std::min(closest, x[i] - x[i - 1]);
  double points =
      std::ceil(length / std::clamp(closest, 0.5 * kFinestSurvey, kFinestSurvey) - 1e-6);
  points = std::clamp(points, 2.0, static_cast<double>(kMaxRoadPoints - 1));
  RoadProfile profile{x.front(), length / points, {}};
  const double zero = heights[0].front();
  for (std::size_t side = 0; side < 2; ++side) {
    for (double& height : heights[side]) height -= zero;
    check_fade(csv, names[side], heights[side].front(), fade, "begins");
    check_fade(csv, names[side], heights[side].back(), fade, "ends");
    profile.height[side] =
        resample(x, heights[side], profile.spacing, static_cast<std::size_t>(points) + 1);
  }
  fade_ends(profile, fade);
  return profile;
}

void read_road(const Table& road, ManeuverSpec& maneuver) {
  try {
    RoadProfile profile = road.has("file") ? read_survey(road) : read_iso_road(road);
    validate(profile);
    maneuver.profile.data = std::make_shared<const RoadProfile>(std::move(profile));
  } catch (const ModelError& e) {
    throw road.error(e.what());
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
  if (root.has("road")) read_road(root.table("road"), maneuver);
  if (root.has("bump") || !root.has("road")) {
    read_bump(root.table("bump"), maneuver);
  } else {
    maneuver.road.shape = BumpShape::kNone;
  }
  document.check_all_read();
  return maneuver;
}

}  // namespace strut
