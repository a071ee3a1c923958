#include "model_files/read_vehicle.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/range.h"
#include "io/format/toml_document.h"
#include "model/model.h"
#include "model_files/choices.h"
#include "model_files/file_kind.h"
#include "model_files/parameters.h"
#include "model_files/read_effects.h"
#include "model_files/read_fitted.h"
#include "model_files/read_force_curve.h"
#include "model_files/read_force_maps.h"
#include "model_files/read_tire.h"

namespace strut {

namespace {

/// Every valid `type` of a vehicle file; programs look for rigs first (read_rig.h).
std::vector<std::string> list_types() {
  std::vector<std::string> types;
  for (const ModelInfo* model : list_models()) types.push_back(model->name);
  return types;
}
constexpr std::size_t kMultilinkRods = 5;

const Range kPlace = between(-5.0, 5.0, "m");
const Range kPartMass = between(0.0, 500.0, "kg");
const Range kPartInertia = between(0.0, 1000.0, "kg m^2");
/// Minimum distance of the two joints of a rod, arm or strut [m].
constexpr double kMinLinkLength = 0.01;

double read_parameter(const Table& table, const std::string& key, const std::string& parameter) {
  return table.number(key, find_parameter(parameter).allowed);
}

Vec3<double> read_point(const Table& table, const std::string& key) {
  const auto p = table.vector(key, kPlace);
  return {p[0], p[1], p[2]};
}

/// Whether a rigid body can have the inertia J: no principal moment exceeds the sum of the others,
/// so the second moment of mass tr(J)/2 I - J is positive semidefinite.
bool is_inertia_of_body(const Sym3<double>& j) {
  const double trace = j.xx + j.yy + j.zz;
  const double a = 0.5 * trace - j.xx, b = 0.5 * trace - j.yy, c = 0.5 * trace - j.zz;
  const double ab = a * b - j.xy * j.xy, ac = a * c - j.xz * j.xz, bc = b * c - j.yz * j.yz;
  const double det =
      a * (b * c - j.yz * j.yz) - j.xy * (j.xy * c + j.yz * j.xz) - j.xz * (j.xy * j.yz + b * j.xz);
  const double slack = 1e-9 * trace;  // decimal rounding of flat and slender bodies
  return trace > 0.0 && a >= -slack && b >= -slack && c >= -slack && ab >= -slack * trace &&
         ac >= -slack * trace && bc >= -slack * trace && det >= -slack * trace * trace;
}

/// Keys: `inertia` [xx, yy, zz] and `inertia_products` [xy, xz, yz] of the same matrix.
Sym3<double> read_inertia(const Table& table, const Range& range) {
  const auto d = table.vector("inertia", range);
  const auto p = table.vector_or("inertia_products", {0.0, 0.0, 0.0});
  const Sym3<double> inertia{d[0], d[1], d[2], p[0], p[1], p[2]};
  if (is_inertia_of_body(inertia)) return inertia;
  throw table.error("inertia",
                    "impossible for a body: each principal moment must be at most the sum of the "
                    "others");
}

BodySpec read_body(const Table& table) {
  BodySpec body;
  body.mass = table.number("mass", above(0.0, "kg"));
  if (!kPartMass.contains(body.mass)) throw table.error("mass", kPartMass.describe());
  body.center_of_mass = read_point(table, "center_of_mass");
  body.inertia = read_inertia(table, kPartInertia);
  return body;
}

void check_apart(const Table& table, const std::string& key, const Vec3<double>& a,
                 const Vec3<double>& b, const std::string& other) {
  if (norm(a - b) >= kMinLinkLength) return;
  throw table.error(
      key, fmt::format("must be at least {} m from {}", format_number(kMinLinkLength), other));
}

RodSpec read_rod(const Table& table) {
  RodSpec rod;
  rod.chassis = read_point(table, "chassis");
  rod.upright = read_point(table, "upright");
  check_apart(table, "upright", rod.upright, rod.chassis, "chassis");
  rod.mass = table.number("mass", kPartMass);
  rod.center_fraction = table.number_or("center_fraction", rod.center_fraction, between(0.0, 1.0));
  if (table.has("transverse_inertia")) {
    rod.transverse_inertia = table.number("transverse_inertia", kPartInertia);
  }
  return rod;
}

void read_macpherson(const Table& table, SuspensionSpec& suspension) {
  suspension.arm_front = read_point(table, "lower_arm_front");
  suspension.arm_rear = read_point(table, "lower_arm_rear");
  suspension.ball_joint = read_point(table, "ball_joint");
  suspension.strut_top = read_point(table, "strut_top");
  suspension.strut_bottom = read_point(table, "strut_bottom");
  check_apart(table, "lower_arm_rear", suspension.arm_rear, suspension.arm_front,
              "lower_arm_front");
  check_apart(table, "ball_joint", suspension.ball_joint, suspension.arm_front, "lower_arm_front");
  check_apart(table, "strut_bottom", suspension.strut_bottom, suspension.strut_top, "strut_top");
  suspension.rods = {read_rod(table.table("tie_rod"))};
  suspension.lower_arm = read_body(table.table("lower_arm"));
  if (const auto strut_rod = table.find_table("strut_rod")) {
    suspension.strut_rod = read_body(*strut_rod);
  }
}

/// Returns the names of the rods.
std::vector<std::string> read_multilink(const Table& table, SuspensionSpec& suspension) {
  const std::vector<Table> rods = table.tables("rod");
  if (rods.size() != kMultilinkRods) {
    throw table.error(
        fmt::format("{} rods: a multilink must have {}", rods.size(), kMultilinkRods));
  }
  std::vector<std::string> names;
  for (const Table& rod : rods) {
    const std::string name = rod.text("name");
    for (const std::string& other : names) {
      if (name == other) throw rod.error("name", "must differ from the other rods' names");
    }
    names.push_back(name);
    suspension.rods.push_back(read_rod(rod));
  }
  return names;
}

/// Keys: `<end>`, a point, and `<end>_on`, the part to which it is fixed.
MountSpec read_mount(const Table& table, const std::string& end, const SuspensionSpec& suspension,
                     const std::vector<std::string>& rod_names) {
  std::vector<std::string> parts = {"chassis", "upright"};
  std::vector<MountBody> bodies = {MountBody::kChassis, MountBody::kUpright};
  if (suspension.kind == SuspensionKind::kMacPherson) {
    parts.push_back("lower_arm");
    bodies.push_back(MountBody::kLowerArm);
  }
  const auto fixed_parts = static_cast<int>(parts.size());
  parts.insert(parts.end(), rod_names.begin(), rod_names.end());
  const int part = table.choice(end + "_on", parts);
  MountSpec mount;
  mount.body = part < fixed_parts ? bodies[static_cast<std::size_t>(part)] : MountBody::kRod;
  mount.rod = part < fixed_parts ? 0 : part - fixed_parts;
  mount.position = read_point(table, end);
  return mount;
}

/// Reads `KEY_left` and `KEY_right`, each of which replaces the number `both` of an axle's struts.
std::array<double, 2> read_sides(const Table& table, const std::string& key, double both,
                                 const std::string& parameter) {
  const Range& allowed = find_parameter(parameter).allowed;
  return {table.number_or(key + "_left", both, allowed),
          table.number_or(key + "_right", both, allowed)};
}

void read_springs(const Table& spring, const std::string& axle, SuspensionSpec& suspension) {
  const std::string parameter = axle + "_stiffness";
  const std::array<double, 2> stiffness =
      read_sides(spring, "stiffness", read_parameter(spring, "stiffness", parameter), parameter);
  for (std::size_t side = 0; side < stiffness.size(); ++side) {
    StrutSpec& strut = suspension.strut[side];
    strut.stiffness = stiffness[side];
    strut.nominal_stiffness =
        spring.number_or("nominal_stiffness", stiffness[side], find_parameter(parameter).allowed);
  }
}

void read_dampers(const Table& damper, const std::string& axle, SuspensionSpec& suspension) {
  const std::string parameter = axle + "_damping";
  suspension.damper_curve = read_damper_curve(damper, "curve", "damping");
  const double rate = suspension.damper_curve.empty() ? read_parameter(damper, "damping", parameter)
                                                      : calc_curve_rate(suspension.damper_curve);
  const Range& allowed = find_parameter(parameter).allowed;
  if (!allowed.contains(rate)) {
    throw damper.error("curve", fmt::format("has a rate of {} N s/m: {}", format_rounded(rate),
                                            allowed.describe()));
  }
  const std::array<double, 2> damping = read_sides(damper, "damping", rate, parameter);
  for (std::size_t side = 0; side < damping.size(); ++side) {
    suspension.strut[side].damping = damping[side];
  }
}

void read_lines(const Table& table, const std::string& axle,
                const std::vector<std::string>& rod_names, SuspensionSpec& suspension) {
  const Table spring = table.table("spring"), damper = table.table("damper");
  read_springs(spring, axle, suspension);
  read_dampers(damper, axle, suspension);
  suspension.spring_upper = read_mount(spring, "upper", suspension, rod_names);
  suspension.spring_lower = read_mount(spring, "lower", suspension, rod_names);
  suspension.damper_upper = read_mount(damper, "upper", suspension, rod_names);
  suspension.damper_lower = read_mount(damper, "lower", suspension, rod_names);
  check_apart(spring, "lower", suspension.spring_lower.position, suspension.spring_upper.position,
              "upper");
  check_apart(damper, "lower", suspension.damper_lower.position, suspension.damper_upper.position,
              "upper");
}

void read_wheel(const Table& table, const std::string& axle, SuspensionSpec& suspension) {
  const Table wheel = table.table("wheel");
  suspension.wheel_center_y = read_parameter(wheel, "half_track", axle + "_half_track");
  suspension.wheel_mass = read_parameter(wheel, "mass", axle + "_wheel_mass");
  suspension.wheel_spin_inertia =
      read_parameter(wheel, "spin_inertia", axle + "_wheel_spin_inertia");
  suspension.wheel_transverse_inertia =
      read_parameter(wheel, "transverse_inertia", axle + "_wheel_transverse_inertia");
  const Range angle = find_parameter(axle + "_static_toe").allowed;
  suspension.static_toe = wheel.number_or("static_toe", 0.0, angle);
  suspension.static_camber = wheel.number_or("static_camber", 0.0, angle);
  if (suspension.wheel_spin_inertia <= 2.0 * suspension.wheel_transverse_inertia) return;
  throw wheel.error("spin_inertia",
                    "impossible for a body: must be at most twice transverse_inertia");
}

SuspensionSpec read_suspension(const Table& table, const std::string& axle) {
  SuspensionSpec suspension;
  suspension.kind = static_cast<SuspensionKind>(table.choice("kind", list_names(kSuspensions)));
  std::vector<std::string> rod_names = {"tie_rod"};
  if (suspension.kind == SuspensionKind::kMacPherson) {
    read_macpherson(table, suspension);
  } else {
    rod_names = read_multilink(table, suspension);
  }
  suspension.upright = read_body(table.table("upright"));
  read_wheel(table, axle, suspension);
  read_lines(table, axle, rod_names, suspension);
  return suspension;
}

WholeCarSpec read_whole_car(const Table& table) {
  WholeCarSpec whole;
  whole.mass = read_parameter(table, "mass", "mass");
  whole.centroid_to_front = read_parameter(table, "centroid_to_front", "centroid_to_front");
  whole.centroid_to_rear = read_parameter(table, "centroid_to_rear", "centroid_to_rear");
  whole.centroid_height = read_parameter(table, "centroid_height", "centroid_height");
  whole.inertia = read_inertia(table, find_parameter("pitch_inertia").allowed);
  return whole;
}

void read_tire_contact(const Table& table, VehicleSpec& vehicle) {
  const TireData data = read_tire(table.file("file"));
  const auto read_or = [&](const char* key, double fallback, const char* parameter) {
    return table.number_or(key, fallback, find_parameter(parameter).allowed);
  };
  TireContactSpec& tire = vehicle.tire;
  vehicle.pacejka = data.pacejka;
  tire.unloaded_radius = read_or("unloaded_radius", data.unloaded_radius, "tire_radius");
  vehicle.pacejka.UNLOADED_RADIUS = tire.unloaded_radius;
  tire.curve = read_tire_curve(table, "curve", "stiffness");
  if (tire.curve.empty()) tire.curve = data.vertical_curve;
  const double rate = tire.curve.empty() ? data.vertical_stiffness : calc_curve_rate(tire.curve);
  const Range& allowed = find_parameter("tire_stiffness").allowed;
  if (!allowed.contains(rate)) {
    throw table.error(
        table.has("curve") ? "curve" : "file",
        fmt::format("tire_stiffness would be {}: {}", format_number(rate), allowed.describe()));
  }
  tire.stiffness = read_or("stiffness", rate, "tire_stiffness");
  tire.damping = read_or("damping", data.vertical_damping, "tire_damping");
  tire.footprint = read_or("footprint", tire.footprint, "footprint");
  tire.contact = static_cast<ContactKind>(table.choice_or("contact", 0, list_names(kContacts)));
  tire.relaxation = table.boolean_or("relaxation", tire.relaxation);
}

void read_options(const Table& root, VehicleSpec& vehicle) {
  if (const auto spring = root.find_table("spring")) {
    vehicle.preload = static_cast<PreloadKind>(spring->choice_or("preload", 0, list_preloads()));
  }
  if (const auto imu = root.find_table("imu")) vehicle.imu_position = read_point(*imu, "position");
  if (const auto steering = root.find_table("steering")) {
    vehicle.rack_position = read_parameter(*steering, "rack_position", "rack_position");
  }
  const auto drive = root.find_table("drive");
  const double front = drive ? read_parameter(*drive, "front_share", "front_drive_share") : 1.0;
  vehicle.suspension[kFront].drive_share = front;
  vehicle.suspension[kRear].drive_share = 1.0 - front;
}

}  // namespace

const std::vector<std::string>& list_preloads() {
  static const std::vector<std::string> names = list_names(kPreloads);
  return names;
}

VehicleSpec read_vehicle(const std::filesystem::path& path) {
  const Document document(path);
  const Table root = open_root(document, kModelFile);
  if (root.choice("type", list_types()) != 0) {
    throw InputError(
        fmt::format("{}: type: a rig; allowed here: {}", path.string(), get_car_info().name));
  }
  VehicleSpec vehicle;
  vehicle.name = root.text_or("name", path.stem().string());
  vehicle.whole = read_whole_car(root.table("whole_car"));
  for (std::size_t axle = 0; axle < kAxles; ++axle) {
    vehicle.suspension[axle] = read_suspension(
        root.table(std::string(kAxleNames[axle]) + "_suspension"), kAxleNames[axle]);
  }
  read_tire_contact(root.table("tire"), vehicle);
  read_options(root, vehicle);
  read_fitted(root, vehicle);
  vehicle.effects = read_effects(root, get_car_info());
  vehicle.force_maps = read_force_maps(root, get_car_info());
  document.check_all_read();
  return vehicle;
}

}  // namespace strut
