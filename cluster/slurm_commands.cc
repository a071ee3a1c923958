#include "cluster/slurm_commands.h"

#include <fmt/format.h>

#include <sstream>

#include "base/error/input_error.h"

namespace strut::slurm {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

ChildOutput call(const std::vector<std::string>& words) {
  ChildOptions options;
  options.hidden_variables = {"SBATCH_", "SQUEUE_", "SINFO_", "SCANCEL_", "SLURM_CLUSTERS="};
  return read_child(words, options);
}

std::string ask(const std::vector<std::string>& words) {
  const ChildOutput output = call(words);
  if (output.code == 0) return output.out;
  throw EnvironmentError(fmt::format("{}: {}", words.front(), output.explain()));
}

Settings read_settings() {
  Settings settings;
  for (const std::string& line : split(ask({"scontrol", "show", "config"}), '\n')) {
    std::istringstream words(line);
    std::string key, equals, value;
    if (words >> key >> equals >> value && equals == "=") settings[key] = value;
  }
  return settings;
}

}  // namespace strut::slurm
