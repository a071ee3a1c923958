// Numbers as text.
#pragma once

#include <string>

namespace strut {

/// The shortest decimal text that reads back as the same double.
std::string format_number(double value);
/// Six significant digits, for computed numbers in messages.
std::string format_rounded(double value);

}  // namespace strut
