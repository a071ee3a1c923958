#include "python/core/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "model/longest_step.h"
#include "sweep/choices.h"

namespace strut {
namespace {

template <class Enum, std::size_t N>
void choose(const char* key, const std::optional<std::string>& name,
            const std::array<Named<Enum>, N>& table, Enum& value) {
  if (!name) return;
  const std::optional<Enum> found = find_value(table, *name);
  if (!found) {
    throw InputError(fmt::format("{} = '{}': unknown; allowed: {}", key, *name,
                                 fmt::join(list_names(table), ", ")));
  }
  value = *found;
}

void check_step(const char* key, double value, double low, bool may_equal) {
  if (value <= kMaxStep && (may_equal ? value >= low : value > low)) return;
  throw InputError(fmt::format("{} = {} s: must lie in {}{}, {}]", key, format_number(value),
                               may_equal ? "[" : "(", format_number(low), format_number(kMaxStep)));
}

SolverOptions read(const IntegrationWords& words, double longest_step, Integrator integrator,
                   SolverOptions options) {
  IntegrateOptions& integrate = options.options;
  choose("integrator", words.integrator, kIntegrators, integrator);
  choose("closure", words.closure, kClosures, integrate.closure);
  choose("spin", words.spin, kSpins, integrate.spin);
  StepOptions& step = integrate.step;
  step.locate_events = words.events;
  options.reference.closure = integrate.closure;
  if (integrator == Integrator::kCvode) {
    if (words.step || words.coarse_step) {
      throw InputError("step, coarse_step: cvode chooses its own steps; allowed: rk4, abm4");
    }
    options.solver = Solver::kCvode;
    return options;
  }
  step.stepper = to_stepper(integrator);
  step.step = shorten_step(step.step, longest_step);
  if (step.coarse_step > 0.0) step.coarse_step = shorten_step(step.coarse_step, longest_step);
  if (words.step) {
    check_step("step", *words.step, 0.0, false);
    step.step = *words.step;
    step.coarse_step = 0.0;  // the default's belongs to the default step
  }
  if (words.coarse_step) {
    check_step("coarse_step", *words.coarse_step, step.step, true);
    step.coarse_step = *words.coarse_step;
  }
  return options;
}

}  // namespace

SolverOptions read_single_run(const IntegrationWords& words, double longest_step) {
  return read(words, longest_step, Integrator::kRk4, {});
}

SolverOptions read_many_runs(const IntegrationWords& words, double longest_step,
                             const ManyKind& kind) {
  constexpr double kFast = 10.0;  // m/s
  SolverOptions options;
  options.options.closure = Closure::kTable;
  options.options.symmetry = true;
  if (kind.histories) return read(words, longest_step, Integrator::kRk4, options);
  options.options.step.coarse_step = kind.lowest_speed >= kFast ? 10e-3 : 4e-3;
  return read(words, longest_step, Integrator::kAbm4, options);
}

}  // namespace strut
