#include "report/read_json.h"

#include <algorithm>
#include <boost/property_tree/json_parser.hpp>
#include <sstream>

#include "io/file/folder.h"

namespace strut {
namespace {

// A tree in memory takes some 200 times the bytes of its text.
constexpr std::size_t kMaxBytes = std::size_t{4} << 20;
constexpr int kMaxDepth = 64;

/// Levels of objects and arrays, texts left out.
int calc_depth(const std::string& text) {
  int depth = 0, deepest = 0;
  bool is_text = false, is_escaped = false;
  for (const char c : text) {
    if (is_escaped) {
      is_escaped = false;
    } else if (is_text) {
      is_escaped = c == '\\';
      is_text = c != '"';
    } else if (c == '"') {
      is_text = true;
    } else if (c == '{' || c == '[') {
      deepest = std::max(deepest, ++depth);
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return deepest;
}

}  // namespace

JsonTree parse_json(const std::string& text, const std::filesystem::path& path) {
  const int depth = calc_depth(text);
  if (depth > kMaxDepth) {
    throw InputError(path.string() + ": nested " + std::to_string(depth) +
                     " levels deep; at most " + std::to_string(kMaxDepth) + " are read");
  }
  try {
    std::istringstream stream(text);
    JsonTree tree;
    boost::property_tree::read_json(stream, tree);
    return tree;
  } catch (const boost::property_tree::json_parser_error& e) {
    throw InputError(path.string() + ":" + std::to_string(e.line()) + ": not JSON: " + e.message());
  }
}

JsonTree read_json(const std::filesystem::path& path) {
  const auto text = Folder(path.parent_path()).read_if_present(path.filename().string(), kMaxBytes);
  if (!text) throw InputError(path.string() + ": file not found");
  return parse_json(*text, path);
}

}  // namespace strut
