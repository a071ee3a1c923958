// The description of a kind of model: its channels, inputs, masses, struts and states. Estimation
// and diagnosis read this table and do not ask which kind they have.
#pragma once

#include <string>
#include <vector>

#include "model/channel/channel_info.h"

namespace strut {

/// Parts of a model that effects act on or show in; bits of a set.
enum ModelPart : unsigned {
  kHasCar = 1,                 // axles, corners, a body of six degrees of freedom, a maneuver
  kHasTire = 2,                // between wheel and ground
  kHasGroundInput = 4,         // a recorded motion of the ground
  kHasSprungMass = 8,          // on the strut
  kHasDamperTemperature = 16,  // as an input
  kHasStaticForce = 32,  // a constant force of the strut shows: in the ride height, in a channel
};

/// A recorded quantity that drives a model.
struct InputInfo {
  std::string name, unit, description;
  bool required = false;
  bool moves = true;        // the model, in proportion; not so a temperature
  bool is_ground = false;   // the position above which the masses rest
  bool is_command = false;  // what it does is not what was asked for, in size or sign
};

/// A weighted sum of channels.
struct ChannelTerm {
  int channel;
  double factor;
};
using ChannelSum = std::vector<ChannelTerm>;

/// The channels of a mass whose start belongs to the measured run.
struct MassInfo {
  int position, velocity;
};

/// Where a strut's motion and forces are found. Deflection and velocity: positive in compression.
struct StrutInfo {
  std::string place;  // as effects name it: "front", "rear"; "" on a rig
  std::string deflection_name, velocity_name;
  ChannelSum deflection, velocity;  // m, m/s
  int spring_force, damper_force;   // channels, N
};

enum class StateKind {
  kDeflection,  // of a strut or its mass
  kVelocity,    // the rate of that
  kTireLoad,
  kGuideVelocity,  // of a mass along what guides it
};

/// A motion or load of the model over which residuals are sorted.
struct StateInfo {
  StateKind kind;
  std::string place;  // as StrutInfo's
  std::string name, unit;
  ChannelSum sum;
};

/// A kind of model.
struct ModelInfo {
  std::string name;  // the `type` of its file
  unsigned parts;    // ModelPart
  std::vector<ChannelInfo> channels;
  /// None: a road drives it, which its maneuver describes and which is not recorded.
  std::vector<InputInfo> inputs;
  std::vector<MassInfo> masses;
  std::vector<StrutInfo> struts;
  std::vector<StateInfo> states;
  /// The whole force of the strut where the stand measures it beside the motion it imposes; -1.
  int stand_force = -1;

  bool has(ModelPart part) const { return (parts & part) != 0; }
  /// By recorded inputs, on the clock of the readings. If not: over a road with its own clock.
  bool is_driven_by_inputs() const { return !inputs.empty(); }
};

/// The sum over samples: at least one term, `channel` by the model's channels.
std::vector<double> calc_sum(const ChannelSum& sum,
                             const std::vector<std::vector<double>>& channel);

/// The number of the channel or input of this name, -1 where there is none.
int find_channel(const ModelInfo& model, const std::string& name);
int find_input(const ModelInfo& model, const std::string& name);

}  // namespace strut
