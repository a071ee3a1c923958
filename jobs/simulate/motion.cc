#include "jobs/simulate/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "sweep/simulate_case.h"

namespace strut {
namespace {

constexpr std::size_t kMostFrames = 1200;
constexpr std::size_t kRoadPoints = 201;

std::size_t calc_stride(const LaneResults& results) {
  return 1 + static_cast<std::size_t>(results.sample_count) / kMostFrames;
}

std::vector<double> thin_channel(const LaneResults& results, std::size_t channel) {
  const std::vector<double> all = get_history(results, CarChannel::kCount, channel);
  std::vector<double> kept;
  for (std::size_t i = 0; i < all.size(); i += calc_stride(results)) kept.push_back(all[i]);
  return kept;
}

std::size_t get_corner_channel(int corner, int channel) {
  const int first = CarChannel::kCornerBegin + corner * CarChannel::kCornerChannels;
  return static_cast<std::size_t>(first) + static_cast<std::size_t>(channel);
}

/// Five digits after the point of a meter are more than a screen shows.
Json make_numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    list.push(std::strtod(text, nullptr));
  }
  return list;
}

Json make_corners(const LaneResults& results, int channel) {
  Json list = Json::array();
  for (int corner = 0; corner < kCorners; ++corner) {
    list.push(make_numbers(thin_channel(results, get_corner_channel(corner, channel))));
  }
  return list;
}

Json make_point(double x, double z) {
  Json point = Json::array();
  point.push(x).push(z);
  return point;
}

/// Height of an axle's wheel centers at nominal trim: the free radius less what the car's weight
/// presses the tire in.
double calc_wheel_height(const Case& c, int axle) {
  const WholeCarSpec& whole = c.vehicle.whole;
  const double base = whole.centroid_to_front + whole.centroid_to_rear;
  const double other = axle == kFront ? whole.centroid_to_rear : whole.centroid_to_front;
  const double load = 0.5 * whole.mass * c.maneuver.gravity * other / base;
  return c.vehicle.tire.unloaded_radius - load / c.vehicle.tire.stiffness;
}

/// Wheel center and ends of the spring, from the body's reference point.
Json make_axle(const Case& c, int axle) {
  const WholeCarSpec& whole = c.vehicle.whole;
  const SuspensionSpec& suspension = c.vehicle.suspension[static_cast<std::size_t>(axle)];
  const double x = axle == kFront ? whole.centroid_to_front : -whole.centroid_to_rear;
  const double z = calc_wheel_height(c, axle) - whole.centroid_height;
  const auto place = [&](const Vec3<double>& p) { return make_point(x + p.x, z + p.z); };
  return Json::object()
      .set("wheel", make_point(x, z))
      .set("upper", place(suspension.spring_upper.position))
      .set("lower", place(suspension.spring_lower.position));
}

double calc_bump_center(const Case& c) {
  return c.vehicle.whole.centroid_to_front + c.maneuver.bump_distance;
}

Json make_road(const Case& c) {
  const RoadSpec& road = c.maneuver.road;
  if (road.shape == BumpShape::kNone) return Json::array();
  const double reach = road.shape == BumpShape::kTable
                           ? std::max(std::abs(road.table_x.front()), std::abs(road.table_x.back()))
                           : 0.5 * road.length;
  Json points = Json::array();
  for (std::size_t i = 0; i < kRoadPoints; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kRoadPoints - 1);
    const double x = reach * (2.0 * share - 1.0);
    points.push(make_point(calc_bump_center(c) + x, calc_profile_height(road, x)));
  }
  return points;
}

struct CurvePanel {
  const char* label;
  int channel;  // of the body; -1: `corner` of every corner
  int corner = 0;
};

}  // namespace

Json make_motion(const Case& c, const LaneResults& results) {
  const auto add = [&](Json& json, const char* name, std::size_t channel) {
    json.set(name, make_numbers(thin_channel(results, channel)));
  };
  Json json = Json::object();
  add(json, "time", CarChannel::kTime);
  add(json, "forward", CarChannel::kForwardPosition);
  add(json, "height", CarChannel::kBodyPositionZ);
  add(json, "pitch", CarChannel::kPitchAngle);
  json.set("wheel_height", make_corners(results, CarChannel::kWheelPositionZ))
      .set("deflection", make_corners(results, CarChannel::kSuspensionDeflection))
      .set("wheel_speed", make_corners(results, CarChannel::kWheelSpeed))
      .set("front", make_axle(c, kFront))
      .set("rear", make_axle(c, kRear))
      .set("radius", c.vehicle.tire.unloaded_radius)
      .set("nominal_height", c.vehicle.whole.centroid_height)
      .set("road", make_road(c))
      .set("snapshot_time", has_snapshot(results) ? Json(results.event_time[0]) : Json());
  return json;
}

Chart make_motion_curves(const LaneResults& results) {
  static constexpr std::array<CurvePanel, 6> kPanels = {
      {{"height [m]", CarChannel::kBodyPositionZ},
       {"pitch [rad]", CarChannel::kPitchAngle},
       {"acceleration [m/s^2]", CarChannel::kBodyAccelerationZ},
       {"deflection [m]", -1, CarChannel::kSuspensionDeflection},
       {"damper force [N]", -1, CarChannel::kDamperForce},
       {"tire load [N]", -1, CarChannel::kTireForceZ}}};
  static constexpr std::array<const char*, kCorners> kNames = {"front left", "front right",
                                                               "rear left", "rear right"};
  Chart chart{"curves", {}};
  chart.panel_height = 165;
  chart.width = 620;
  chart.shares_x = true;
  chart.caption = "Body, suspension and tires over time; the line stands at the slider's instant.";
  const std::vector<double> time = thin_channel(results, CarChannel::kTime);
  for (const CurvePanel& about : kPanels) {
    ChartPanel panel{{&about == &kPanels.back() ? "time [s]" : ""}, {about.label}, {}};
    if (about.channel >= 0) {
      panel.series.push_back({"body", SeriesKind::kLine, kInk, time,
                              thin_channel(results, static_cast<std::size_t>(about.channel))});
    }
    for (int corner = 0; about.channel < 0 && corner < kCorners; ++corner) {
      panel.series.push_back({kNames[static_cast<std::size_t>(corner)],
                              is_right(corner) ? SeriesKind::kDashedLine : SeriesKind::kLine,
                              1 + axle_of(corner), time,
                              thin_channel(results, get_corner_channel(corner, about.corner))});
    }
    chart.panels.push_back(std::move(panel));
  }
  return chart;
}

}  // namespace strut
