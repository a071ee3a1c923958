#include "estimate/readings.h"

#include <utility>

#include "base/error/input_error.h"
#include "estimate/driven_readings.h"
#include "estimate/linearize.h"

namespace strut {

std::unique_ptr<ReadingModel> make_readings(std::vector<MeasuredRun> runs,
                                            std::vector<Unknown> unknowns,
                                            const LinearizeOptions& options) {
  if (runs.empty()) throw InputError("fit: no measurement");
  if (runs.front().setup.info().is_driven_by_inputs()) {
    return std::make_unique<DrivenReadings>(std::move(runs), std::move(unknowns), options);
  }
  return std::make_unique<ReadingSimulator>(std::move(runs), std::move(unknowns), options);
}

}  // namespace strut
