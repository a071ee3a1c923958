// Numbers as text.
#pragma once

#include <string>

namespace strut {

/// The shortest decimal text that reads back as the same double.
std::string format_number(double value);
/// Six significant digits, for computed numbers in messages.
std::string format_rounded(double value);
/// `digits` significant digits without an exponent, from 0.0001 to below a million: "38000".
std::string format_significant(double value, int digits = 3);
/// The value to the decimal place of its error's second digit: "860.10" for an error of 0.34.
std::string format_to_error(double value, double error);

}  // namespace strut
