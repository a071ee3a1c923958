#include "io/format/read_json.h"

#include <fmt/format.h>

#include "io/file/folder.h"

namespace strut {
namespace {

// The file behind a page holds names and tables.
constexpr std::size_t kMaxBytes = std::size_t{4} << 20;
constexpr int kMaxDepth = 64;

}  // namespace

std::string explain(const Json::exception& e) {
  const std::string text = e.what();
  const std::size_t end = text.find("] ");
  return end == std::string::npos ? text : text.substr(end + 2);
}

Json parse_json(const std::string& text, const std::filesystem::path& path) {
  const auto check_depth = [&](int depth, Json::parse_event_t /*event*/, const Json& /*parsed*/) {
    if (depth <= kMaxDepth) return true;
    throw InputError(fmt::format("{}: nested too deep; at most {} levels are allowed",
                                 path.string(), kMaxDepth));
  };
  try {
    return Json::parse(text, check_depth);
  } catch (const Json::exception& e) {
    throw InputError(fmt::format("{}: not JSON: {}", path.string(), explain(e)));
  }
}

Json read_json(const std::filesystem::path& path) {
  const auto text = Folder(path.parent_path()).read_if_present(path.filename().string(), kMaxBytes);
  if (!text) throw InputError(path.string() + ": file not found");
  return parse_json(*text, path);
}

}  // namespace strut
