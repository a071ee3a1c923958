#include "jobs/simulate/kinematics.h"

#include <fstream>

#include "io/atomic_file.h"
#include "io/config.h"
#include "jobs/interrupt.h"
#include "model/vehicle/kinematics.h"

namespace strut {
namespace {

constexpr int kHalfCount = 40;
constexpr double kPerMeter = 400.0;  // travels a meter; a division gives the shortest decimals

std::vector<double> list_travels() {
  std::vector<double> travels;
  for (int i = -kHalfCount; i <= kHalfCount; ++i) travels.push_back(i / kPerMeter);
  return travels;
}

void write_row(std::ostream& stream, const KinematicsPoint& p, const char* axle) {
  for (const double value : {p.travel, p.camber, p.toe, p.displacement.x, p.displacement.y,
                             p.displacement.z, p.caster_change, p.spring_length, p.damper_length}) {
    stream << format_number(value) << ',';
  }
  stream << axle << ',' << format_number(p.track) << '\n';
}

}  // namespace

void write_kinematics(const CaseSource& source, const std::filesystem::path& output) {
  const AssembledVehicle car = assemble_case(source, load_case(source));
  const std::vector<double> travels = list_travels();
  std::vector<KinematicsPoint> front, rear;
  try {
    front = calc_kinematics(car, kFrontLeft, travels);
    rear = calc_kinematics(car, kRearLeft, travels);
  } catch (const ModelError& e) {
    throw InputError(source.vehicle.string() + ": " + e.what());
  }

  const InterruptGuard guard;
  AtomicFile file(output);
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream << "wheel_travel,camber_rad,toe_rad,wc_dx,wc_dy,wc_dz,caster_change_rad,spring_len,"
            "damper_len,axle,track\n";
  for (const KinematicsPoint& p : front) write_row(stream, p, "front");
  for (const KinematicsPoint& p : rear) write_row(stream, p, "rear");
  stream.close();
  if (!stream) throw EnvironmentError(output.string() + ": cannot be written: is its disk full?");
  file.commit();
}

}  // namespace strut
