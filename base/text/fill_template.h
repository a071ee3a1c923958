// Text templates with named places, as files that are embedded at build time hold them.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace strut {

/// Returns `text` with every place "@name@" (a to z and _) replaced by `values` of that name;
/// values are not searched for places. Fails a check if a place has no value.
std::string fill_template(std::string_view text, const std::map<std::string, std::string>& values);

}  // namespace strut
