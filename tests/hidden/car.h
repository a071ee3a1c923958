// The generator's own car: a rigid body in space, four wheels that go straight up and down in it,
// Magic Formula tires on a road that lifts off. Kane's equations in the body's axes.
//
// Simplifications against a real car, which the vehicle file of the same car (vehicle_file.h)
// copies: the wheels move along the body's vertical (links so long that their arcs
// are straight), no camber, toe or steering; tires without camber thrust, combined slip, aligning
// torque and rolling resistance; no drive torque.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <vector>

#include "tests/hidden/road.h"
#include "tests/hidden/strut_law.h"

namespace strut::hidden {

inline constexpr int kWheels = 4;  // front left, front right, rear left, rear right

/// In-plane force per load mu sin(C atan(B s)), K = B C mu constant over the load.
struct SlipLaw {
  double friction = 1.1;
  double shape = 1.6;
  double stiffness = 20.0;  // K / F_z, positive
};

struct Tire {
  double radius = 0.32;      // m, free
  double stiffness = 200e3;  // N/m
  double damping = 300.0;    // N s/m
  SlipLaw along{1.1, 1.6, 20.0}, across{1.0, 1.35, 14.0};
  // Faults:
  double exponent = 0.0;     // 1, stiffness times (d / d0)^e
  double deflection = 0.02;  // m, d0
  double runout = 0.0;       // m, radial, once a turn
};

struct Wheel {
  Eigen::Vector3d position{0.0, 0.0, 0.0};  // m, of the center at nominal trim, from the centroid
  double mass = 40.0;                       // kg, all that moves with it
  double transverse_inertia = 0.8;          // kg m^2, about x and z, of all that moves with it
  double spin_inertia = 1.2;                // kg m^2
  Tire tire;
  StrutLaw strut;
};

/// A mass on the body with a spring and damper of its own along the vertical.
struct Passenger {
  double mass = 0.0;  // kg; 0: absent
  Eigen::Vector3d position{0.0, 0.0, 0.0};
  double frequency = 4.0;    // Hz
  double damping = 0.3;      // 1, of critical
  bool of_the_body = false;  // its mass is taken from the body: an engine on its mounts
};

/// First vertical bending mode of the body.
struct Bending {
  double compliance = 0.0;  // 1, over that of a body whose modal mass is a tenth of the car's
  double frequency = 22.0;  // Hz
  double damping = 0.03;    // 1
};

struct Car {
  double mass = 1200.0;                            // kg, the whole car
  Eigen::Vector3d inertia{320.0, 1650.0, 1800.0};  // kg m^2, about the centroid
  double centroid_height = 0.55;                   // m, at nominal trim
  std::array<Wheel, kWheels> wheel;
  Eigen::Vector3d imu{0.1, 0.0, -0.1};  // m from the centroid
  // Faults:
  double imu_lean = 0.0;                       // rad, of the inertial sensor, nose down
  double payload = 0.0;                        // kg on the body
  Eigen::Vector3d payload_at{-0.9, 0.0, 0.1};  // m
  double center_shift = 0.0;                   // m, of the body's center of mass, forward
  double pitch_inertia = 0.0;                  // 1, relative, of the whole car
  std::array<double, 2> roll_bar{0.0, 0.0};    // N/m at the wheels, front and rear
  Passenger passenger;
  Bending bending;
};

/// The contact model of tire and road.
enum class Contact {
  kFelt,  // the height under its center that it feels, across the felt road's slope
  kDisc   // the point nearest to its center, along the line to it: a disc on the bare road
};

/// Where the road supports a wheel's center.
struct Support {
  double distance = 0.0;  // m, from the center to the road
  double slope = 0.0;     // of the road across that line
};

/// The road under a track: bump with its center and roughness, felt or bare.
struct Track {
  const Curve* bump = nullptr;
  double bump_center = 0.0;  // m, world x
  const Curve* rough = nullptr;

  void evaluate(double x, double& z, double& z_x) const;
  /// The contact of a wheel of this radius [m] whose center is at x, z [m].
  Support find_support(Contact contact, double x, double z, double radius) const;
};

struct Drive {
  double speed = 5.0;  // m/s
  Contact contact = Contact::kFelt;
  std::array<Track, kWheels> track;
};

/// The quantities that sensors can measure, at one instant.
struct CarSample {
  Eigen::Vector3d imu_acceleration, imu_rate;               // m/s^2 with gravity, rad/s
  std::array<double, kWheels> deflection, deflection_rate;  // m, m/s
  std::array<double, kWheels> wheel_acceleration;           // m/s^2, vertical
  std::array<double, kWheels> load;                         // N
  double height, vertical_speed, vertical_acceleration;     // of the centroid at nominal trim
  double pitch, pitch_rate;
};

/// Indices in the state vector.
struct CarState {
  enum : int {
    kPosition = 0,
    kQuaternion = 3,  // w x y z
    kVelocity = 7,    // body axes
    kRate = 10,       // body axes
    kTravel = 13,
    kTravelRate = 17,
    kSpin = 21,
    kAngle = 25,
    kSeat = 29,  // position, rate
    kBend = 31,  // position, rate
    kInner = 33,
    kCount = kInner + kWheels * kStrutStates
  };
};

class CarModel {
 public:
  explicit CarModel(const Car& car);

  /// Rolling at the speed of `drive` in static equilibrium on flat ground, reference at x [m].
  std::vector<double> make_start(double speed, double x) const;
  void calc_rates(const Drive& drive, const std::vector<double>& y, std::vector<double>& dy) const;
  CarSample calc_sample(const Drive& drive, const std::vector<double>& y) const;
  /// Kinetic energy, gravity, linear springs and tires [J].
  double calc_energy(const std::vector<double>& y) const;
  double get_static_load(int wheel) const { return static_load_[static_cast<std::size_t>(wheel)]; }

 private:
  struct Forces;
  void calc_tire(const Drive& drive, const std::vector<double>& y, int wheel, Forces& f) const;
  void calc_struts(const std::vector<double>& y, Forces& f, double* rates) const;
  Eigen::Matrix<double, 11, 1> solve(const std::vector<double>& y, const Forces& f) const;

  Car car_;
  double body_mass_ = 0.0, bend_mass_ = 0.0;
  Eigen::Vector3d body_center_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d body_inertia_ = Eigen::Matrix3d::Zero();  // about the body's center of mass
  std::array<double, kWheels> static_load_{}, static_strut_{}, bend_shape_{};
};

/// Samples at `times` [s]; the car starts at times.front() with its reference at x = speed * time.
std::vector<CarSample> simulate_car(const CarModel& model, const Drive& drive,
                                    const std::vector<double>& start,
                                    const std::vector<double>& times, double tolerance = 1e-7);

/// The car of the trials: 1200 kg, four equal wheels, struts of the usual size.
Car make_nominal_car();

}  // namespace strut::hidden
