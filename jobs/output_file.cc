#include "jobs/output_file.h"

#include <algorithm>
#include <system_error>

#include "io/atomic_file.h"
#include "jobs/report/page_file.h"
#include "sweep/named_files.h"

namespace strut {

namespace fs = std::filesystem;

namespace {

bool is_one_of(const fs::path& file, const std::vector<fs::path>& files) {
  return std::any_of(files.begin(), files.end(), [&](const fs::path& other) {
    std::error_code ignored;
    return fs::equivalent(file, other, ignored);
  });
}

}  // namespace

void check_output_file(const std::string& option, const fs::path& output,
                       const std::vector<fs::path>& inputs) {
  const std::string start = "--" + option + " = " + output.string() + ": ";
  if (fs::is_directory(output)) throw InputError(start + "a folder; must be a file");
  if (is_one_of(output, inputs)) {
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

fs::path find_output_folder(const Arguments& arguments, const FolderContent& content,
                            const std::vector<std::string>& files,
                            const std::vector<fs::path>& inputs) {
  if (!arguments.has("output"))
    throw arguments.usage_error("--output: missing; name the folder to write with -o");
  fs::path folder = fs::path(arguments.text("output")).lexically_normal();
  const std::string start = "--output = " + folder.string() + ": ";
  if (fs::exists(folder) && !fs::is_directory(folder)) {
    throw InputError(start + "is a file; must be a folder");
  }
  if (fs::exists(folder / content.file) && !arguments.is_on("force")) {
    throw InputError(start + "holds a " + content.name + "; --force replaces it");
  }
  std::vector<fs::path> written;
  for (const std::string& file : files) {
    written.push_back(folder / file);
    if (is_one_of(written.back(), inputs)) {
      throw InputError(start + "holds " + file + ", which is read; must be another folder");
    }
  }
  check_page_folder("output", {folder}, content, written);
  make_folder(folder);
  return folder;
}

}  // namespace strut
