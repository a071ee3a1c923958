// identify MODEL.h5 VEHICLE.toml MANEUVER.toml RUN.h5: springs and dampers of the car that drove
// RUN, by a trained network from its snapshot, and by fitting the simulation to its histories.
#include <cstdio>
#include <exception>

#include "estimate/fit.h"
#include "estimate/nuisances.h"
#include "io/store/measurement.h"
#include "model_files/read_maneuver.h"
#include "model_files/read_vehicle.h"
#include "train/model/identifier.h"

namespace {

void identify_by_network(const char* model_file, const char* run_file) {
  const strut::TrainedModel model = strut::read_trained_model(model_file);
  std::vector<std::string> names;
  for (const auto& input : model.inputs) names.push_back(input.name);
  const strut::Measurement snapshot = strut::read_measurement(run_file, {names});
  std::vector<double> inputs, values(model.targets.size());
  for (std::size_t i = 0; i < model.inputs.size(); ++i) {
    const auto [low, high] = std::pair{model.input_map.low()[i], model.input_map.high()[i]};
    inputs.push_back(snapshot.columns[i].values.front());
    if (strut::calc_excess(inputs[i], low, high) != 0.0) {  // the network knows nothing there
      std::printf("outside %s\n", model.inputs[i].name.c_str());
    }
  }
  strut::Identifier(model).identify(inputs.data(), values.data());
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::printf("network %s %.17g +- %.17g %s\n", model.targets[i].name.c_str(), values[i],
                model.ci95[i], model.targets[i].unit.c_str());
  }
}

int identify_by_fit(const strut::Case& setup, const char* run_file) {
  const strut::MeasurementRequest request{
      {"time", "imu_acceleration_z", "imu_rate_y"}, {}, strut::MeasuredPart::kHistory};
  const strut::Measurement history = strut::read_measurement(run_file, request);
  const strut::SensorNoise noise = strut::make_default_noise();  // 1 sigma of each channel
  strut::MeasuredRun run{run_file, setup, history.values("time"), {}};
  for (const int c : {strut::CarChannel::kImuAccelerationZ, strut::CarChannel::kImuRateY}) {
    const std::string& name = strut::list_car_channels()[c].name;
    run.channels.push_back({c, noise[c], history.values(name)});
  }
  std::vector<strut::Unknown> unknowns;
  for (const char* name : {"front_stiffness", "front_damping", "rear_stiffness", "rear_damping"}) {
    unknowns.push_back(strut::make_parameter({run}, name));
  }
  const std::size_t parameters = unknowns.size();
  // Time of the hit, speed, the sensors' biases.
  for (const auto& u : strut::make_nuisances({run}, {}, unknowns)) unknowns.push_back(u);
  const strut::FitResult fit = strut::fit_simulation({run}, unknowns);
  for (std::size_t i = 0; i < parameters; ++i) {
    std::printf("fit %s %.17g +- %.17g %s\n", unknowns[i].name.c_str(), fit.values[i],
                1.96 * fit.uncertainty.sigma[i], unknowns[i].unit.c_str());
  }
  return fit.converged ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  try {
    identify_by_network(argv[1], argv[4]);
    return identify_by_fit({strut::read_vehicle(argv[2]), strut::read_maneuver(argv[3])}, argv[4]);
  } catch (const std::exception& e) {  // InputError: what is wrong with which file
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
