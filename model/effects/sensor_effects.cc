// Effects of sensors: the deviation of a reading from its channel.
#include "model/effects/tables.h"

namespace strut {
namespace {

EffectInfo make_sensor_gain() {
  return {EffectName::kSensorGain,
          "the sensor's sensitivity is not what its data sheet states",
          "(1 + e) y",
          "1 to 5 % uncalibrated, 0.02 %/K",
          kOnChannel,
          {make_switch("gain", "1", "e: relative error", -2.0, 9.0, 0.02)}};
}

EffectInfo make_sensor_bias() {
  return {EffectName::kSensorBias,
          "the sensor's reading has a constant offset",
          "y + b",
          "zero-g offset of MEMS accelerometers 0.2 to 0.6 m/s^2, of gyroscopes 0.01 to 0.05 rad/s",
          kOnChannel,
          {make_switch("bias", "unit of the channel", "b: constant offset", -1e6, 1e6, 0.1)}};
}

EffectInfo make_sensor_delay() {
  return {EffectName::kSensorDelay,
          "the reading is late: transport, filters with linear phase",
          "y(t - tau)",
          "1 to 10 ms on a vehicle's bus",
          kOnChannel,
          {make_switch("delay", "s", "tau: time by which the reading is late; < 0: early", -0.03,
                       0.03, 2e-3)}};
}

EffectInfo make_clock_offset() {
  EffectInfo offset = {
      EffectName::kClockOffset,
      "the recorder of the channels is late against that of the inputs: two loggers, a late "
      "trigger",
      "y(t - tau) for every channel",
      "5 to 100 ms between recorders that one trigger or an operator starts",
      kOnChannels,
      {make_switch("offset", "s", "tau: time by which all channels are late; < 0: early", -0.1, 0.1,
                   5e-3)}};
  offset.parameters[0].without = kHasCar;
  return offset;
}

EffectInfo make_sensor_lowpass() {
  return {EffectName::kSensorLowpass,
          "the sensor or its amplifier smooths what it reads",
          "T dz/dt + z = y",
          "first-order filter, corner frequency 1 / (2 pi T)",
          kOnChannel,
          {make_switch("time", "s", "T: time constant", 0.0, 0.03, 2e-3)}};
}

EffectInfo make_sensor_position() {
  return {EffectName::kSensorPosition,
          "the inertial sensor sits elsewhere than the file states",
          "a + dw/dt x s + w x (w x s), s: the shift",
          "rigid body kinematics; 3 to 30 cm, or in the frame of another drawing",
          kOnBody,
          {make_switch("x", "m", "forward", -3.0, 3.0, 0.05, kHasCar),
           make_switch("y", "m", "left", -3.0, 3.0, 0.05, kHasCar),
           make_switch("z", "m", "upward", -3.0, 3.0, 0.05, kHasCar)}};
}

}  // namespace

std::vector<EffectInfo> make_sensor_effects() {
  return {make_sensor_gain(),  make_sensor_bias(),    make_sensor_delay(),
          make_clock_offset(), make_sensor_lowpass(), make_sensor_position()};
}

}  // namespace strut
