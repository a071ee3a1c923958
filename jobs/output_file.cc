#include "jobs/output_file.h"

#include <system_error>

#include "sweep/named_files.h"

namespace strut {

namespace fs = std::filesystem;

void check_output_file(const std::string& option, const fs::path& output,
                       const std::vector<fs::path>& inputs) {
  const std::string start = "--" + option + " = " + output.string() + ": ";
  if (fs::is_directory(output)) throw InputError(start + "a folder; must be a file");
  for (const fs::path& input : inputs) {
    std::error_code ignored;
    if (fs::equivalent(output, input, ignored))
      throw InputError(start + "is what is read; must be another file");
  }
  const fs::path folder = fs::absolute(output).parent_path();
  if (!fs::is_directory(folder)) {
    throw EnvironmentError(start + "there is no folder " + folder.string() + "; mkdir -p makes it");
  }
}

std::vector<fs::path> list_files_read(const std::vector<fs::path>& toml_files) {
  std::vector<fs::path> files = toml_files;
  for (const fs::path& file : toml_files) {
    for (const NamedFile& named : list_named_files(file)) files.push_back(named.path);
  }
  return files;
}

fs::path find_output_file(const Arguments& arguments, const std::vector<std::string>& inputs) {
  if (!arguments.has("output"))
    throw arguments.usage_error("--output: missing; name the file to write with -o");
  fs::path output = arguments.text("output");
  check_output_file("output", output, {inputs.begin(), inputs.end()});
  if (fs::exists(output) && !arguments.is_on("force")) {
    throw InputError("--output = " + output.string() + ": exists; --force replaces it");
  }
  return output;
}

fs::path find_output_folder(const Arguments& arguments, const std::string& file,
                            const std::string& content) {
  if (!arguments.has("output"))
    throw arguments.usage_error("--output: missing; name the folder to write with -o");
  fs::path folder = fs::path(arguments.text("output")).lexically_normal();
  const std::string start = "--output = " + folder.string() + ": ";
  if (fs::exists(folder) && !fs::is_directory(folder)) {
    throw InputError(start + "is a file; must be a folder");
  }
  if (fs::exists(folder / file) && !arguments.is_on("force")) {
    throw InputError(start + "holds a " + content + "; --force replaces it");
  }
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw EnvironmentError(folder.string() + ": cannot be made: " + error.message());
  return folder;
}

}  // namespace strut
