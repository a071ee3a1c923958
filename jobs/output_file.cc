#include "jobs/output_file.h"

namespace strut {

namespace fs = std::filesystem;

fs::path find_output_file(const Arguments& arguments, const std::vector<std::string>& inputs) {
  if (!arguments.has("output")) throw arguments.usage_error("--output: missing");
  fs::path output = arguments.text("output");
  const std::string start = "--output = " + output.string() + ": ";
  if (fs::is_directory(output)) throw InputError(start + "a folder; must be a file");
  for (const std::string& input : inputs) {
    std::error_code ignored;
    if (fs::equivalent(output, input, ignored)) throw InputError(start + "is what is read");
  }
  if (fs::exists(output) && !arguments.is_on("force")) {
    throw InputError(start + "exists; --force replaces it");
  }
  // Told before the work, not after it.
  const fs::path folder = fs::absolute(output).parent_path();
  if (!fs::is_directory(folder)) {
    throw EnvironmentError(start + "there is no folder " + folder.string());
  }
  return output;
}

}  // namespace strut
