#include "jobs/cli/terminal.h"

#include <unistd.h>

#include <array>
#include <cstdlib>

namespace strut {
namespace {

std::string read_variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

bool is_live_terminal(int descriptor) {
  const std::string kind = read_variable("TERM");
  return isatty(descriptor) == 1 && !kind.empty() && kind != "dumb";
}

bool shows_colors(int descriptor) {
  return read_variable("NO_COLOR").empty() && is_live_terminal(descriptor);
}

const char* get_sequence(Style style) {
  constexpr std::array<const char*, 3> kSequences = {"\033[31m", "\033[1m", "\033[2m"};  // Style
  return kSequences[static_cast<std::size_t>(style)];
}

}  // namespace strut
