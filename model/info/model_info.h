// The description of a kind of model: its channels, inputs, masses, struts and states. Estimation
// and diagnosis read this description and never depend on the kind.
#pragma once

#include <string>
#include <vector>

#include "model/channel/channel_info.h"

namespace strut {

/// Parts of a model that effects act on or are observed in; bits of a set.
enum ModelPart : unsigned {
  kHasCar = 1,                 // axles, corners, a body of six degrees of freedom, a maneuver
  kHasTire = 2,                // between wheel and ground
  kHasGroundInput = 4,         // a recorded motion of the ground
  kHasSprungMass = 8,          // on the strut
  kHasDamperTemperature = 16,  // as an input
  kHasStaticForce = 32,  // a constant strut force is observable: by the ride height or a channel
};

/// A recorded quantity that drives a model.
struct InputInfo {
  std::string name, unit, description;
  bool required = false;
  bool moves = true;        // it excites motion that scales with it; false: a temperature
  bool is_ground = false;   // the position above which the masses rest
  bool is_command = false;  // the actual quantity may differ from it in size or sign
  /// The channels of its first and second time derivative, which may be recorded in its place; -1:
  /// none.
  int rate = -1, second_rate = -1;
};

/// A weighted sum of channels.
struct ChannelTerm {
  int channel;
  double factor;
};
using ChannelSum = std::vector<ChannelTerm>;

/// The channels of a mass whose initial state belongs to the measured run.
struct MassInfo {
  int position, velocity;
};

/// The channels of a strut's motion and forces. Deflection and velocity: positive in compression.
struct StrutInfo {
  std::string place;  // as in effects: "front", "rear"; "" on a rig
  std::string deflection_name, velocity_name;
  ChannelSum deflection, velocity;  // m, m/s
  int spring_force, damper_force;   // channels, N
};

enum class StateKind {
  kDeflection,  // deflection of a strut or its mass
  kVelocity,    // time derivative of the deflection
  kTireLoad,
  kGuideVelocity,  // velocity of a mass along its guide
};

/// A motion or load of the model as a function of which residuals are examined.
struct StateInfo {
  StateKind kind;
  std::string place;  // as in StrutInfo
  std::string name, unit;
  ChannelSum sum;
};

/// A kind of model.
struct ModelInfo {
  std::string name;  // the `type` of its file
  unsigned parts;    // ModelPart
  std::vector<ChannelInfo> channels;
  /// Empty for a car: the road of its maneuver drives it, which is not recorded.
  std::vector<InputInfo> inputs;
  std::vector<MassInfo> masses;
  std::vector<StrutInfo> struts;
  std::vector<StateInfo> states;
  /// Channel of the total strut force on a stand that imposes the motion; -1 on other models.
  int stand_force = -1;

  bool has(ModelPart part) const { return (parts & part) != 0; }
  /// Whether recorded inputs drive the model, on the clock of the readings; otherwise a road does,
  /// on a clock of its own.
  bool is_driven_by_inputs() const { return !inputs.empty(); }
};

/// The weighted sum at every sample; `channel` holds the samples of each channel of the model,
/// `sum` at least one term.
std::vector<double> calc_sum(const ChannelSum& sum,
                             const std::vector<std::vector<double>>& channel);

/// The number of the channel or input of this name; -1 where there is none.
int find_channel(const ModelInfo& model, const std::string& name);
int find_input(const ModelInfo& model, const std::string& name);

/// An input of a model (an index of ModelInfo::inputs) by one of its time derivatives; 0: itself.
struct InputDerivative {
  int input = -1, derivative = 0;
};
/// The input that a channel gives, itself or as a time derivative; input = -1 where there is none.
InputDerivative find_input_derivative(const ModelInfo& model, const std::string& channel);

}  // namespace strut
