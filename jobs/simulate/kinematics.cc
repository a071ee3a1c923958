#include "jobs/simulate/kinematics.h"

#include <fmt/format.h>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "io/file/atomic_file.h"
#include "jobs/cli/interrupt.h"
#include "model/car/kinematics.h"

namespace strut {
namespace {

constexpr int kHalfCount = 40;
constexpr double kPerMeter = 400.0;  // points per meter; dividing by it gives the shortest decimals

std::vector<double> list_travels() {
  std::vector<double> travels;
  for (int i = -kHalfCount; i <= kHalfCount; ++i) travels.push_back(i / kPerMeter);
  return travels;
}

void append_row(std::string& text, const KinematicsPoint& p, const std::string& axle) {
  for (const double value : {p.travel, p.camber, p.toe, p.displacement.x, p.displacement.y,
                             p.displacement.z, p.caster_change, p.spring_length, p.damper_length}) {
    text += format_number(value) + ',';
  }
  text += axle + ',' + format_number(p.track) + '\n';
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
    throw InputError(fmt::format("{}: {}", source.vehicle.string(), e.what()));
  }

  std::string text =
      "wheel_travel,camber_rad,toe_rad,wc_dx,wc_dy,wc_dz,caster_change_rad,spring_len,damper_len,"
      "axle,track\n";
  for (const KinematicsPoint& p : front) append_row(text, p, "front");
  for (const KinematicsPoint& p : rear) append_row(text, p, "rear");
  const InterruptGuard guard;
  write_text_file(output, text);
}

}  // namespace strut
