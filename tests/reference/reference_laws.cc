#include "tests/reference/reference_laws.h"

#include <memory>

namespace strut::reference {
namespace {

bool meets_bump(int corner, BumpSide side) {
  return side == BumpSide::kBoth || is_right(corner) == (side == BumpSide::kRight);
}

}  // namespace

ReferenceLaws make_flat_road_laws(const VehicleSpec& spec) {
  ReferenceLaws laws;
  const Pac2002<double> tire = spec.pacejka;
  const double radius = spec.tire.unloaded_radius, stiffness = spec.tire.stiffness;
  laws.tire_force = [tire](int corner, const TireSlip<double>& slip) {
    return calc_tire_force(tire, slip, is_right(corner) ? -1.0 : 1.0);
  };
  laws.rolling_radius = [tire, radius, stiffness](double deflection) {
    return calc_rolling_radius(tire, radius, deflection, stiffness);
  };
  laws.ground = [](int, double) { return RoadPoint<double>{0.0, 0.0}; };
  laws.kinks = [](int) { return std::vector<double>{}; };
  return laws;
}

ReferenceLaws make_bump_laws(const VehicleSpec& spec, const ManeuverSpec& maneuver,
                             double bump_center) {
  ReferenceLaws laws = make_flat_road_laws(spec);
  const ContactGeometry contact{spec.tire.contact, spec.tire.unloaded_radius, spec.tire.footprint};
  const Surface surface = make_surface(maneuver.road, contact);
  const Surface* surfaces[] = {&surface};
  const double centers[] = {bump_center};
  const auto road = std::make_shared<const Road<double>>(make_road<double>(surfaces, centers));
  const BumpSide side = maneuver.road.side;
  laws.ground = [road, side](int corner, double x) {
    if (!meets_bump(corner, side)) return RoadPoint<double>{0.0, 0.0};
    return calc_road_point(*road, x, find_segment(*road, x));
  };
  std::vector<double> kinks;
  for (std::size_t i = 0; i + 1 < surface.segments.size(); ++i) {
    kinks.push_back(bump_center + surface.segments[i].end);
  }
  laws.kinks = [kinks, side](int corner) {
    return meets_bump(corner, side) ? kinks : std::vector<double>{};
  };
  return laws;
}

}  // namespace strut::reference
