#include "estimate/readings.h"

#include <utility>

#include "base/error/input_error.h"
#include "estimate/crossing_readings.h"
#include "estimate/driven_readings.h"

namespace strut {

std::unique_ptr<ReadingModel> make_readings(std::vector<MeasuredRun> runs,
                                            std::vector<Unknown> unknowns,
                                            const LinearizeOptions& options) {
  if (runs.empty()) throw InputError("fit: no measurement");
  return runs.front().setup.info().is_driven_by_inputs()
             ? make_driven_readings(std::move(runs), std::move(unknowns), options)
             : make_crossing_readings(std::move(runs), std::move(unknowns), options);
}

}  // namespace strut
