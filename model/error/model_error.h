// The error of invalid models: thrown before a simulation starts, never inside a step.
#pragma once

#include <stdexcept>
#include <string>

namespace strut {

/// The part of a model that cannot be simulated.
enum class ModelFault {
  kModel,  // a vehicle or rig: its parameters, effects, maps, or no equilibrium
  kRoad,   // the maneuver's road
  kInput   // the samples of a recorded input
};

/// The message names the field, its value and what is allowed.
class ModelError : public std::invalid_argument {
 public:
  explicit ModelError(const std::string& message, ModelFault fault = ModelFault::kModel)
      : std::invalid_argument(message), fault_(fault) {}

  ModelFault fault() const { return fault_; }

 private:
  ModelFault fault_;
};

}  // namespace strut
