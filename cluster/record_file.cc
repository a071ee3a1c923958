#include "cluster/record_file.h"

namespace strut {
namespace {

/// Twice the size of a record of a million tasks, one line each.
constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

}  // namespace

std::optional<std::string> read_record_file(const Folder& folder, const std::string& name) {
  return folder.read_if_present(name, kMaxBytes);
}

}  // namespace strut
