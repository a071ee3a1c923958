#include "tests/hidden/car.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "tests/hidden/dormand_prince.h"

namespace strut::hidden {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using S = CarState;

constexpr double kGravity = 9.81;
constexpr double kTwoPi = 6.28318530717958647692;
constexpr int kSeatEquation = 10;

Vector3d get_vector(const std::vector<double>& y, int at) {
  const auto i = static_cast<std::size_t>(at);
  return {y[i], y[i + 1], y[i + 2]};
}

std::size_t index(int place) { return static_cast<std::size_t>(place); }

double get(const std::vector<double>& y, int at) { return y[static_cast<std::size_t>(at)]; }

Matrix3d calc_rotation(const std::vector<double>& y) {
  const Eigen::Quaterniond q(get(y, S::kQuaternion), get(y, S::kQuaternion + 1),
                             get(y, S::kQuaternion + 2), get(y, S::kQuaternion + 3));
  return q.normalized().toRotationMatrix();
}

/// -m [r]x [r]x: inertia of a point mass at r.
Matrix3d calc_point_inertia(double mass, const Vector3d& r) {
  return mass * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
}

Matrix3d calc_cross(const Vector3d& r) {
  Matrix3d m;
  m << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
  return m;
}

double calc_slip_force(const SlipLaw& law, double slip) {
  const double b = law.stiffness / (law.shape * law.friction);
  return law.friction * std::sin(law.shape * std::atan(b * slip));
}

/// The damper of a tire comes in over the first 2 mm: 6 t^5 - 15 t^4 + 10 t^3.
double calc_touch(double deflection) {
  const double t = std::clamp(deflection / 2e-3, 0.0, 1.0);
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

/// Half the rate of the squared distance from a center at x, z to the road as the road's point
/// moves on.
double calc_recession(const Track& track, double x, double z, double point) {
  double height = 0.0, slope = 0.0;
  track.evaluate(point, height, slope);
  return point - x + (height - z) * slope;
}

}  // namespace

void Track::evaluate(double x, double& z, double& z_x) const {
  z = z_x = 0.0;
  double height = 0.0, slope = 0.0;
  if (bump != nullptr) bump->evaluate(x - bump_center, z, z_x);
  if (rough != nullptr) rough->evaluate(x, height, slope);
  z += height;
  z_x += slope;
}

Support Track::find_support(Contact contact, double x, double z, double radius) const {
  Support support;
  double height = 0.0, slope = 0.0;
  if (contact == Contact::kFelt) {
    evaluate(x, height, support.slope);
    const double cosine = 1.0 / std::hypot(1.0, support.slope);
    support.distance = radius - (radius - (z - height)) * cosine;
    return support;
  }
  // The nearest point, of all where the distance is least within its surroundings: on either side
  // of a bump's foot a wheel has two.
  constexpr int kCells = 64;
  const double cell = 2.0 * radius / kCells;
  support.distance = std::numeric_limits<double>::infinity();
  double low = x - radius, before = calc_recession(*this, x, z, low);
  for (int i = 1; i <= kCells; ++i) {
    double high = x - radius + cell * i;
    const double behind = calc_recession(*this, x, z, high);
    const double end = high;
    if (before < 0.0 && behind >= 0.0) {
      while (high - low > 1e-10) {
        const double middle = 0.5 * (low + high);
        (calc_recession(*this, x, z, middle) < 0.0 ? low : high) = middle;
      }
      evaluate(high, height, slope);
      const double distance = std::hypot(high - x, height - z);
      if (distance < support.distance) support = {distance, slope};
    }
    low = end;
    before = behind;
  }
  return support;
}

/// Forces and kinematics of one evaluation, vectors in body axes.
struct CarModel::Forces {
  Matrix3d rotation;
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();  // on the car, about the reference
  std::array<double, kWheels> up{}, spin_rate{}, strut{}, load{};
  std::array<Vector3d, kWheels> at;
  double seat = 0.0, bend = 0.0;
};

CarModel::CarModel(const Car& car) : car_(car) {
  Vector3d first = Vector3d::Zero();
  Matrix3d rest = Matrix3d::Zero();
  double wheels = 0.0;
  for (const Wheel& w : car.wheel) {
    wheels += w.mass;
    first += w.mass * w.position;
    rest += calc_point_inertia(w.mass, w.position);
    rest.diagonal() += Vector3d(w.transverse_inertia, w.spin_inertia, w.transverse_inertia);
  }
  body_mass_ = car.mass - wheels;
  body_center_ = -first / body_mass_;
  Matrix3d whole = car.inertia.asDiagonal();
  whole(1, 1) *= 1.0 + car.pitch_inertia;
  body_inertia_ = whole - rest - calc_point_inertia(body_mass_, body_center_);
  body_center_.x() += car.center_shift;
  bend_mass_ = 0.1 * car.mass;
  const double wheelbase = car.wheel[0].position.x() - car.wheel[2].position.x();
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double share = std::fabs(car.wheel[i ^ 2].position.x()) / wheelbase;
    static_load_[i] = 0.5 * share * car.mass * kGravity;
    static_strut_[i] = static_load_[i] - car.wheel[i].mass * kGravity;
    bend_shape_[i] = i < 2 ? 1.0 : 0.8;
  }
  if (car.passenger.of_the_body) {
    const double m = car.passenger.mass;
    const Vector3d moved =
        (body_mass_ * body_center_ - m * car.passenger.position) / (body_mass_ - m);
    body_inertia_ += calc_point_inertia(body_mass_, body_center_) -
                     calc_point_inertia(m, car.passenger.position) -
                     calc_point_inertia(body_mass_ - m, moved);
    body_mass_ -= m;
    body_center_ = moved;
  }
}

void CarModel::calc_tire(const Drive& drive, const std::vector<double>& y, int wheel,
                         Forces& f) const {
  const auto i = static_cast<std::size_t>(wheel);
  const Wheel& w = car_.wheel[i];
  const Vector3d velocity = get_vector(y, S::kVelocity), omega = get_vector(y, S::kRate);
  const Vector3d center = f.at[i], axis = Vector3d::UnitY();
  const Vector3d world = get_vector(y, S::kPosition) + f.rotation * center;
  const Support support =
      drive.track[i].find_support(drive.contact, world.x(), world.z(), w.tire.radius);
  const Vector3d up = Vector3d(-support.slope, 0.0, 1.0).normalized();
  const Vector3d normal = f.rotation.transpose() * up;
  const Vector3d motion =
      velocity + omega.cross(center) + get(y, S::kTravelRate + wheel) * Vector3d::UnitZ();
  const Vector3d sideways = axis.cross(normal);
  const double tilt = 1.0 / sideways.norm();
  const Vector3d forward = tilt * sideways, lateral = normal.cross(forward);
  const double turn = get(y, S::kAngle + wheel);
  const double free = w.tire.radius + w.tire.runout * std::sin(turn);
  const double loaded = tilt * support.distance;
  const Vector3d arm = -loaded * forward.cross(axis);
  const double deflection = free - loaded;
  const double rate =
      -tilt * motion.dot(normal) + w.tire.runout * std::cos(turn) * get(y, S::kSpin + wheel);
  double load = w.tire.stiffness * deflection;
  if (w.tire.exponent != 0.0 && deflection > 0.0) {
    load *= std::pow(deflection / w.tire.deflection, w.tire.exponent);
  }
  load = std::max(load + w.tire.damping * calc_touch(deflection) * rate, 0.0);
  const double vx = motion.dot(forward), speed = std::max(std::fabs(vx), 0.5);
  const double vy = (velocity + omega.cross(center + arm)).dot(lateral) +
                    get(y, S::kTravelRate + wheel) * lateral.z();
  const double rolling = w.tire.radius - std::max(deflection, 0.0) / 3.0;
  const double spin = get(y, S::kSpin + wheel);
  const double fx = load * calc_slip_force(w.tire.along, (spin * rolling - vx) / speed);
  const double fy = -load * calc_slip_force(w.tire.across, std::atan(vy / speed));
  const Vector3d force = fx * forward + fy * lateral + load * normal;
  const Vector3d moment = arm.cross(force);
  f.load[i] = load;
  f.up[i] += force.z();
  f.spin_rate[i] = moment.y() / w.spin_inertia;
  f.force += force;
  f.moment += center.cross(force) + moment;
}

void CarModel::calc_struts(const std::vector<double>& y, Forces& f, double* rates) const {
  const double bend = get(y, S::kBend), bend_rate = get(y, S::kBend + 1);
  const bool bends = car_.bending.compliance > 0.0;
  for (std::size_t i = 0; i < kWheels; ++i) {
    const int wheel = static_cast<int>(i), inner = wheel * kStrutStates;
    const double shape = bends ? bend_shape_[i] : 0.0;
    const double travel = get(y, S::kTravel + wheel) - shape * bend;
    const double speed = get(y, S::kTravelRate + wheel) - shape * bend_rate;
    const double other = get(y, S::kTravel + (wheel ^ 1));
    const double bar = car_.roll_bar[i / 2] * (get(y, S::kTravel + wheel) - other);
    const double force = calc_strut_force(car_.wheel[i].strut, travel, speed,
                                          &y[index(S::kInner + inner)], rates + inner);
    f.strut[i] = static_strut_[i] + force + bar;
    f.up[i] -= f.strut[i];
    f.bend += shape * force;
  }
}

/// Accelerations [reference (3), angular (3), travels (4), seat (1)] in body axes.
Eigen::Matrix<double, 11, 1> CarModel::solve(const std::vector<double>& y, const Forces& f) const {
  const Vector3d omega = get_vector(y, S::kRate);
  const Vector3d gravity = -kGravity * f.rotation.transpose() * Vector3d::UnitZ();
  Eigen::Matrix<double, 11, 11> mass = Eigen::Matrix<double, 11, 11>::Zero();
  Eigen::Matrix<double, 11, 1> force = Eigen::Matrix<double, 11, 1>::Zero();
  force.head<3>() = f.force;
  force.segment<3>(3) = f.moment;
  const auto add_point = [&](double m, const Vector3d& r, const Vector3d& bias, int own) {
    const Matrix3d lever = m * calc_cross(r);
    const Vector3d applied = m * (gravity - bias);
    mass.topLeftCorner<3, 3>().diagonal().array() += m;
    mass.block<3, 3>(0, 3) -= lever;
    mass.block<3, 3>(3, 0) += lever;
    mass.block<3, 3>(3, 3) += calc_point_inertia(m, r);
    force.head<3>() += applied;
    force.segment<3>(3) += r.cross(applied);
    if (own < 0) return;
    const Vector3d turn = m * r.cross(Vector3d::UnitZ());
    mass(own, own) += m;
    mass(2, own) += m;
    mass(own, 2) += m;
    mass.block<3, 1>(3, own) += turn;
    mass.block<1, 3>(own, 3) += turn.transpose();
    force[own] += applied.z();
  };
  const auto add_inertia = [&](const Matrix3d& inertia) {
    mass.block<3, 3>(3, 3) += inertia;
    force.segment<3>(3) -= omega.cross(inertia * omega);
  };
  const auto spun = [&](const Vector3d& r) { return omega.cross(omega.cross(r)); };
  add_point(body_mass_, body_center_, spun(body_center_), -1);
  add_inertia(body_inertia_);
  if (car_.payload > 0.0) add_point(car_.payload, car_.payload_at, spun(car_.payload_at), -1);
  for (int i = 0; i < kWheels; ++i) {
    const Wheel& w = car_.wheel[static_cast<std::size_t>(i)];
    const Vector3d& r = f.at[static_cast<std::size_t>(i)];
    const Vector3d coriolis = 2.0 * get(y, S::kTravelRate + i) * omega.cross(Vector3d::UnitZ());
    add_point(w.mass, r, spun(r) + coriolis, 6 + i);
    add_inertia(Vector3d(w.transverse_inertia, 0.0, w.transverse_inertia).asDiagonal());
    force[6 + i] += f.up[static_cast<std::size_t>(i)];
    const Vector3d momentum = w.spin_inertia * get(y, S::kSpin + i) * Vector3d::UnitY();
    force.segment<3>(3) -= omega.cross(momentum);
    force[4] -= w.spin_inertia * f.spin_rate[static_cast<std::size_t>(i)];
  }
  if (car_.passenger.mass > 0.0) {
    const Vector3d r = car_.passenger.position + get(y, S::kSeat) * Vector3d::UnitZ();
    const Vector3d coriolis = 2.0 * get(y, S::kSeat + 1) * omega.cross(Vector3d::UnitZ());
    add_point(car_.passenger.mass, r, spun(r) + coriolis, kSeatEquation);
    force[kSeatEquation] += f.seat;
  } else {
    mass(kSeatEquation, kSeatEquation) = 1.0;
  }
  return mass.ldlt().solve(force);
}

void CarModel::calc_rates(const Drive& drive, const std::vector<double>& y,
                          std::vector<double>& dy) const {
  Forces f;
  f.rotation = calc_rotation(y);
  for (int i = 0; i < kWheels; ++i) {
    const auto k = static_cast<std::size_t>(i);
    f.at[k] = car_.wheel[k].position + get(y, S::kTravel + i) * Vector3d::UnitZ();
  }
  for (int i = 0; i < kWheels; ++i) calc_tire(drive, y, i, f);
  calc_struts(y, f, &dy[S::kInner]);
  const Passenger& p = car_.passenger;
  if (p.mass > 0.0) {
    const double rate = kTwoPi * p.frequency;
    f.seat = p.mass * (kGravity - rate * rate * get(y, S::kSeat) -
                       2.0 * p.damping * rate * get(y, S::kSeat + 1));
  }
  const auto a = solve(y, f);
  const Vector3d v = get_vector(y, S::kVelocity), omega = get_vector(y, S::kRate);
  const auto set = [&](int at, const Vector3d& value) {
    for (int k = 0; k < 3; ++k) dy[index(at + k)] = value[k];
  };
  set(S::kPosition, f.rotation * v);
  const double w = get(y, S::kQuaternion);
  const Vector3d u = get_vector(y, S::kQuaternion + 1);
  dy[S::kQuaternion] = -0.5 * u.dot(omega);
  set(S::kQuaternion + 1, 0.5 * (w * omega + u.cross(omega)));
  set(S::kVelocity, a.head<3>() - omega.cross(v));
  set(S::kRate, a.segment<3>(3));
  for (int i = 0; i < kWheels; ++i) {
    const auto k = static_cast<std::size_t>(i);
    dy[S::kTravel + k] = get(y, S::kTravelRate + i);
    dy[S::kTravelRate + k] = a[6 + i];
    dy[S::kSpin + k] = f.spin_rate[k];
    dy[S::kAngle + k] = get(y, S::kSpin + i);
  }
  dy[S::kSeat] = get(y, S::kSeat + 1);
  dy[S::kSeat + 1] = p.mass > 0.0 ? a[kSeatEquation] : 0.0;
  dy[S::kBend] = dy[S::kBend + 1] = 0.0;
  if (car_.bending.compliance > 0.0) {
    const double rate = kTwoPi * car_.bending.frequency;
    const double drive_force = car_.bending.compliance * f.bend / bend_mass_;
    dy[S::kBend] = get(y, S::kBend + 1);
    dy[S::kBend + 1] = drive_force - rate * rate * get(y, S::kBend) -
                       2.0 * car_.bending.damping * rate * get(y, S::kBend + 1);
  }
}

CarSample CarModel::calc_sample(const Drive& drive, const std::vector<double>& y) const {
  std::vector<double> dy(y.size());
  calc_rates(drive, y, dy);
  const Matrix3d rotation = calc_rotation(y);
  const Vector3d v = get_vector(y, S::kVelocity), omega = get_vector(y, S::kRate);
  const Vector3d reference = get_vector(dy, S::kVelocity) + omega.cross(v);
  const Vector3d turning = get_vector(dy, S::kRate);
  const auto calc_point = [&](const Vector3d& r) -> Vector3d {
    return reference + turning.cross(r) + omega.cross(omega.cross(r));
  };
  CarSample s;
  const Vector3d gravity = -kGravity * rotation.transpose() * Vector3d::UnitZ();
  s.imu_acceleration = calc_point(car_.imu) - gravity;
  s.imu_acceleration.z() += 0.9 * dy[S::kBend + 1];
  s.imu_rate = omega;
  if (car_.imu_lean != 0.0) {
    const Matrix3d lean = Eigen::AngleAxisd(-car_.imu_lean, Vector3d::UnitY()).toRotationMatrix();
    s.imu_acceleration = lean * s.imu_acceleration;
    s.imu_rate = lean * s.imu_rate;
  }
  for (int i = 0; i < kWheels; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double shape = car_.bending.compliance > 0.0 ? bend_shape_[k] : 0.0;
    s.deflection[k] = get(y, S::kTravel + i) - shape * get(y, S::kBend);
    s.deflection_rate[k] = get(y, S::kTravelRate + i) - shape * get(y, S::kBend + 1);
    const Vector3d at = car_.wheel[k].position + get(y, S::kTravel + i) * Vector3d::UnitZ();
    const Vector3d own = calc_point(at) + dy[S::kTravelRate + k] * Vector3d::UnitZ() +
                         2.0 * get(y, S::kTravelRate + i) * omega.cross(Vector3d::UnitZ());
    s.wheel_acceleration[k] = (rotation * own).z();
    Forces f;
    f.rotation = rotation;
    f.at[k] = at;
    calc_tire(drive, y, i, f);
    s.load[k] = f.load[k];
  }
  s.height = get(y, S::kPosition + 2);
  s.vertical_speed = (rotation * v).z();
  s.vertical_acceleration = (rotation * reference).z();
  s.pitch = std::asin(-rotation(2, 0));
  s.pitch_rate = omega.y();
  return s;
}

double CarModel::calc_energy(const std::vector<double>& y) const {
  const Matrix3d rotation = calc_rotation(y);
  const Vector3d v = get_vector(y, S::kVelocity), omega = get_vector(y, S::kRate);
  const Vector3d origin = get_vector(y, S::kPosition);
  double energy = 0.5 * omega.dot(body_inertia_ * omega);
  const auto add_mass = [&](double m, const Vector3d& r, const Vector3d& own) {
    energy += 0.5 * m * (v + omega.cross(r) + own).squaredNorm() +
              m * kGravity * (origin + rotation * r).z();
  };
  add_mass(body_mass_, body_center_, Vector3d::Zero());
  for (int i = 0; i < kWheels; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Wheel& w = car_.wheel[k];
    const double q = get(y, S::kTravel + i);
    add_mass(w.mass, w.position + q * Vector3d::UnitZ(),
             get(y, S::kTravelRate + i) * Vector3d::UnitZ());
    const double spin = get(y, S::kSpin + i);
    energy += 0.5 * w.transverse_inertia * (omega.x() * omega.x() + omega.z() * omega.z()) +
              0.5 * w.spin_inertia * spin * spin;
    energy += q * (static_strut_[k] + 0.5 * w.strut.stiffness * q);
  }
  return energy;
}

std::vector<double> CarModel::make_start(double speed, double x) const {
  std::vector<double> y(S::kCount, 0.0), dy(y.size());
  y[S::kPosition] = x;
  y[S::kPosition + 2] = car_.centroid_height;
  y[S::kQuaternion] = 1.0;
  Drive flat;
  // Unknown: height, roll, pitch, travels; their accelerations vanish.
  const auto displace = [&](const std::vector<double>& from, int which, double step) {
    std::vector<double> to = from;
    if (which == 0) to[S::kPosition + 2] += step;
    if (which == 1 || which == 2) to[index(S::kQuaternion + which)] += 0.5 * step;
    if (which > 2) to[index(S::kTravel + which - 3)] += step;
    return to;
  };
  const auto calc = [&](const std::vector<double>& at) {
    calc_rates(flat, at, dy);
    Eigen::Matrix<double, 7, 1> a;
    a << dy[S::kVelocity + 2], dy[S::kRate], dy[S::kRate + 1], dy[S::kTravelRate],
        dy[S::kTravelRate + 1], dy[S::kTravelRate + 2], dy[S::kTravelRate + 3];
    return a;
  };
  double miss = 1.0;
  for (int iteration = 0; iteration < 60 && miss > 1e-9; ++iteration) {
    const auto a = calc(y);
    miss = a.cwiseAbs().maxCoeff();
    Eigen::Matrix<double, 7, 7> jacobian;
    for (int k = 0; k < 7; ++k) {
      jacobian.col(k) = (calc(displace(y, k, 1e-6)) - calc(displace(y, k, -1e-6))) / 2e-6;
    }
    const Eigen::Matrix<double, 7, 1> step = -jacobian.partialPivLu().solve(a);
    for (int k = 0; k < 7; ++k) y = displace(y, k, std::clamp(step[k], -0.05, 0.05));
  }
  if (miss > 1e-6) throw std::runtime_error("hidden car: no equilibrium");
  const double w =
      std::sqrt(1.0 - std::pow(y[S::kQuaternion + 1], 2) - std::pow(y[S::kQuaternion + 2], 2));
  y[S::kQuaternion] = w;
  const Matrix3d rotation = calc_rotation(y);
  const Vector3d v = rotation.transpose() * Vector3d(speed, 0.0, 0.0);
  for (int k = 0; k < 3; ++k) y[index(S::kVelocity + k)] = v[k];
  for (std::size_t i = 0; i < kWheels; ++i) {
    const Tire& tire = car_.wheel[i].tire;
    const Vector3d at = car_.wheel[i].position + y[S::kTravel + i] * Vector3d::UnitZ();
    const double gap = tire.radius - (y[S::kPosition + 2] + (rotation * at).z());
    y[S::kSpin + i] = speed / (tire.radius - std::max(gap, 0.0) / 3.0);
  }
  return y;
}

std::vector<CarSample> simulate_car(const CarModel& model, const Drive& drive,
                                    const std::vector<double>& start,
                                    const std::vector<double>& times, double tolerance) {
  DormandPrinceOptions options;
  options.tolerance = tolerance;
  options.scale.assign(S::kCount, 0.05);
  for (int i = 0; i < kWheels; ++i) {
    const auto k = static_cast<std::size_t>(i);
    options.scale[S::kTravelRate + k] = 0.5;
    options.scale[S::kSpin + k] = 10.0;
    options.scale[S::kAngle + k] = 10.0;
    const auto inner = index(S::kInner + i * kStrutStates);
    const std::array<double, kStrutStates> sizes{3e-4, 1e-3, 5e-3, 2e3, 0.5};
    std::copy(sizes.begin(), sizes.end(),
              options.scale.begin() + static_cast<std::ptrdiff_t>(inner));
  }
  options.scale[S::kPosition] = 1.0;
  std::vector<CarSample> samples(times.size());
  integrate_dormand_prince([&](double, const std::vector<double>& y,
                               std::vector<double>& dy) { model.calc_rates(drive, y, dy); },
                           start, times, options,
                           [&](std::size_t i, double, const std::vector<double>& y) {
                             samples[i] = model.calc_sample(drive, y);
                           });
  return samples;
}

Car make_nominal_car() {
  Car car;
  const Vector3d places[kWheels] = {
      {1.15, 0.75, 0.0}, {1.15, -0.75, 0.0}, {-1.45, 0.75, 0.0}, {-1.45, -0.75, 0.0}};
  const double wheelbase = places[0].x() - places[2].x();
  for (std::size_t i = 0; i < kWheels; ++i) {
    Wheel& w = car.wheel[i];
    w.position = places[i];
    const double load = 0.5 * car.mass * kGravity * std::fabs(places[i ^ 2].x()) / wheelbase;
    w.position.z() = w.tire.radius - load / w.tire.stiffness - car.centroid_height;
    w.strut.stiffness = i < 2 ? 24000.0 : 22000.0;
    w.strut.damping = i < 2 ? 1700.0 : 1600.0;
  }
  return car;
}

}  // namespace strut::hidden
