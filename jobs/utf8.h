// Text that may hold any bytes, as names of files do.
#pragma once

#include <string>
#include <string_view>

namespace strut {

/// `text` with each byte that is no part of valid UTF-8 (RFC 3629) replaced by U+FFFD: JSON and
/// HTML hold nothing else.
std::string make_valid_utf8(std::string_view text);

}  // namespace strut
