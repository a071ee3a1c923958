#include <fmt/format.h>

#include "base/error/check.h"
#include "model/car/assemble_effects.h"
#include "model/car/car_info.h"
#include "model/kernel/mechanism.h"
#include "model/kernel/simulation.h"
#include "model/longest_step.h"
#include "model/sensor/sensors.h"

namespace strut {
namespace {

/// The parts of a case that determine its mechanism; all others are set to neutral values.
Case strip_to_mechanism(const Case& c) {
  Case key = apply_case_effects(c);
  key.vehicle.effects.clear();
  key.vehicle.force_maps.clear();
  for (SuspensionSpec& suspension : key.vehicle.suspension) suspension.strut.fill(StrutSpec{});
  key.vehicle.preload = PreloadKind::kFreeLength;
  const ManeuverSpec neutral;
  key.maneuver.speed = neutral.speed;
  key.maneuver.duration = neutral.duration;
  key.maneuver.drive_torque = neutral.drive_torque;
  key.maneuver.drive_reaction = neutral.drive_reaction;
  // A profile counts from the front wheels, its tracks from the bump.
  if (!key.maneuver.profile.data) key.maneuver.bump_distance = neutral.bump_distance;
  key.maneuver.trim = neutral.trim;
  key.maneuver.lead_time = neutral.lead_time;
  key.maneuver.lead_speed = neutral.lead_speed;
  key.maneuver.rough = neutral.rough;
  return key;
}

bool has_equal_tires(const Mechanism& other, const Case& key) {
  const auto &a = other.vehicle.tire, &b = key.vehicle.tire;
  return a.contact == b.contact && a.unloaded_radius == b.unloaded_radius &&
         a.footprint == b.footprint;
}

bool shares_surface(const Mechanism& other, const Case& key) {
  return other.maneuver.road == key.maneuver.road && has_equal_tires(other, key);
}

bool shares_tracks(const Mechanism& other, const Case& key) {
  return other.maneuver.profile == key.maneuver.profile &&
         other.maneuver.bump_distance == key.maneuver.bump_distance && has_equal_tires(other, key);
}

/// `other`: a mechanism whose parts are reused where they are equal, or null.
std::shared_ptr<const Mechanism> make_mechanism(const Case& c, const Case& key,
                                                const Mechanism* other) {
  auto mechanism = std::make_shared<Mechanism>();
  mechanism->vehicle = key.vehicle;
  mechanism->maneuver = key.maneuver;
  mechanism->car = assemble_vehicle(c.vehicle, c.maneuver);
  const bool has_tables = other && have_equal_tables(*other, *mechanism);
  mechanism->tables = has_tables ? other->tables : tabulate_corners(mechanism->car);
  mechanism->surface =
      other && shares_surface(*other, key) ? other->surface : make_surface(c.vehicle, c.maneuver);
  if (const RoadProfile* profile = key.maneuver.profile.data.get()) {
    mechanism->rough =
        other && shares_tracks(*other, key)
            ? other->rough
            : follow_profile(*profile, make_contact(c.vehicle), key.maneuver.bump_distance);
  }
  return mechanism;
}

/// Throws ModelError for a spring so soft that it sags beyond its corner's travel at rest.
void check_springs(const VehicleSpec& spec, const AssembledVehicle& car) {
  for (int c = 0; c < kCorners; ++c) {
    const StrutSpec& strut = spec.suspension[axle_of(c)].strut[is_right(c) ? 1 : 0];
    if (spec.preload == PreloadKind::kTrimmed || strut.nominal_stiffness <= 0.0) continue;
    const double load = car.preload[c];
    const double minimum = load / (load / strut.nominal_stiffness + kHalfTravel);
    if (strut.stiffness >= minimum) continue;
    throw ModelError(
        fmt::format("{}.spring.stiffness = {:g} N/m: cannot carry the car, whose weight needs {:g} "
                    "N there; allowed: at least {:g} N/m",
                    get_axle_key(axle_of(c)), strut.stiffness, load, minimum));
  }
}

/// Finds the start by KINSOL. Throws ModelError where there is none.
void find_start_alone(PreparedCase& c) {
  Vehicle<double> vehicle = c.vehicle;
  vehicle.layout.on_bump.fill(false);
  vehicle.road = Road<double>{};
  if (!c.starts_driven) vehicle.numbers.drive_torque.fill(0.0);
  const Mechanism& mechanism = *c.mechanism;
  c.start =
      solve_rolling(vehicle, mechanism.tables, mechanism.car.center_height, c.start_speed).state;
}

}  // namespace

bool shares_mechanism(const Case& a, const Case& b) {
  const Case x = strip_to_mechanism(a), y = strip_to_mechanism(b);
  return x.vehicle == y.vehicle && x.maneuver == y.maneuver;
}

PreparedCase CasePreparer::prepare(const Case& c, double snapshot_offset) {
  PreparedCase prepared = assemble(c, snapshot_offset);
  find_start(prepared);
  return prepared;
}

PreparedCase CasePreparer::assemble(const Case& given, double snapshot_offset) {
  validate(given.vehicle.effects, get_car_info());
  validate(given.vehicle.force_maps, get_car_info());
  const Case c = apply_case_effects(given);
  const Case key = strip_to_mechanism(c);
  if (!mechanism_ || !(mechanism_->vehicle == key.vehicle) ||
      !(mechanism_->maneuver == key.maneuver)) {
    mechanism_ = make_mechanism(c, key, mechanism_.get());
  }
  const AssembledVehicle& car = mechanism_->car;
  const Road<double> flat_road{};
  PreparedCase prepared{mechanism_, {car.layout, car.numbers, car.pacejka, {}, flat_road}, {}};
  Vehicle<double>& vehicle = prepared.vehicle;
  set_operating_parameters(c.vehicle, c.maneuver, car, vehicle.numbers);
  set_effects(c.vehicle, vehicle.layout, vehicle.numbers);
  prepared.force_maps = make_corner_force_maps(c.vehicle.force_maps);
  const CornerForceMaps* const maps[] = {&prepared.force_maps};
  fill_strut_elements(vehicle, maps);
  prepared.bump_center = calc_bump_center(car, c.maneuver);
  const RoadSpec& road = c.maneuver.road;
  prepared.trigger_x = prepared.bump_center + (road.count - 1) * road.spacing + snapshot_offset;
  prepared.duration = c.maneuver.duration;
  prepared.longest_step = calc_longest_step(c.vehicle, vehicle.numbers.effects);
  prepared.sensors = list_sensor_settings(c.vehicle.effects);

  check_springs(c.vehicle, car);
  prepared.start.fill(std::numeric_limits<double>::quiet_NaN());
  prepared.start_speed = c.maneuver.speed + c.maneuver.lead_speed;
  prepared.starts_driven = c.maneuver.trim != TrimKind::kStatic;
  const Surface* surface = &mechanism_->surface;
  vehicle.road = make_road<double>(&surface, &prepared.bump_center);
  STRUT_CHECK(!c.maneuver.profile.data || c.maneuver.rough == ManeuverSpec{}.rough,
              "a road has a profile or tracks, not both");
  prepared.rough = c.maneuver.profile.data ? mechanism_->rough : c.maneuver.rough;
  for (std::size_t side = 0; side < 2; ++side) {
    const RoughTrack* track = &prepared.rough[side];
    vehicle.road.rough[side] = make_rough_tracks<double>(&track);
  }
  return prepared;
}

void find_start(PreparedCase& c) {
  PreparedCase* const cases[] = {&c};
  if (list_kernels().front().find_starts(cases, 1) == 0) find_start_alone(c);
}

std::vector<std::string> find_starts(const Kernel& kernel, const std::vector<PreparedCase*>& cases,
                                     StartMethod method) {
  const auto width = static_cast<std::size_t>(method == StartMethod::kLanes ? kernel.lanes : 1);
  IntegrateOptions options;
  options.closure = Closure::kTable;
  std::vector<std::string> reasons(cases.size());
  for (std::size_t begin = 0, count = 0; begin < cases.size(); begin += count) {
    count = 1;
    while (count < width && begin + count < cases.size() &&
           may_share_lanes(*cases[begin], *cases[begin + count], options)) {
      ++count;
    }
    unsigned found = 0;
    if (method == StartMethod::kLanes) {
      found = kernel.find_starts(cases.data() + begin, static_cast<int>(count));
    }
    for (std::size_t i = begin; i < begin + count; ++i, found >>= 1U) {
      if ((found & 1U) != 0) continue;
      try {
        find_start_alone(*cases[i]);
      } catch (const ModelError& e) {
        reasons[i] = e.what();
      }
    }
  }
  return reasons;
}

bool may_share_lanes(const PreparedCase& a, const PreparedCase& b,
                     const IntegrateOptions& options) {
  if (options.symmetry && is_symmetric(a) != is_symmetric(b)) return false;
  if (a.mechanism == b.mechanism) return true;
  const VehicleSpec &va = a.mechanism->vehicle, &vb = b.mechanism->vehicle;
  const bool same_layout =
      va.tire.contact == vb.tire.contact && va.tire.relaxation == vb.tire.relaxation &&
      va.tire.curve == vb.tire.curve && a.vehicle.layout.on_bump == b.vehicle.layout.on_bump &&
      va.suspension[kFront].damper_curve == vb.suspension[kFront].damper_curve &&
      va.suspension[kRear].damper_curve == vb.suspension[kRear].damper_curve &&
      va.suspension[kFront].kind == vb.suspension[kFront].kind &&
      va.suspension[kRear].kind == vb.suspension[kRear].kind;
  // Lanes eliminate the loops of a corner in one order.
  return same_layout &&
         (options.closure == Closure::kTable || a.vehicle.layout.corner == b.vehicle.layout.corner);
}

}  // namespace strut
