#include "jobs/cli/output_file.h"

#include <algorithm>
#include <set>
#include <system_error>

#include "io/file/atomic_file.h"
#include "io/store/sweep_folder.h"
#include "model_files/named_files.h"
#include "report/page_file.h"

namespace strut {

namespace fs = std::filesystem;

namespace {

bool is_one_of(const fs::path& file, const std::vector<fs::path>& files) {
  return std::any_of(files.begin(), files.end(), [&](const fs::path& other) {
    std::error_code ignored;
    return fs::equivalent(file, other, ignored);
  });
}

/// The sweep folder of which `path` is a file, or in whose subfolders it lies; symbolic links are
/// followed. Empty: none.
fs::path find_sweep_of(const fs::path& path) {
  const SweepFolder names;
  const std::set<fs::path> files = {names.plan(), names.request(), names.journal()};
  const std::set<fs::path> folders = {names.inputs(),     names.shards(), names.retries(),
                                      names.claims(),     names.logs(),   names.temporary(),
                                      names.quarantine(), "jobs"};  // of dispatch/submission.cc
  fs::path inside = fs::weakly_canonical(fs::absolute(path));
  for (bool is_last = true; inside.has_relative_path(); is_last = false) {
    const fs::path name = inside.filename();
    inside = inside.parent_path();
    const bool is_own = is_last ? files.contains(name) : folders.contains(name);
    if (is_own && fs::exists(SweepFolder{inside}.plan())) return inside;
  }
  return {};
}

/// `shown`: what the option was given.
void refuse_sweep_files(const std::string& option, const fs::path& shown, const fs::path& output) {
  const fs::path sweep = find_sweep_of(output);
  if (sweep.empty()) return;
  throw InputError("--" + option + " = " + shown.string() + ": belongs to the sweep in " +
                   sweep.string() + "; must be another file or folder");
}

}  // namespace

void check_output_folder(const std::string& option, const fs::path& folder) {
  refuse_sweep_files(option, folder, folder / "file");
  if (fs::exists(folder) && !fs::is_directory(folder)) {
    throw InputError("--" + option + " = " + folder.string() + ": is a file; must be a folder");
  }
}

void check_output_file(const std::string& option, const fs::path& output,
                       const std::vector<fs::path>& inputs, bool may_replace,
                       const std::string& remedy) {
  const std::string start = "--" + option + " = " + output.string() + ": ";
  if (fs::is_directory(output)) throw InputError(start + "a folder; must be a file");
  if (fs::exists(output) && !fs::is_regular_file(output)) {
    throw InputError(start + "not a regular file; must be another file");
  }
  refuse_sweep_files(option, output, output);
  if (is_one_of(output, inputs)) {
    throw InputError(start + "is what is read; must be another file");
  }
  const fs::path folder = fs::absolute(output).parent_path();
  if (!fs::is_directory(folder)) {
    throw EnvironmentError(start + "there is no folder " + folder.string() + "; mkdir -p makes it");
  }
  if (!may_replace && fs::exists(output)) throw InputError(start + "exists; " + remedy);
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
  std::vector<fs::path> read(inputs.begin(), inputs.end());
  const auto toml = std::partition(
      read.begin(), read.end(), [](const fs::path& file) { return file.extension() != ".toml"; });
  const std::vector<fs::path> named = list_files_read({toml, read.end()});
  read.erase(toml, read.end());
  read.insert(read.end(), named.begin(), named.end());
  check_output_file("output", output, read, arguments.is_on("force"));
  return output;
}

fs::path find_output_folder(const Arguments& arguments, const FolderContent& content,
                            const std::vector<std::string>& files,
                            const std::vector<fs::path>& inputs) {
  if (!arguments.has("output"))
    throw arguments.usage_error("--output: missing; name the folder to write with -o");
  fs::path folder = fs::path(arguments.text("output")).lexically_normal();
  const std::string start = "--output = " + folder.string() + ": ";
  check_output_folder("output", folder);
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
