// Options of a training checked, its outcome told.
#include <cmath>
#include <cstdio>

#include "base/error/input_error.h"
#include "base/least_squares/levenberg_marquardt.h"

namespace strut {
namespace {

std::string to_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

void require(bool allowed, const char* field, double value, const char* range) {
  if (!allowed) {
    throw InputError(std::string(field) + ": " + to_text(value) + "; allowed: " + range);
  }
}

}  // namespace

void LevenbergMarquardtOptions::validate() const {
  require(max_acceleration > 0.0, "max_acceleration", max_acceleration, "above 0");
  require(first_damping >= 0.0 && std::isfinite(first_damping), "first_damping", first_damping,
          "0 and more, finite");
  require(damping_increase > 1.0 && std::isfinite(damping_increase), "damping_increase",
          damping_increase, "above 1");
  require(damping_decrease > 0.0 && damping_decrease < 1.0, "damping_decrease", damping_decrease,
          "between 0 and 1");
  require(max_damping > 0.0 && std::isfinite(max_damping), "max_damping", max_damping,
          "above 0, finite");
  require(epochs >= 0, "epochs", epochs, "0 and more");
  require(seconds >= 0.0, "seconds", seconds, "0 and more");
  require(goal >= 0.0, "goal", goal, "0 and more");
  require(min_gradient >= 0.0, "min_gradient", min_gradient, "0 and more");
  require(max_failures >= 1, "max_failures", max_failures, "1 and more");
  require(threads >= 1 && threads <= 1024, "threads", threads, "1 to 1024");
}

const char* get_name(StopReason reason) {
  switch (reason) {
    case StopReason::kNone:
      return "still running";
    case StopReason::kEpochs:
      return "epochs";
    case StopReason::kTime:
      return "time";
    case StopReason::kGoal:
      return "goal";
    case StopReason::kGradient:
      return "gradient";
    case StopReason::kDamping:
      return "damping bound";
    case StopReason::kValidation:
      return "validation failures";
    case StopReason::kNotFinite:
      return "loss not finite";
  }
  return "";
}

std::string TrainingSummary::make_line() const {
  std::string line = "stopped by " + std::string(get_name(reason)) + " at epoch " +
                     std::to_string(last.epoch) + ", loss " + to_text(last.loss);
  if (!std::isnan(best_validation)) {
    line += ", validation " + to_text(best_validation) + " at epoch " + std::to_string(best_epoch);
  }
  return line + ", " + to_text(seconds) + " s";
}

std::string TrainingSummary::make_report() const {
  const auto add = [](const char* name, const std::string& value) {
    std::string row = name;
    row.resize(22, ' ');
    return row + value + "\n";
  };
  std::string report = add("stopped by", get_name(reason));
  report += add("epochs", std::to_string(last.epoch));
  report += add("factorizations", std::to_string(trials));
  report += add("time", to_text(seconds) + " s");
  report += add("loss", to_text(last.loss));
  report += add("gradient", to_text(last.gradient));
  report += add("damping", to_text(last.damping));
  if (!std::isnan(best_validation)) {
    report += add("validation", to_text(last.validation));
    report += add("best validation",
                  to_text(best_validation) + " at epoch " + std::to_string(best_epoch));
  }
  return report;
}

}  // namespace strut
