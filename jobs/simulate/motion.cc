#include "jobs/simulate/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "model/car/assemble.h"
#include "model/scenario/profile.h"
#include "model_files/choices.h"

namespace strut {
namespace {

constexpr std::size_t kMaxFrames = 1200;
constexpr std::size_t kRoadPoints = 200;

std::vector<double> get_channel(const LaneResults& results, std::size_t channel) {
  return results.get_history(static_cast<int>(channel));
}

double calc_bump_center(const Case& c) {
  return c.vehicle.whole.centroid_to_front + c.maneuver.bump_distance;
}

/// Samples to be shown: up to kMaxFrames near the bump, which is crossed in a tenth of a second,
/// and as many elsewhere.
std::vector<std::size_t> list_frames(const Case& c, const LaneResults& results) {
  constexpr double kBefore = 1.0, kAfter = 4.0;  // m between an axle and the bump's ends
  const WholeCarSpec& whole = c.vehicle.whole;
  const auto road = list_profile(c.maneuver.road);
  const double bump_begin = road.empty() ? 0.0 : road.front()[0];
  const double bump_end = road.empty() ? 0.0 : road.back()[0];
  const double first = calc_bump_center(c) + bump_begin - whole.centroid_to_front - kBefore;
  const double last = calc_bump_center(c) + bump_end + whole.centroid_to_rear + kAfter;

  const std::vector<double> forward = get_channel(results, CarChannel::kForwardPosition);
  const auto get_part = [&](std::size_t i) {
    return first < forward[i] && forward[i] < last ? std::size_t{1} : std::size_t{0};
  };
  std::array<std::size_t, 2> count = {0, 0}, seen = {0, 0};
  for (std::size_t i = 0; i < forward.size(); ++i) ++count[get_part(i)];
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < forward.size(); ++i) {
    const std::size_t part = get_part(i);
    const std::size_t stride = (count[part] + kMaxFrames - 1) / kMaxFrames;
    if (seen[part]++ % stride == 0 || i + 1 == forward.size()) frames.push_back(i);
  }
  return frames;
}

std::size_t get_corner_channel(int corner, int channel) {
  const int first = CarChannel::kCornerBegin + corner * CarChannel::kCornerChannels;
  return static_cast<std::size_t>(first) + static_cast<std::size_t>(channel);
}

/// Six significant digits, more than a screen can show.
Json make_numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) {
    list.push_back(std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr));
  }
  return list;
}

/// The values at the samples `frames`.
Json make_values(const std::vector<double>& all, const std::vector<std::size_t>& frames) {
  std::vector<double> values;
  values.reserve(frames.size());
  for (const std::size_t frame : frames) values.push_back(all[frame]);
  return make_numbers(values);
}

Json make_corners(const LaneResults& results, int channel, const std::vector<std::size_t>& frames) {
  Json list = Json::array();
  for (int corner = 0; corner < kCorners; ++corner) {
    list.push_back(make_values(get_channel(results, get_corner_channel(corner, channel)), frames));
  }
  return list;
}

Json make_point(double x, double z) {
  Json point = Json::array();
  point.push_back(x);
  point.push_back(z);
  return point;
}

/// Wheel center and ends of the spring, relative to the reference point of the body.
Json make_axle(const Case& c, int axle) {
  const SuspensionSpec& suspension = c.vehicle.suspension[static_cast<std::size_t>(axle)];
  const Vec3<double> wheel = calc_wheel_reference(c.vehicle, c.maneuver.gravity, 2 * axle);
  const auto place = [&](const Vec3<double>& p) {
    return make_point(wheel.x + p.x, wheel.z + p.z);
  };
  return Json{{"wheel", make_point(wheel.x, wheel.z)},
              {"upper", place(suspension.spring_upper.position)},
              {"lower", place(suspension.spring_lower.position)}};
}

Json make_road(const Case& c) {
  Json points = Json::array();
  for (const auto& [x, z] : list_profile(c.maneuver.road)) {
    points.push_back(make_point(calc_bump_center(c) + x, z));
  }
  return points;
}

struct CurvePanel {
  const char* label;
  int channel;  // a channel of the body; -1: the channel `corner` of each corner
  int corner = 0;
};

}  // namespace

std::vector<std::array<double, 2>> list_profile(const RoadSpec& road) {
  const Profile profile = make_profile(road);
  const std::size_t pieces = profile.get_piece_count();
  if (pieces == 0) return {};
  const std::size_t count = std::max<std::size_t>(4, kRoadPoints / pieces);  // points of each piece
  std::vector<std::array<double, 2>> points;
  for (std::size_t i = 0; i < pieces; ++i) {
    const double begin = profile.ends[i], end = profile.ends[i + 1];
    for (std::size_t k = 0; k < count; ++k) {
      const double fraction = static_cast<double>(k) / static_cast<double>(count);
      const double x = begin + fraction * (end - begin);
      points.push_back({x, profile.calc(i, x).value});
    }
  }
  points.push_back({profile.ends.back(), profile.calc(pieces - 1, profile.ends.back()).value});
  return points;
}

Json make_motion(const Case& c, const LaneResults& results) {
  const std::vector<std::size_t> frames = list_frames(c, results);
  const auto add = [&](Json& json, const char* name, std::size_t channel) {
    json[name] = make_values(get_channel(results, channel), frames);
  };
  Json json = Json::object();
  add(json, "time", CarChannel::kTime);
  add(json, "forward", CarChannel::kForwardPosition);
  add(json, "height", CarChannel::kBodyPositionZ);
  add(json, "pitch", CarChannel::kPitchAngle);
  json["wheel_height"] = make_corners(results, CarChannel::kWheelPositionZ, frames);
  json["deflection"] = make_corners(results, CarChannel::kSuspensionDeflection, frames);
  json["wheel_speed"] = make_corners(results, CarChannel::kWheelSpeed, frames);
  json["front"] = make_axle(c, kFront);
  json["rear"] = make_axle(c, kRear);
  json["radius"] = c.vehicle.tire.unloaded_radius;
  json["nominal_height"] = c.vehicle.whole.centroid_height;
  json["road"] = make_road(c);
  json["road_side"] = find_name(kBumpSides, c.maneuver.road.side);
  json["snapshot_time"] = results.has_snapshot() ? Json(results.get_event_time()) : Json();
  return json;
}

Chart make_motion_curves(const LaneResults& results) {
  static constexpr std::array<CurvePanel, 6> kPanels = {
      {{"height [m]", CarChannel::kBodyPositionZ},
       {"pitch, nose down [rad]", CarChannel::kPitchAngle},
       {"acceleration [m/s^2]", CarChannel::kBodyAccelerationZ},
       {"compression [m]", -1, CarChannel::kSuspensionDeflection},
       {"damper force [N]", -1, CarChannel::kDamperForce},
       {"tire load [N]", -1, CarChannel::kTireForceZ}}};
  static constexpr std::array<const char*, kCorners> kNames = {"front left", "front right",
                                                               "rear left", "rear right"};
  Chart chart{"curves", {}};
  chart.panel_height = 165;
  chart.width = 620;
  chart.shares_x = true;
  chart.caption =
      "Body, suspension and tires over time; right wheels solid, left dashed. Compression is "
      "relative to nominal trim; damper forces are positive in compression. The vertical line "
      "marks "
      "the instant of the slider.";
  const std::vector<double> time = get_channel(results, CarChannel::kTime);
  for (const CurvePanel& curves : kPanels) {
    ChartPanel panel{{&curves == &kPanels.back() ? "time [s]" : ""}, {curves.label}, {}};
    const auto add = [&](const char* name, SeriesKind kind, int color, std::size_t channel) {
      panel.series.push_back(make_curve(name, kind, color, time, get_channel(results, channel)));
    };
    if (curves.channel >= 0) {
      add("body", SeriesKind::kLine, kInk, static_cast<std::size_t>(curves.channel));
    }
    for (int corner = 0; curves.channel < 0 && corner < kCorners; ++corner) {
      add(kNames[static_cast<std::size_t>(corner)],
          is_right(corner) ? SeriesKind::kLine : SeriesKind::kDashedLine, 1 + axle_of(corner),
          get_corner_channel(corner, curves.corner));
    }
    panel.about = fmt::format("{} over time [s]", curves.label);
    chart.panels.push_back(std::move(panel));
  }
  return chart;
}

}  // namespace strut
