#include "jobs/train/train_noise.h"

#include <algorithm>

#include "base/text/nearest_name.h"
#include "base/text/parse_number.h"
#include "estimate/sensor_noise.h"
#include "io/store/shard_layout.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

/// Copies of each case: enough that fitting their noise by heart costs more weights than there are.
constexpr int kCopies = 8, kMostCopies = 10'000;
/// s, 1 sigma of when the bump is hit.
constexpr double kHitTime = 0.005;

/// A part of `window`, the option's value.
double read_time(const std::string& window, const std::string& part) {
  if (const auto value = parse_number<double>(part)) return *value;
  throw InputError("--window = " + window + ": must be FROM:TO in s, as 0.3:2.5");
}

WindowChoice read_window(const Arguments& arguments) {
  const std::string text = arguments.text("window");
  const std::size_t colon = text.find(':');
  WindowChoice window;
  window.from = read_time(text, text.substr(0, colon));
  window.to = read_time(text, colon == std::string::npos ? "" : text.substr(colon + 1));
  window.reach = arguments.number_or("align", window.reach, between(0.0, 10.0, "s"));
  window.components = static_cast<int>(
      arguments.integer_or("components", window.components, 1, NetworkShape::kLargestSize));
  return window;
}

std::size_t find_input(const std::string& option, const std::vector<std::string>& inputs,
                       const std::string& name) {
  const auto at = std::find(inputs.begin(), inputs.end(), name);
  if (at != inputs.end()) return static_cast<std::size_t>(at - inputs.begin());
  throw InputError("--" + option + ": '" + name + "' is no input" + suggest_name(name, inputs) +
                   "; they are: " + join_names(inputs));
}

std::pair<std::string, double> read_setting(const std::string& option, const std::string& setting) {
  try {
    return parse_setting(setting);
  } catch (const InputError& e) {
    throw InputError("--" + option + " " + e.what());
  }
}

/// Values of CHANNEL=SIGMA in place of those of `values`.
void apply_settings(const Arguments& arguments, const std::string& option,
                    const std::vector<std::string>& inputs, std::vector<double>& values) {
  for (const std::string& setting : arguments.list(option)) {
    if (setting == "default") continue;
    const auto [name, sigma] = read_setting(option, setting);
    values[find_input(option, inputs, name)] = sigma;
  }
}

void require_noise(const Arguments& arguments, const std::vector<std::string>& inputs,
                   const std::vector<double>& sigma) {
  const std::vector<std::string> settings = arguments.list("noise");
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto gives = [&](const std::string& setting) {
      return setting.starts_with(inputs[i] + "=");
    };
    // What the option gives is judged with its unit, by NoiseModel::validate.
    if (sigma[i] != 0.0 || std::any_of(settings.begin(), settings.end(), gives)) continue;
    throw InputError("--noise: no sensor of " + inputs[i] + " is known; give --noise " + inputs[i] +
                     "=SIGMA");
  }
}

NoiseModel read_noise_model(const Arguments& arguments, const std::vector<std::string>& inputs,
                            bool of_window, std::uint64_t seed) {
  NoiseModel noise;
  noise.sigma = take_channels(make_default_noise(), inputs);
  apply_settings(arguments, "noise", inputs, noise.sigma);
  require_noise(arguments, inputs, noise.sigma);
  noise.bias = of_window ? take_channels(make_default_bias(), inputs)
                         : std::vector<double>(inputs.size(), 0.0);
  apply_settings(arguments, "bias", inputs, noise.bias);
  if (of_window) {
    noise.hit_time = arguments.number_or("hit-time-sigma", kHitTime, between(0.0, 1.0, "s"));
  }
  noise.copies = static_cast<int>(arguments.integer_or("copies", kCopies, 1, kMostCopies));
  noise.seed = seed;
  return noise;
}

void require_alone(const Arguments& arguments, const char* option, const char* needs) {
  if (arguments.has(option)) {
    throw arguments.usage_error("--" + std::string(option) + " needs " + needs);
  }
}

}  // namespace

void add_noise_options(Arguments& arguments) {
  arguments.add_option("window", "FROM:TO",
                       "train on the histories between these times [s], with noise, in place of\n"
                       "the snapshot; --inputs are channels of the histories then, by default all");
  arguments.add_list("noise", "CHANNEL=SIGMA",
                     "train with noise: 1 sigma per sample, repeatable; others, and with\n"
                     "--noise default all: those of `strut design`");
  arguments.add_list("bias", "CHANNEL=SIGMA",
                     "1 sigma of a sensor's constant bias, repeatable; by default that of\n"
                     "docs/window.md in a window, none in a snapshot");
  arguments.add_option("hit-time-sigma", "S",
                       "1 sigma of the time at which the bump is hit; default 0.005");
  arguments.add_option("align", "S",
                       "records are shifted by up to S to agree with a reference; default 0.05");
  arguments.add_option("components", "N", "most numbers that a window is reduced to; default 24");
  arguments.add_option("copies", "N", "noisy copies of each case; default 8");
}

void read_noise_options(const Arguments& arguments, const ShardSchema& schema,
                        TrainingRequest& request) {
  const bool of_window = arguments.has("window");
  if (of_window) {
    request.window = read_window(arguments);
    if (!arguments.has("inputs")) request.rows.inputs = list_names(schema.history);
  } else {
    for (const char* option : {"hit-time-sigma", "align", "components"}) {
      require_alone(arguments, option, "--window FROM:TO");
    }
    if (!arguments.has("noise")) {
      for (const char* option : {"bias", "copies"}) require_alone(arguments, option, "--noise");
      return;
    }
  }
  // What the data does not have is told by those who read it.
  request.noise = read_noise_model(arguments, request.rows.inputs, of_window, request.seed);
}

}  // namespace strut
