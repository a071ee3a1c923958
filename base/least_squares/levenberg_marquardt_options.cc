// Validation of the options of a training, reports of its result.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/error/input_error.h"
#include "base/least_squares/levenberg_marquardt.h"
#include "base/names/name_table.h"

namespace strut {
namespace {

constexpr std::array<Named<StopReason>, 8> kStopReasons = {{
    {StopReason::kNone, "still running"},
    {StopReason::kEpochs, "epochs"},
    {StopReason::kTime, "time"},
    {StopReason::kGoal, "goal"},
    {StopReason::kGradient, "gradient"},
    {StopReason::kDamping, "damping bound"},
    {StopReason::kValidation, "validation failures"},
    {StopReason::kNotFinite, "loss not finite"},
}};
static_assert(names_all(kStopReasons, StopReason::kNotFinite));

void require(bool allowed, const char* field, double value, const char* range) {
  if (!allowed) throw InputError(fmt::format("{}: {:.4g}; allowed: {}", field, value, range));
}

std::string make_row(const char* name, const std::string& value) {
  return fmt::format("{:<22}{}\n", name, value);
}

std::string format(double value) { return fmt::format("{:.4g}", value); }

}  // namespace

void LevenbergMarquardtOptions::validate() const {
  require(max_acceleration > 0.0, "max_acceleration", max_acceleration, "above 0");
  require(first_damping >= 0.0 && std::isfinite(first_damping), "first_damping", first_damping,
          "finite, at least 0");
  require(damping_increase > 1.0 && std::isfinite(damping_increase), "damping_increase",
          damping_increase, "finite, above 1");
  require(damping_decrease > 0.0 && damping_decrease < 1.0, "damping_decrease", damping_decrease,
          "between 0 and 1");
  require(max_damping > 0.0 && std::isfinite(max_damping), "max_damping", max_damping,
          "finite, above 0");
  require(epochs >= 0, "epochs", epochs, "at least 0");
  require(seconds >= 0.0, "seconds", seconds, "at least 0");
  require(goal >= 0.0, "goal", goal, "at least 0");
  require(min_gradient >= 0.0, "min_gradient", min_gradient, "at least 0");
  require(max_failures >= 1, "max_failures", max_failures, "at least 1");
  require(threads >= 1 && threads <= 1024, "threads", threads, "1 to 1024");
}

const char* get_name(StopReason reason) { return find_name(kStopReasons, reason); }

std::string TrainingSummary::make_line() const {
  std::string line = fmt::format("stopped by {} at epoch {}, loss {:.4g}", get_name(reason),
                                 last.epoch, last.loss);
  if (!std::isnan(best_validation)) {
    line += fmt::format(", validation {:.4g} at epoch {}", best_validation, best_epoch);
  }
  return line + fmt::format(", {:.4g} s", seconds);
}

std::string TrainingSummary::make_report() const {
  std::string report = make_row("stopped by", get_name(reason));
  report += make_row("epochs", std::to_string(last.epoch));
  report += make_row("factorizations", std::to_string(trials));
  report += make_row("time", format(seconds) + " s");
  report += make_row("loss", format(last.loss));
  report += make_row("gradient", format(last.gradient));
  report += make_row("damping", format(last.damping));
  if (!std::isnan(best_validation)) {
    report += make_row("validation", format(last.validation));
    report +=
        make_row("best validation", fmt::format("{:.4g} at epoch {}", best_validation, best_epoch));
  }
  return report;
}

}  // namespace strut
