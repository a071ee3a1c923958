// A trained network.
#pragma once

#include <pybind11/numpy.h>

#include <filesystem>
#include <optional>

#include "train/model/identifier.h"

namespace strut {

class NetworkModel {
 public:
  explicit NetworkModel(const std::filesystem::path& path);

  bool is_window() const { return model_.window.has_value(); }
  /// name, unit, low and high of the training range.
  pybind11::list list_inputs() const;
  /// name, unit, half width of the 95 % interval, low and high of the training range.
  pybind11::list list_targets() const;
  /// [row][input] to [row][target], in the units of the columns.
  pybind11::array predict(
      const pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>&
          inputs) const;

 private:
  TrainedModel model_;
  Identifier identifier_;
};

}  // namespace strut
