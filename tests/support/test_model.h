// A model without a training: random weights, columns with units and ranges of a car's size.
#pragma once

#include <cmath>
#include <vector>

#include "base/math/random.h"
#include "train/model/identifier.h"
#include "train/model/model_file.h"

namespace strut::test {

inline TrainedModel make_random_model(std::vector<int> sizes = {4, 9, 7, 2}) {
  TrainedModel model;
  model.sizes = std::move(sizes);
  model.weights = make_xavier_weights(NetworkShape(model.sizes), 3);
  for (double& w : model.weights) w = w == 0.0 ? 0.1 : w;
  const std::vector<ColumnInfo> inputs = {{"body_position_z", "m", "height"},
                                          {"body_velocity_z", "m/s", "its rate"},
                                          {"body_acceleration_z", "m/s^2", "and that one's"},
                                          {"pitch_angle", "rad", "nose down"}};
  const std::vector<ColumnInfo> targets = {{"front_stiffness", "N/m", "rate"},
                                           {"rear_damping", "N s/m", "rate"}};
  const auto n = static_cast<std::ptrdiff_t>(model.sizes.front());
  const auto m = static_cast<std::ptrdiff_t>(model.sizes.back());
  model.inputs.assign(inputs.begin(), inputs.begin() + n);
  model.targets.assign(targets.begin(), targets.begin() + m);
  const std::vector<double> low = {0.5354, 0.0417, -6.69, -0.00785};
  const std::vector<double> high = {0.5466, 0.0501, 7.33, -0.00109};
  model.input_map = Normalizer({low.begin(), low.begin() + n}, {high.begin(), high.begin() + n});
  const std::vector<double> first = {35500.0, 1800.0}, last = {40000.0, 1980.0};
  model.target_map =
      Normalizer({first.begin(), first.begin() + m}, {last.begin(), last.begin() + m});
  model.ci95.assign(static_cast<std::size_t>(m), 0.25);
  model.plan_hash = std::string(64, 'a');
  model.usable = 10;
  return model;
}

/// `count` rows of inputs, uniform on the model's ranges stretched about their middle.
inline std::vector<double> draw_inputs(const TrainedModel& model, std::size_t count,
                                       double stretch = 1.0) {
  const std::size_t n = model.inputs.size();
  std::vector<double> rows(count * n);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double low = model.input_map.low()[i % n], high = model.input_map.high()[i % n];
    const double share = 0.5 + stretch * (calc_uniform(7, 0, i) - 0.5);
    rows[i] = low + share * (high - low);
  }
  return rows;
}

}  // namespace strut::test
