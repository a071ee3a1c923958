#include "model_files/drop_tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error/input_error.h"

namespace strut {
namespace {

/// Opening minus closing brackets of a line, without those in strings and comments.
int count_brackets(const std::string& line) {
  int open = 0;
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != 0) {
      if (c == '\\' && quote == '"') ++i;
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#') {
      break;
    } else {
      open += c == '[' ? 1 : c == ']' ? -1 : 0;
    }
  }
  return open;
}

bool is_header(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string::npos && line[first] == '[';
}

}  // namespace

std::string drop_tables(const std::string& text, const std::string& name) {
  std::string kept;
  bool dropping = false;
  int open = 0;  // open brackets of an array over several lines
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string line = text.substr(begin, end - begin);
    if (line.starts_with(name + " ") || line.starts_with(name + "=")) {
      throw InputError(
          fmt::format("{0}: write each as a table [[{0}]], not as an array in one line", name));
    }
    if (open == 0 && is_header(line)) {
      const bool dropped_before = dropping;
      dropping = line.find("[" + name + "]") != std::string::npos;  // [name] or [[name]]
      if (dropping && !dropped_before) {
        while (kept.ends_with("\n\n")) kept.pop_back();
      }
      if (dropped_before && !dropping && !kept.empty()) kept += '\n';
    } else {
      open = std::max(open + count_brackets(line), 0);
    }
    if (!dropping) kept += line;
    begin = end;
  }
  return kept;
}

}  // namespace strut
