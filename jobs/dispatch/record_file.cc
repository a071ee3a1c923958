#include "jobs/dispatch/record_file.h"

#include <fcntl.h>
#include <sys/stat.h>

namespace strut {
namespace {

/// A million tasks, each with a line about its end, take half of this.
constexpr off_t kMostBytes = off_t{64} << 20;

}  // namespace

std::optional<std::string> read_record_file(const Folder& folder, const std::string& name) {
  const FileDescriptor file = folder.open_file(name, O_RDONLY);
  if (!file.is_open()) return std::nullopt;
  struct stat status {};
  if (::fstat(file.get(), &status) != 0 || status.st_size > kMostBytes) {
    throw InputError(folder.path_of(name).string() + ": larger than " +
                     std::to_string(kMostBytes >> 20) + " MiB" + kRecordRemedy);
  }
  return read_rest(file.get(), folder.path_of(name));
}

}  // namespace strut
