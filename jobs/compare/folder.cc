#include "jobs/compare/folder.h"

#include <system_error>

namespace strut {

CompareFolder find_compare_folder(const Arguments& arguments) {
  if (!arguments.has("output")) throw arguments.usage_error("--output: missing");
  const CompareFolder folder{std::filesystem::path(arguments.text("output")).lexically_normal()};
  if (std::filesystem::exists(folder.root) && !std::filesystem::is_directory(folder.root)) {
    throw InputError("--output = " + folder.root.string() + ": is a file; must be a folder");
  }
  if (std::filesystem::exists(folder.json()) && !arguments.is_on("force")) {
    throw InputError("--output = " + folder.root.string() +
                     ": holds a comparison; --force replaces it");
  }
  std::error_code error;
  std::filesystem::create_directories(folder.root, error);
  if (error) throw EnvironmentError(folder.root.string() + ": cannot be made: " + error.message());
  return folder;
}

}  // namespace strut
