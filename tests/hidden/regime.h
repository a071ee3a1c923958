// Regimes of trials: errors of the sensors, misfits of the machine, sizes of the hidden effects.
#pragma once

#include <string>

namespace strut::hidden {

enum class Regime {
  kExact,    // white noise, biases and clocks; the hidden effect alone
  kSensors,  // and gain errors, skews, drift and hum within data sheets
  kMachine   // and effects of realistic size, beside small misfits that every machine has
};

/// "exact", "sensors" or "machine"; throws std::invalid_argument for others.
Regime make_regime(const std::string& name);

}  // namespace strut::hidden
