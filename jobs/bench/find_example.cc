#include "jobs/bench/find_example.h"

#include <fmt/format.h>

#include <system_error>

#include "base/error/input_error.h"

namespace strut {

namespace fs = std::filesystem;

fs::path find_example(const fs::path& name) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  for (fs::path folder : {program.parent_path(), fs::current_path(error)}) {
    for (; !folder.empty(); folder = folder.parent_path()) {
      for (const char* examples : {"examples", "share/strut/examples"}) {
        fs::path candidate = folder / examples / name;
        if (fs::exists(candidate, error)) return candidate;
      }
      if (folder == folder.root_path()) break;
    }
  }
  throw InputError(fmt::format(
      "examples/{}: not found above the program or the working directory; name a vehicle and a "
      "maneuver",
      name.string()));
}

}  // namespace strut
