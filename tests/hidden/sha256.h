// SHA-256 of FIPS 180-4, for the seal on a truth file.
#pragma once

#include <string>

namespace strut::hidden {

/// 64 hexadecimal digits.
std::string calc_sha256(const std::string& bytes);

}  // namespace strut::hidden
