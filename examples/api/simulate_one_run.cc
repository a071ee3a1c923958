// simulate_one_run VEHICLE.toml MANEUVER.toml: a car with one worn spring over the bump.
#include <cstdio>
#include <exception>

#include "model_files/parameters.h"
#include "model_files/read_maneuver.h"
#include "model_files/read_vehicle.h"
#include "sweep/simulate_case.h"

namespace {

int simulate(const char* vehicle, const char* maneuver) {
  strut::Case worn{strut::read_vehicle(vehicle), strut::read_maneuver(maneuver)};
  strut::set_parameter(worn, "front_left_stiffness", 38000.0);  // N/m

  // The car trimmed on its springs, its linkages ready to move.
  const strut::PreparedCase prepared = strut::CasePreparer().prepare(worn);
  const strut::LaneResults run = strut::simulate_case(prepared);
  if (!run.is_done()) {
    std::fprintf(stderr, "the run failed at %g s\n", run.get_failure_time());
    return 1;
  }
  if (!run.has_snapshot()) {
    std::fprintf(stderr, "the rear wheels do not reach the bump\n");
    return 1;
  }

  std::printf("event_time %.17g s\n", run.get_event_time());
  const auto& channels = strut::list_car_channels();
  for (std::size_t c = 0; c < channels.size(); ++c) {
    std::printf("%s %.17g %s\n", channels[c].name.c_str(), run.snapshot[c],
                channels[c].unit.c_str());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    return simulate(argv[1], argv[2]);
  } catch (const std::exception& e) {  // InputError, ModelError: what is wrong with the files
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
