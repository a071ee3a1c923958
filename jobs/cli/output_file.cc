#include "jobs/cli/output_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "io/file/atomic_file.h"
#include "io/file/file_seal.h"
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

/// Returns the sweep folder of which `path` is a file or in whose subfolders it lies; symbolic
/// links are followed. Empty: none.
fs::path find_sweep_of(const fs::path& path) {
  const SweepFolder names;
  const std::set<fs::path> files = {names.plan(), names.request(), names.journal()};
  const std::set<fs::path> folders = {names.inputs(),     names.shards(), names.retries(),
                                      names.claims(),     names.logs(),   names.temporary(),
                                      names.quarantine(), "jobs"};  // cluster/submission.cc
  fs::path inside = fs::weakly_canonical(fs::absolute(path));
  for (bool is_last = true; inside.has_relative_path(); is_last = false) {
    const fs::path name = inside.filename();
    inside = inside.parent_path();
    const bool is_own = is_last ? files.contains(name) : folders.contains(name);
    if (is_own && fs::exists(SweepFolder{inside}.plan())) return inside;
  }
  return {};
}

/// The start of every message: "--output = FILE: ".
std::string name_option(const std::string& option, const fs::path& value) {
  return fmt::format("--{} = {}: ", option, value.string());
}

/// Refuses an `output` inside a sweep; `value`: the option's value.
void refuse_sweep_files(const std::string& option, const fs::path& value, const fs::path& output) {
  const fs::path sweep = find_sweep_of(output);
  if (sweep.empty()) return;
  throw InputError(fmt::format("{}part of the sweep in {}; name another file or folder",
                               name_option(option, value), sweep.string()));
}

}  // namespace

void check_output_folder(const std::string& option, const fs::path& folder) {
  refuse_sweep_files(option, folder, folder / "file");
  if (fs::exists(folder) && !fs::is_directory(folder)) {
    throw InputError(name_option(option, folder) + "is a file; must be a folder");
  }
}

void check_output_file(const std::string& option, const fs::path& output,
                       const std::vector<fs::path>& inputs, bool may_replace,
                       const std::string& remedy, const std::string& seal) {
  const std::string start = name_option(option, output);
  if (fs::is_directory(output)) throw InputError(start + "is a folder; must be a file");
  if (fs::exists(output) && !fs::is_regular_file(output)) {
    throw InputError(start + "not a regular file; name another file");
  }
  refuse_sweep_files(option, output, output);
  if (is_one_of(output, inputs)) {
    throw InputError(start + "is an input of this command; name another file");
  }
  const fs::path folder = fs::absolute(output).parent_path();
  if (!fs::is_directory(folder)) {
    throw EnvironmentError(
        fmt::format("{}there is no folder {}; create it with mkdir -p", start, folder.string()));
  }
  if (!may_replace && fs::exists(output))
    throw InputError(fmt::format("{}exists; {}", start, remedy));
  if (!fs::exists(output)) return;
  const std::string found = find_seal_kind(output);
  if (!found.empty() && found != seal) {
    throw InputError(fmt::format(
        "{}is a {} file, which this command does not write; name another file", start, found));
  }
}

void refuse_source(const std::string& option, const fs::path& output) {
  const std::string ending = output.extension().string();
  if (ending != ".toml" && ending != ".tir") return;
  throw InputError(name_option(option, output) +
                   "the name of a vehicle, maneuver, sweep or tire; must be another, as FILE.h5");
}

std::vector<fs::path> list_files_read(const std::vector<fs::path>& toml_files) {
  std::vector<fs::path> files = toml_files;
  for (const fs::path& file : toml_files) {
    for (const NamedFile& named : list_named_files(file)) files.push_back(named.path);
  }
  return files;
}

fs::path find_output_file(const Arguments& arguments, const std::vector<std::string>& inputs,
                          const std::string& seal) {
  if (!arguments.has("output"))
    throw arguments.usage_error("--output: missing; name the file to write with -o");
  fs::path output = arguments.text("output");
  std::vector<fs::path> read(inputs.begin(), inputs.end());
  const auto toml = std::partition(
      read.begin(), read.end(), [](const fs::path& file) { return file.extension() != ".toml"; });
  const std::vector<fs::path> named = list_files_read({toml, read.end()});
  read.erase(toml, read.end());
  read.insert(read.end(), named.begin(), named.end());
  check_output_file("output", output, read, arguments.is_on("force"), "--force replaces it", seal);
  return output;
}

fs::path find_output_folder(const Arguments& arguments, const FolderContent& content,
                            const std::vector<std::string>& files,
                            const std::vector<fs::path>& inputs) {
  if (!arguments.has("output"))
    throw arguments.usage_error("--output: missing; name the folder to write with -o");
  fs::path folder = fs::path(arguments.text("output")).lexically_normal();
  const std::string start = name_option("output", folder);
  check_output_folder("output", folder);
  if (fs::exists(folder / content.file) && !arguments.is_on("force")) {
    throw InputError(fmt::format("{}holds a {}; --force replaces it", start, content.name));
  }
  std::vector<fs::path> written;
  for (const std::string& file : files) {
    written.push_back(folder / file);
    if (is_one_of(written.back(), inputs)) {
      throw InputError(
          fmt::format("{}holds {}, an input of this command; name another folder", start, file));
    }
  }
  check_page_folder("output", {folder}, content, written);
  make_folder(folder);
  return folder;
}

}  // namespace strut
