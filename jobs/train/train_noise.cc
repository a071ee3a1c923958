#include "jobs/train/train_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "estimate/sensor_noise.h"
#include "io/store/shard_layout.h"
#include "jobs/cli/settings.h"

namespace strut {
namespace {

/// Default and maximum number of noisy copies of each case; with the default a network has too few
/// weights to memorize their noise.
constexpr int kCopies = 8, kMaxCopies = 10'000;
constexpr double kHitTime = 0.005;  // s, default 1 sigma

WindowChoice read_window(const Arguments& arguments) {
  WindowChoice window;
  std::tie(window.from, window.to) = read_time_range(arguments, "window");
  window.reach = arguments.number_or("align", window.reach, between(0.0, 10.0, "s"));
  window.components = static_cast<int>(
      arguments.integer_or("components", window.components, 1, NetworkShape::kLargestSize));
  return window;
}

/// Applies the settings of an option to `values`; "default" stands for no setting.
void apply_noise_settings(const Arguments& arguments, const std::string& option,
                          const std::vector<std::string>& inputs, std::vector<double>& values) {
  std::vector<std::string> settings = arguments.list(option);
  std::erase(settings, "default");
  apply_settings(option, settings, inputs, values);
}

/// Throws InputError for an input that has neither a default noise nor a setting.
void require_noise(const Arguments& arguments, const std::vector<std::string>& inputs,
                   const std::vector<double>& sigma) {
  const std::vector<std::string> settings = arguments.list("noise");
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto gives = [&](const std::string& setting) {
      return setting.starts_with(inputs[i] + "=");
    };
    // NoiseModel::validate checks the values of settings and knows their units.
    if (sigma[i] != 0.0 || std::any_of(settings.begin(), settings.end(), gives)) continue;
    throw InputError(
        fmt::format("--noise: {0} has no default noise; give --noise {0}=SIGMA", inputs[i]));
  }
}

NoiseModel read_noise_model(const Arguments& arguments, const std::vector<std::string>& inputs,
                            bool is_window, std::uint64_t seed) {
  NoiseModel noise;
  noise.sigma = take_channels(make_default_noise(), inputs);
  apply_noise_settings(arguments, "noise", inputs, noise.sigma);
  require_noise(arguments, inputs, noise.sigma);
  noise.bias = is_window ? take_channels(make_default_bias(), inputs)
                         : std::vector<double>(inputs.size(), 0.0);
  apply_noise_settings(arguments, "bias", inputs, noise.bias);
  if (is_window) {
    noise.hit_time = arguments.number_or("hit-time-sigma", kHitTime, between(0.0, 1.0, "s"));
  }
  noise.copies = static_cast<int>(arguments.integer_or("copies", kCopies, 1, kMaxCopies));
  noise.seed = seed;
  return noise;
}

void refuse_without(const Arguments& arguments, const char* option, const char* needs) {
  if (arguments.has(option)) {
    throw arguments.usage_error(fmt::format("--{} needs {}", option, needs));
  }
}

}  // namespace

void add_noise_options(Arguments& arguments) {
  arguments.add_option("window", "FROM:TO",
                       "train on the histories between these times [s], with noise, instead of\n"
                       "the snapshot; --inputs are then channels of the histories, by default all");
  arguments.add_list("noise", "CHANNEL=SIGMA",
                     "train with noise: 1 sigma per sample, repeatable; other channels, with\n"
                     "--noise default all, have the noise of `strut design`");
  arguments.add_list("bias", "CHANNEL=SIGMA",
                     "1 sigma of a sensor's constant bias, repeatable; default: that of\n"
                     "docs/window.md in a window, none in a snapshot");
  arguments.add_option("hit-time-sigma", "S",
                       "1 sigma [s] of the time at which the bump is hit; default 0.005");
  arguments.add_option("align", "S",
                       "shift records by up to S seconds to agree with a reference; default 0.05");
  arguments.add_option("components", "N",
                       "max number of components that a window is reduced to; default 24");
  arguments.add_option("copies", "N", "noisy copies of each case; default 8");
}

void read_noise_options(const Arguments& arguments, const ShardSchema& schema,
                        TrainingRequest& request) {
  const bool is_window = arguments.has("window");
  if (is_window) {
    request.window = read_window(arguments);
    if (!arguments.has("inputs")) request.rows.inputs = list_names(schema.history);
  } else {
    for (const char* option : {"hit-time-sigma", "align", "components"}) {
      refuse_without(arguments, option, "--window FROM:TO");
    }
    if (!arguments.has("noise")) {
      for (const char* option : {"bias", "copies"}) refuse_without(arguments, option, "--noise");
      return;
    }
  }
  // Readers of the data report channels that it lacks.
  request.noise = read_noise_model(arguments, request.rows.inputs, is_window, request.seed);
}

}  // namespace strut
