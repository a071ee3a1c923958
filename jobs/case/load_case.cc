#include "jobs/case/load_case.h"

#include <fmt/format.h>

#include "base/error/input_error.h"
#include "model_files/parameters.h"
#include "model_files/read_maneuver.h"
#include "model_files/read_vehicle.h"

namespace strut {
namespace {

std::string describe_settings(const CaseSource& source) {
  if (source.settings.empty()) return "";
  return fmt::format(" (with --set {})", fmt::join(source.settings, " --set "));
}

template <class Function>
auto call_model(const CaseSource& source, const Function& function) {
  try {
    return function();
  } catch (const ModelError& e) {
    const bool is_road = e.fault() == ModelFault::kRoad && !source.maneuver.empty();
    const auto& file = is_road ? source.maneuver : source.vehicle;
    throw InputError(fmt::format("{}{}: {}", file.string(), describe_settings(source), e.what()));
  }
}

}  // namespace

Case load_case(const CaseSource& source) {
  Case c;
  c.vehicle = read_vehicle(source.vehicle);
  if (!source.maneuver.empty()) c.maneuver = read_maneuver(source.maneuver);
  for (const std::string& setting : source.settings) {
    try {
      apply_setting(c, setting);
    } catch (const InputError& e) {
      throw InputError(fmt::format("--set {}", e.what()));
    }
  }
  return c;
}

PreparedCase prepare_case(const CaseSource& source, const Case& c) {
  CasePreparer preparer;
  return prepare_case(source, c, preparer);
}

PreparedCase prepare_case(const CaseSource& source, const Case& c, CasePreparer& preparer) {
  return call_model(source, [&] { return preparer.prepare(c); });
}

AssembledVehicle assemble_case(const CaseSource& source, const Case& c) {
  return call_model(source, [&] { return assemble_vehicle(c.vehicle, c.maneuver); });
}

}  // namespace strut
