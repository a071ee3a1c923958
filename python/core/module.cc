// The module strut._core: the rooms as Python sees them. What a user sees is python/strut.

#include <fmt/format.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <tuple>

#include "base/error/input_error.h"
#include "base/text/build_info.h"
#include "model/channel/car_channels.h"
#include "model/error/model_error.h"
#include "model/longest_step.h"
#include "model_files/find_channel.h"
#include "model_files/parameters.h"
#include "model_files/read_maneuver.h"
#include "model_files/read_rig.h"
#include "model_files/read_vehicle.h"
#include "python/core/background.h"
#include "python/core/dataset_arrays.h"
#include "python/core/many_runs.h"
#include "python/core/network.h"
#include "python/core/rig_run.h"
#include "python/core/settings.h"
#include "python/core/single_run.h"
#include "python/core/sweep_run.h"

namespace py = pybind11;

namespace strut {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Settings = std::vector<std::pair<std::string, double>>;
namespace fs = std::filesystem;

/// A car, without a maneuver until it is simulated.
struct Car {
  fs::path path;
  VehicleSpec vehicle;
};

Case make_case(const Car& car, const std::optional<fs::path>& maneuver, const Settings& settings) {
  Case c{car.vehicle, {}};
  if (maneuver) c.maneuver = read_maneuver(*maneuver);
  for (const auto& [name, value] : settings) set_parameter(c, name, value);
  return c;
}

/// A rig, without inputs until it is simulated.
struct RigModel {
  fs::path path;
  RigSpec spec;
};

RigModel read_rig_file(const fs::path& path) {
  if (!find_rig_kind(path)) {
    throw InputError(path.string() + ": a vehicle; must be a rig: strut.load reads vehicles");
  }
  return {path, read_rig(path)};
}

/// An array of `values` that lives as long as the array does.
template <class Number>
py::array own(std::vector<Number> values, std::vector<py::ssize_t> shape) {
  auto* kept = new std::vector<Number>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<Number>*>(p); });
  return py::array_t<Number>(std::move(shape), kept->data(), owner);
}

/// A finished run; its arrays are views into it.
struct Run {
  std::shared_ptr<const LaneResults> results;
  std::vector<int> channels;
  double interval = 0.0;

  const LaneResults& get(int direction) const {
    return direction < 0 ? *results : results->slopes.at(static_cast<std::size_t>(direction));
  }
  /// Samples of the `column`-th channel, or of its derivative along a direction.
  double get_snapshot(int channel, int direction) const {
    const LaneResults& from = get(direction);
    return from.snapshot.empty() ? std::numeric_limits<double>::quiet_NaN()
                                 : from.get_snapshot(channel);
  }
  py::array view(int column, int direction) const {
    const LaneResults& from = get(direction);
    const auto row = py::ssize_t{from.recorded_count()} * from.lanes;
    const int channel = channels.at(static_cast<std::size_t>(column));
    const int recorded = results->recorded.empty() ? channel : column;
    const auto* owner = new std::shared_ptr<const LaneResults>(results);
    const py::capsule kept(
        owner, [](void* p) { delete static_cast<std::shared_ptr<const LaneResults>*>(p); });
    const double* first = from.history.data() + from.find_sample(0, recorded);
    const py::ssize_t bytes = sizeof(double);
    py::array array(py::dtype::of<double>(), {static_cast<py::ssize_t>(from.sample_count)},
                    {bytes * row}, first, kept);
    array.attr("setflags")(py::arg("write") = false);
    return array;
  }
};

std::vector<int> find_channels(const std::vector<std::string>& names) {
  std::vector<int> channels;
  channels.reserve(names.size());
  for (const std::string& name : names) channels.push_back(find_car_channel(name));
  return channels;
}

/// Throws InputError for a rate [Hz] out of range, and where `series` histories of `duration` [s]
/// would not fit into memory.
void check_samples(double rate, double duration, double series) {
  constexpr double kMaxSamples = 2e6, kMaxNumbers = 4e9;  // of a run; 32 GB
  if (!(rate >= 1.0) || !(rate <= 1e6)) {
    throw InputError(fmt::format("rate = {} Hz: must lie in [1, 1000000]", rate));
  }
  const double samples = rate * duration;
  if (samples <= kMaxSamples && samples * series <= kMaxNumbers) return;
  throw InputError(
      fmt::format("rate = {} Hz: {:.3g} samples of {:.3g} histories; allowed: {:g} of one "
                  "history, {:g} of all",
                  rate, samples, series, kMaxSamples, kMaxNumbers));
}

Run simulate(const Car& car, const fs::path& maneuver, const Settings& settings, double rate,
             const std::vector<std::string>& channels, const std::vector<std::string>& derivatives,
             const IntegrationWords& words) {
  SingleRequest request{
      make_case(car, maneuver, settings), {}, 1.0 / rate, find_channels(channels), derivatives};
  check_samples(rate, request.setup.maneuver.duration,
                static_cast<double>(channels.size() * (1 + derivatives.size())));
  request.integrate = read_single_run(words, calc_longest_step(request.setup));
  Run run{nullptr, request.channels, request.interval};
  run_in_background([&](std::atomic<bool>&) {
    run.results = std::make_shared<const LaneResults>(simulate_single(request));
  });
  return run;
}

/// A recorded input: name, times [s], values [SI].
using RecordedInput = std::tuple<std::string, std::vector<double>, std::vector<double>>;

/// Without a maneuver's file the inputs are those given, as splines, until the last of them ends.
Run simulate_rig_file(const RigModel& rig, const std::optional<fs::path>& maneuver,
                      const std::vector<RecordedInput>& inputs, std::optional<double> duration,
                      const Settings& settings, double rate,
                      const std::vector<std::string>& channels, const IntegrationWords& words) {
  RigSpec spec = rig.spec;
  for (const auto& [name, value] : settings) set_rig_parameter(spec, name, value);
  RigManeuver drive;
  if (maneuver) drive = read_rig_maneuver(*maneuver, spec.kind);
  for (const auto& [name, times, values] : inputs) {
    drive.inputs.push_back(make_signal(name, times, values, Interpolation::kSpline));
    drive.duration = std::max(drive.duration, drive.inputs.back().end);
  }
  if (duration) drive.duration = *duration;
  if (!(drive.duration > 0.0)) {
    throw InputError(fmt::format("duration = {} s: must be > 0", drive.duration));
  }
  check_samples(rate, drive.duration, static_cast<double>(channels.size()));
  Run run{nullptr, {}, 1.0 / rate};
  for (const std::string& name : channels) {
    run.channels.push_back(require_channel(get_rig_info(spec.kind), name));
  }
  run_in_background([&](std::atomic<bool>&) {
    run.results =
        std::make_shared<const LaneResults>(simulate_rig_run(spec, drive, words, run.interval));
  });
  return run;
}

py::list list_rig_parameter_table(const RigModel& rig) {
  py::list list;
  for (const RigParameter& p : list_rig_parameters(rig.spec.kind)) {
    list.append(py::make_tuple(p.name, p.unit, p.description, p.get(rig.spec), p.allowed.low,
                               p.allowed.high, false));
  }
  return list;
}

/// name, unit, description.
template <class Infos>
py::list list_infos(const Infos& infos) {
  py::list list;
  for (const auto& info : infos) {
    list.append(py::make_tuple(info.name, info.unit, info.description));
  }
  return list;
}

py::dict simulate_cases(const Car& car, const fs::path& maneuver, const Settings& settings,
                        const std::vector<std::string>& parameters, const Array& values,
                        const std::vector<std::string>& channels, bool snapshot,
                        std::optional<double> rate, double offset, int threads,
                        const IntegrationWords& words) {
  if (values.ndim() != 2 || values.shape(1) != static_cast<py::ssize_t>(parameters.size())) {
    throw InputError("values: must have a column for each parameter");
  }
  ManyRequest request;
  request.base = make_case(car, maneuver, settings);
  for (const std::string& name : parameters) request.parameters.push_back(&find_parameter(name));
  request.count = static_cast<std::size_t>(values.shape(0));
  request.values.assign(values.data(), values.data() + values.size());
  request.channels = find_channels(channels);
  request.threads = threads;
  const ManyNeeds needs = find_needs(request);
  BatchPlan& plan = request.plan;
  plan.integrate =
      read_many_runs(words, needs.longest_step, {rate.has_value(), needs.lowest_speed});
  plan.snapshot_offset = offset;
  plan.samples.snapshot = snapshot;
  plan.samples.until_snapshot = snapshot && !rate;
  if (rate) {
    check_samples(*rate, needs.duration, static_cast<double>(channels.size() * request.count));
    plan.samples.interval = 1.0 / *rate;
    if (!needs.has_sensors) plan.samples.recorded = request.channels;
  }
  ManyResults results;
  run_in_background(
      [&](std::atomic<bool>& stop) { results = simulate_many(request, needs.duration, stop); });
  const auto cases = static_cast<py::ssize_t>(request.count);
  const auto series = static_cast<py::ssize_t>(channels.size());
  const auto samples = static_cast<py::ssize_t>(results.sample_count);
  py::dict all;
  all["status"] = own(std::move(results.status), {cases});
  all["failure_time"] = own(std::move(results.failure_time), {cases});
  all["event_time"] = own(std::move(results.event_time), {cases});
  all["reason"] = results.reason;
  if (snapshot) all["snapshot"] = own(std::move(results.snapshot), {series, cases});
  if (rate) all["history"] = own(std::move(results.history), {series, cases, samples});
  return all;
}

/// name, unit, description, default, low, high, whether it belongs to the maneuver.
py::list list_case_parameters(const Car& car, const std::optional<fs::path>& maneuver) {
  const Case c = make_case(car, maneuver, {});
  py::list list;
  for (const ParameterInfo& p : list_parameters()) {
    list.append(py::make_tuple(p.name, p.unit, p.description, p.get(c), p.allowed.low,
                               p.allowed.high, p.is_maneuver));
  }
  return list;
}

py::list list_channels() { return list_infos(list_car_channels()); }

py::list list_statuses() {
  py::list list;
  for (const RunStatusInfo& info : kRunStatuses) {
    list.append(py::make_tuple(info.name, info.reason));
  }
  return list;
}

IntegrationWords make_words(std::optional<std::string> integrator,
                            std::optional<std::string> closure, std::optional<std::string> spin,
                            std::optional<double> step, std::optional<double> coarse_step,
                            bool events) {
  return {std::move(integrator), std::move(closure), std::move(spin), step, coarse_step, events};
}

/// Raises an error of strut._errors with a text in the encoding of file names, which it may
/// contain.
void raise(PyObject* type, const char* text) {
  const auto message = py::reinterpret_steal<py::object>(PyUnicode_DecodeFSDefault(text));
  PyErr_SetObject(type, message.ptr());
}

/// Errors keep their text; python/strut/_errors.py takes it apart.
void translate_errors() {
  // Kept for good: the interpreter may end before the objects of this library do.
  const py::module_ errors = py::module_::import("strut._errors");
  static PyObject* const input = py::object(errors.attr("InputError")).release().ptr();
  static PyObject* const environment = py::object(errors.attr("EnvironmentError")).release().ptr();
  py::register_local_exception_translator([](std::exception_ptr error) {
    try {
      std::rethrow_exception(std::move(error));
    } catch (const InputError& e) {
      raise(input, e.what());
    } catch (const ModelError& e) {
      raise(input, e.what());
    } catch (const EnvironmentError& e) {
      raise(environment, e.what());
    } catch (const std::system_error& e) {  // files, too
      raise(environment, e.what());
    }
  });
}

}  // namespace
}  // namespace strut

PYBIND11_MODULE(_core, m) {
  using strut::Car;
  using strut::IntegrationWords;
  using strut::RigModel;
  using strut::Run;
  m.doc() = "The rooms of strut; use the package strut.";
  strut::translate_errors();
  strut::end_work_with_interpreter();
  m.attr("version") = strut::get_build_info().version;
  m.attr("commit") = strut::get_build_info().commit;

  py::class_<IntegrationWords>(m, "Integration")
      .def(py::init(&strut::make_words), py::kw_only(), py::arg("integrator") = py::none(),
           py::arg("closure") = py::none(), py::arg("spin") = py::none(),
           py::arg("step") = py::none(), py::arg("coarse_step") = py::none(),
           py::arg("events") = true);

  py::class_<Car>(m, "Car")
      .def(py::init([](const std::filesystem::path& path) {
             return Car{path, strut::read_vehicle(path)};
           }),
           py::arg("path"))
      .def_readonly("path", &Car::path)
      .def("list_parameters", &strut::list_case_parameters, py::arg("maneuver") = py::none())
      .def("simulate", &strut::simulate, py::arg("maneuver"), py::arg("settings"), py::arg("rate"),
           py::arg("channels"), py::arg("derivatives"), py::arg("integration"))
      .def("simulate_many", &strut::simulate_cases, py::arg("maneuver"), py::arg("settings"),
           py::arg("parameters"), py::arg("values"), py::arg("channels"), py::arg("snapshot"),
           py::arg("rate"), py::arg("offset"), py::arg("threads"), py::arg("integration"));

  py::class_<RigModel>(m, "Rig")
      .def(py::init(&strut::read_rig_file), py::arg("path"))
      .def_readonly("path", &RigModel::path)
      .def("list_parameters", &strut::list_rig_parameter_table)
      .def("list_channels",
           [](const RigModel& r) {
             return strut::list_infos(strut::get_rig_info(r.spec.kind).channels);
           })
      .def("list_inputs",
           [](const RigModel& r) {
             return strut::list_infos(strut::get_rig_info(r.spec.kind).inputs);
           })
      .def("simulate", &strut::simulate_rig_file, py::arg("maneuver"), py::arg("inputs"),
           py::arg("duration"), py::arg("settings"), py::arg("rate"), py::arg("channels"),
           py::arg("integration"));

  py::class_<Run>(m, "Run")
      .def("view", &Run::view, py::arg("column"), py::arg("direction") = -1)
      .def_readonly("interval", &Run::interval)
      .def_property_readonly("sample_count", [](const Run& r) { return r.results->sample_count; })
      .def_property_readonly("status", [](const Run& r) { return r.results->status[0]; })
      .def_property_readonly("failure_time",
                             [](const Run& r) { return r.results->get_failure_time(); })
      .def(
          "event_time",
          [](const Run& r, int direction) { return r.get(direction).get_event_time(); },
          py::arg("direction") = -1)
      .def("snapshot", &Run::get_snapshot, py::arg("channel"), py::arg("direction") = -1);

  m.def("list_channels", &strut::list_channels);
  m.def("list_statuses", &strut::list_statuses);
  m.def("run_sweep", &strut::run_folder, py::arg("folder"), py::arg("threads"),
        py::arg("retry_failed"), py::arg("watch"));
  m.def("read_dataset", &strut::read_dataset, py::arg("paths"), py::arg("partial"),
        py::arg("histories"));

  py::class_<strut::NetworkModel>(m, "Network")
      .def(py::init<const std::filesystem::path&>(), py::arg("path"))
      .def_property_readonly("inputs", &strut::NetworkModel::list_inputs)
      .def_property_readonly("targets", &strut::NetworkModel::list_targets)
      .def_property_readonly("is_window", &strut::NetworkModel::is_window)
      .def("predict", &strut::NetworkModel::predict, py::arg("inputs"));
}
