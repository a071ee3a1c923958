#include "jobs/simulate/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>

#include "base/error/input_error.h"
#include "base/math/linear.h"
#include "io/store/column_map.h"
#include "jobs/simulate/ride.h"
#include "model/car/assemble.h"
#include "model/scenario/profile.h"
#include "model/scenario/road.h"

namespace strut {
namespace {

constexpr std::size_t kMaxFrames = 1200;
constexpr std::size_t kRoadPoints = 200;  // of a bump
constexpr double kProfileSpacing = 0.05;  // m, of a rough road
constexpr double kSeen = 8.0;             // m ahead of the car

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
  const RoadSpec& spec = c.maneuver.road;
  const double row = (spec.count - 1) * spec.spacing;
  const double bump_end = road.empty() ? 0.0 : road.back()[0] + row;
  const double first = calc_bump_center(c) + bump_begin - whole.centroid_to_front - kBefore;
  const double last = calc_bump_center(c) + bump_end + whole.centroid_to_rear + kAfter;

  const std::vector<double> forward = results.get_history(CarChannel::kForwardPosition);
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
    list.push_back(
        make_values(results.get_history(CarChannel::get_corner_channel(corner, channel)), frames));
  }
  return list;
}

Json make_point(double x, double z) { return Json::array({x, z}); }

Json make_point(const Vec3<double>& p) {
  Json point = Json::array();
  for (const double x : {p.x, p.y, p.z}) point.push_back(1e-4 * std::round(1e4 * x));
  return point;
}

/// Arms, rods and tie rod of a left wheel: pairs of joints on the chassis and on the upright, from
/// the wheel's center at nominal trim.
Json make_links(const SuspensionSpec& suspension) {
  Json links = Json::array();
  const auto add = [&](const Vec3<double>& chassis, const Vec3<double>& upright) {
    links.push_back(Json::array({make_point(chassis), make_point(upright)}));
  };
  if (suspension.kind == SuspensionKind::kMacPherson) {
    add(suspension.arm_front, suspension.ball_joint);
    add(suspension.arm_rear, suspension.ball_joint);
  }
  for (const RodSpec& rod : suspension.rods) add(rod.chassis, rod.upright);
  return links;
}

/// Fraction of the wheel's vertical displacement by which a mount moves: 0 on the chassis, 1 on the
/// upright, and on a link linear in y from its chassis joint to its upright joint.
double calc_share(const SuspensionSpec& suspension, const MountSpec& mount) {
  const auto divide = [&](const Vec3<double>& inner, const Vec3<double>& outer) {
    const double share = (mount.position.y - inner.y) / (outer.y - inner.y);
    return std::clamp(std::isfinite(share) ? share : 1.0, 0.0, 1.0);
  };
  switch (mount.body) {
    case MountBody::kChassis:
      return 0.0;
    case MountBody::kUpright:
      return 1.0;
    case MountBody::kLowerArm:
      return divide(suspension.arm_front, suspension.ball_joint);
    case MountBody::kRod: {
      const RodSpec& rod = suspension.rods[static_cast<std::size_t>(mount.rod)];
      return divide(rod.chassis, rod.upright);
    }
  }
  return 1.0;
}

/// Wheel center and ends of the spring, relative to the reference point of the body; half the
/// track; links and damper of a left wheel.
Json make_axle(const Case& c, int axle) {
  const SuspensionSpec& suspension = c.vehicle.suspension[static_cast<std::size_t>(axle)];
  const Vec3<double> wheel = calc_wheel_reference(c.vehicle, c.maneuver.gravity, 2 * axle);
  const auto place = [&](const Vec3<double>& p) {
    return make_point(wheel.x + p.x, wheel.z + p.z);
  };
  const MountSpec &upper = suspension.spring_upper, &lower = suspension.spring_lower;
  const Json damper{{"upper", make_point(suspension.damper_upper.position)},
                    {"lower", make_point(suspension.damper_lower.position)},
                    {"share", calc_share(suspension, suspension.damper_lower)}};
  return Json{{"wheel", make_point(wheel.x, wheel.z)},
              {"upper", place(upper.position)},
              {"lower", place(lower.position)},
              {"spring_y", make_point(upper.position.y, lower.position.y)},
              {"half_track", suspension.wheel_center_y},
              {"links", make_links(suspension)},
              {"damper", damper}};
}

/// The points of the bumps under one track, by world x.
Json make_bump_points(const Case& c) {
  Json points = Json::array();
  const RoadSpec& road = c.maneuver.road;
  for (int i = 0; i < road.count; ++i) {
    for (const auto& [x, z] : list_profile(road)) {
      points.push_back(make_point(calc_bump_center(c) + x + i * road.spacing, z));
    }
  }
  return points;
}

/// Height of the profile `ahead` [m] of the front wheels at the start.
double get_profile_height(const RoadProfile& profile, std::size_t side, double ahead) {
  const std::vector<double>& heights = profile.height[side];
  const double place = (ahead - profile.begin) / profile.spacing;
  if (!(place >= 0.0) || place >= static_cast<double>(heights.size() - 1)) return 0.0;
  const auto i = static_cast<std::size_t>(place);
  return std::lerp(heights[i], heights[i + 1], place - static_cast<double>(i));
}

/// The points of a rough road, and of its bumps, as far as the car drives, to 0.1 mm.
Json make_rough_points(const Case& c, const LaneResults& results, std::size_t side, bool has_bump) {
  const RoadProfile& profile = *c.maneuver.profile.data;
  const double front = c.vehicle.whole.centroid_to_front;
  const std::vector<double> forward = results.get_history(CarChannel::kForwardPosition);
  const double last = *std::max_element(forward.begin(), forward.end()) + kSeen;
  const double end =
      profile.begin + profile.spacing * static_cast<double>(profile.height[side].size());
  std::map<double, double> heights;  // by world x
  const Json bumps = has_bump ? make_bump_points(c) : Json::array();
  const std::size_t per_bump = bumps.size() / static_cast<std::size_t>(c.maneuver.road.count);
  const auto is_on_bumps = [&](double x) {
    for (std::size_t i = 0; i < bumps.size(); i += per_bump) {
      const auto bump_begin = bumps[i][0].get<double>();
      const auto bump_end = bumps[i + per_bump - 1][0].get<double>();
      if (bump_begin <= x && x <= bump_end) return true;
    }
    return false;
  };
  for (double x = front + profile.begin; x < std::min(front + end, last); x += kProfileSpacing) {
    if (!is_on_bumps(x)) heights[x] = get_profile_height(profile, side, x - front);
  }
  for (const Json& point : bumps) {
    const auto x = point[0].get<double>();
    heights[x] = point[1].get<double>() + get_profile_height(profile, side, x - front);
  }
  Json points = Json::array();
  for (const auto& [x, z] : heights) {
    points.push_back(make_point(1e-3 * std::round(1e3 * x), 1e-4 * std::round(1e4 * z)));
  }
  return points;
}

/// The road under the left and the right wheels.
Json make_road(const Case& c, const LaneResults& results) {
  Json tracks = Json::array();
  for (std::size_t side = 0; side < 2; ++side) {
    const BumpSide other = side == 0 ? BumpSide::kRight : BumpSide::kLeft;
    const bool has_bump = c.maneuver.road.side != other;
    if (c.maneuver.profile.data) {
      tracks.push_back(make_rough_points(c, results, side, has_bump));
    } else {
      tracks.push_back(has_bump ? make_bump_points(c) : Json::array());
    }
  }
  return tracks;
}

/// The values of another run at these times, by lines between its samples; null outside of them.
Json resample(const OtherRun& other, const std::vector<double>& values,
              const std::vector<double>& times) {
  Json list = Json::array();
  std::size_t i = 1;
  for (const double t : times) {
    if (t < other.times.front() || t > other.times.back()) {
      list.push_back(nullptr);
      continue;
    }
    const double value = interpolate_line(other.times, values, t, i);
    list.push_back(std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr));
  }
  return list;
}

Json make_other(const OtherRun& other, const std::vector<double>& times) {
  Json json = Json::object();
  json["name"] = other.name;
  const auto add = [&](const char* name, int channel) {
    const std::vector<double>* values = other.find(channel);
    if (values != nullptr) json[name] = resample(other, *values, times);
  };
  add("forward", CarChannel::kForwardPosition);
  add("height", CarChannel::kBodyPositionZ);
  add("pitch", CarChannel::kPitchAngle);
  add("roll", CarChannel::kRollAngle);
  Json wheels = Json::array();
  for (int corner = 0; corner < kCorners; ++corner) {
    const std::vector<double>* height =
        other.find(CarChannel::get_corner_channel(corner, CarChannel::kWheelPositionZ));
    wheels.push_back(height == nullptr ? Json() : resample(other, *height, times));
  }
  json["wheel_height"] = wheels;
  return json;
}

constexpr int kOtherColor = 5;

/// The channels of another run that are drawn or judged.
std::vector<int> list_other_channels() {
  std::vector<int> channels = list_ride_channels();
  channels.insert(channels.end(), {CarChannel::kForwardPosition, CarChannel::kBodyPositionZ,
                                   CarChannel::kPitchAngle, CarChannel::kRollAngle});
  for (int corner = 0; corner < kCorners; ++corner) {
    channels.push_back(CarChannel::get_corner_channel(corner, CarChannel::kWheelPositionZ));
    channels.push_back(CarChannel::get_corner_channel(corner, CarChannel::kDamperForce));
  }
  return channels;
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

const std::vector<double>* OtherRun::find(int channel) const {
  const auto found = channels.find(channel);
  return found == channels.end() ? nullptr : &found->second;
}

std::optional<double> OtherRun::find_rate() const {
  constexpr double kTolerance = 1e-3;  // of an interval
  const double interval = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (std::fabs(times[i] - times[i - 1] - interval) > kTolerance * interval) return {};
  }
  return 1.0 / interval;
}

OtherRun read_other_run(const std::filesystem::path& file) {
  const std::vector<ChannelInfo>& channels = list_car_channels();
  const auto describe = [&](int channel) {
    const ChannelInfo& info = channels[static_cast<std::size_t>(channel)];
    return ColumnInfo{info.name, info.unit, info.description};
  };
  std::vector<ColumnInfo> optional;
  for (const int channel : list_other_channels()) optional.push_back(describe(channel));
  const ColumnInfo time = describe(CarChannel::kTime);
  const Measurement run = read_channels(file, MeasuredPart::kHistory, {time}, optional, {});
  OtherRun other{file.filename().string(), run.values(time.name)};
  for (const int channel : list_other_channels()) {
    const CsvColumn* column = run.find(describe(channel).name);
    if (column != nullptr) other.channels[channel] = column->values;
  }
  if (other.find(CarChannel::kBodyPositionZ) == nullptr &&
      other.find(CarChannel::kBodyAccelerationZ) == nullptr) {
    throw InputError(fmt::format("{}: has neither {} nor {}; must have one of them to be drawn",
                                 file.string(), describe(CarChannel::kBodyPositionZ).name,
                                 describe(CarChannel::kBodyAccelerationZ).name));
  }
  if (other.times.size() < 2) {
    throw InputError(
        fmt::format("{}: {} sample; must have at least 2", file.string(), other.times.size()));
  }
  for (std::size_t i = 1; i < other.times.size(); ++i) {
    if (other.times[i] > other.times[i - 1]) continue;
    throw InputError(fmt::format("{}: time does not ascend", run.locate(i)));
  }
  return other;
}

Json make_motion(const Case& c, const LaneResults& results, const std::optional<OtherRun>& other) {
  const std::vector<std::size_t> frames = list_frames(c, results);
  const auto add = [&](Json& json, const char* name, int channel) {
    json[name] = make_values(results.get_history(channel), frames);
  };
  Json json = Json::object();
  add(json, "time", CarChannel::kTime);
  add(json, "forward", CarChannel::kForwardPosition);
  add(json, "height", CarChannel::kBodyPositionZ);
  add(json, "pitch", CarChannel::kPitchAngle);
  add(json, "roll", CarChannel::kRollAngle);
  json["wheel_height"] = make_corners(results, CarChannel::kWheelPositionZ, frames);
  json["deflection"] = make_corners(results, CarChannel::kSuspensionDeflection, frames);
  json["wheel_speed"] = make_corners(results, CarChannel::kWheelSpeed, frames);
  json["front"] = make_axle(c, kFront);
  json["rear"] = make_axle(c, kRear);
  json["radius"] = c.vehicle.tire.unloaded_radius;
  json["nominal_height"] = c.vehicle.whole.centroid_height;
  json["road"] = make_road(c, results);
  if (other) {
    std::vector<double> times;
    const std::vector<double> all = results.get_history(CarChannel::kTime);
    times.reserve(frames.size());
    for (const std::size_t frame : frames) times.push_back(all[frame]);
    json["other"] = make_other(*other, times);
  }
  json["snapshot_time"] = results.has_snapshot() ? Json(results.get_event_time()) : Json();
  return json;
}

Chart make_motion_curves(const LaneResults& results, const std::optional<OtherRun>& other) {
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
      "marks the instant of the slider; click a curve to move it there.";
  const std::vector<double> time = results.get_history(CarChannel::kTime);
  for (const CurvePanel& curves : kPanels) {
    ChartPanel panel{{&curves == &kPanels.back() ? "time [s]" : ""}, {curves.label}, {}};
    const auto add = [&](const std::string& name, SeriesKind kind, int color, int channel) {
      panel.series.push_back(make_curve(name, kind, color, time, results.get_history(channel)));
    };
    // The other run's are drawn first, below.
    const auto add_other = [&](const std::string& name, SeriesKind kind, int channel) {
      const std::vector<double>* values = other ? other->find(channel) : nullptr;
      if (values == nullptr) return;
      panel.series.push_back(
          make_curve(other->name + name, kind, kOtherColor, other->times, *values));
    };
    if (curves.channel >= 0) {
      add_other("", SeriesKind::kLine, curves.channel);
      add("body", SeriesKind::kLine, kInk, curves.channel);
    }
    for (int corner = 0; curves.channel < 0 && corner < kCorners; ++corner) {
      add_other(std::string(", ") + kNames[static_cast<std::size_t>(corner)],
                is_right(corner) ? SeriesKind::kLine : SeriesKind::kDashedLine,
                CarChannel::get_corner_channel(corner, curves.corner));
    }
    for (int corner = 0; curves.channel < 0 && corner < kCorners; ++corner) {
      add(kNames[static_cast<std::size_t>(corner)],
          is_right(corner) ? SeriesKind::kLine : SeriesKind::kDashedLine, 1 + axle_of(corner),
          CarChannel::get_corner_channel(corner, curves.corner));
    }
    panel.about = fmt::format("{} over time [s]", curves.label);
    chart.panels.push_back(std::move(panel));
  }
  return chart;
}

}  // namespace strut
