#include "io/format/json.h"

#include <algorithm>

namespace strut {
namespace {

std::string format_scalar(const Json& json) {
  return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

void append(const Json& json, int level, std::string& out) {
  if (!json.is_structured()) {
    out += format_scalar(json);
    return;
  }
  const bool is_flat =
      std::none_of(json.begin(), json.end(), [](const Json& j) { return j.is_structured(); });
  const std::string indent = "\n" + std::string(static_cast<std::size_t>(2 * level), ' ');
  out += json.is_object() ? '{' : '[';
  bool is_first = true;
  for (const auto& [key, value] : json.items()) {
    if (!is_first) out += is_flat ? ", " : ",";
    is_first = false;
    if (!is_flat) out += indent + "  ";
    if (json.is_object()) out += format_scalar(key) + ": ";
    append(value, level + 1, out);
  }
  if (!is_flat) out += indent;
  out += json.is_object() ? '}' : ']';
}

}  // namespace

std::string format_json(const Json& json) {
  std::string out;
  append(json, 0, out);
  return out;
}

}  // namespace strut
