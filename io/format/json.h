// JSON as strut writes it: members in the order in which they are set.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace strut {

using Json = nlohmann::ordered_json;

/// Returns the text (RFC 8259) in printable ASCII, which no terminal interprets: other characters
/// are escaped, bytes that are not UTF-8 are replaced by U+FFFD, and numbers that are not finite
/// become null. Indents by two blanks per level; arrays and objects without nested ones take one
/// line.
std::string format_json(const Json& json);

}  // namespace strut
