#include "jobs/case/options.h"

#include <cmath>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "jobs/cli/output_file.h"
#include "sweep/step_count.h"

namespace strut {
namespace {

constexpr double kMaxSamples = 2e6;  // one gigabyte of history

}  // namespace

void check_rate(double rate, double duration) {
  if (duration * rate <= kMaxSamples) return;
  throw InputError("--rate = " + format_number(rate) + " Hz: must be at most " +
                   format_number(std::floor(kMaxSamples / duration)) + " Hz for " +
                   format_number(duration) + " s");
}

void check_step_count(const SimulateOptions& options, double duration) {
  if (options.integrator == kIntegratorCvode) return;
  const double step = options.integrate.step.step;
  const std::string fault = find_step_count_fault(duration, step);
  if (!fault.empty()) throw InputError("--step = " + format_number(step) + " s: " + fault);
}

RunFormat check_output(const SimulateOptions& options) {
  const RunFormat format = find_run_format(options.output);
  check_output_file("output", options.output,
                    list_files_read({options.source.vehicle, options.source.maneuver}),
                    options.force);
  return format;
}

}  // namespace strut
