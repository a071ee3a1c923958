// Effects of sensors: from a channel's samples to what a sensor with its faults would read.
#pragma once

#include "model/effects/catalogue.h"

namespace strut {

/// (1 + e) y + b, late by tau, behind a first-order filter of time constant T: the reading at the
/// times of `values` under the settings' sensor_gain, sensor_bias, sensor_delay and sensor_lowpass
/// at `channel`. Between samples y is a cubic spline, before the first and after the last it
/// stands still; the filter starts settled. `times` [s] ascending, of the length of `values`.
/// Unchanged, bit for bit, where no such effect is on. Throws std::invalid_argument for times that
/// do not ascend.
std::vector<double> read_sensor(const EffectSettings& settings, ModelKind kind,
                                const std::string& channel, const std::vector<double>& times,
                                std::vector<double> values);

}  // namespace strut
