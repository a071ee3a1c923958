// JSON as strut writes it: members in the order in which they are set.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace strut {

using Json = nlohmann::ordered_json;

/// As text (RFC 8259) of printable ASCII, which no terminal obeys: other characters are escaped,
/// bytes that are not UTF-8 replaced by U+FFFD, numbers that are not finite null. Indented by two
/// blanks a level; arrays and objects without nested ones stand on one line.
std::string format_json(const Json& json);

}  // namespace strut
