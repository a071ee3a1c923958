#include "python/core/network.h"

#include <fmt/format.h>

#include "base/error/input_error.h"
#include "python/core/background.h"

namespace py = pybind11;

namespace strut {

NetworkModel::NetworkModel(const std::filesystem::path& path)
    : model_(read_trained_model(path)), identifier_(model_) {}

py::list NetworkModel::list_inputs() const {
  py::list list;
  for (std::size_t i = 0; i < model_.inputs.size(); ++i) {
    list.append(py::make_tuple(model_.inputs[i].name, model_.inputs[i].unit,
                               model_.input_map.low()[i], model_.input_map.high()[i]));
  }
  return list;
}

py::list NetworkModel::list_targets() const {
  py::list list;
  for (std::size_t i = 0; i < model_.targets.size(); ++i) {
    list.append(py::make_tuple(model_.targets[i].name, model_.targets[i].unit, model_.ci95[i],
                               model_.target_map.low()[i], model_.target_map.high()[i]));
  }
  return list;
}

py::array NetworkModel::predict(
    const py::array_t<double, py::array::c_style | py::array::forcecast>& inputs) const {
  const std::size_t width = model_.inputs.size(), targets = model_.targets.size();
  if (inputs.ndim() != 2 || inputs.shape(1) != static_cast<py::ssize_t>(width)) {
    throw InputError(fmt::format("inputs: must have rows of {} values, one for each input", width));
  }
  const auto rows = static_cast<std::size_t>(inputs.shape(0));
  py::array_t<double> values({inputs.shape(0), static_cast<py::ssize_t>(targets)});
  const double* from = inputs.data();
  double* to = values.mutable_data();
  run_in_background([&](std::atomic<bool>& stop) {
    for (std::size_t row = 0; row < rows && !stop; ++row) {
      identifier_.identify(from + row * width, to + row * targets);
    }
  });
  return values;
}

}  // namespace strut
