// Everything that a sweep's results depend on, as text: the identity of a plan.
#pragma once

#include <string>
#include <vector>

#include "io/format/named_texts.h"
#include "sweep/request.h"

namespace strut {

/// Raised with every change of this program after which the same request gives other numbers.
inline constexpr int kResultsVersion = 1;

/// "name = value" of everything that enters the plan's hash, in order.
using Facts = NamedTexts;

/// Request, defaults resolved; vehicle and maneuver, every value of their files; the files that
/// those name, by SHA-256. Names of files, comments and the order of keys have no part in it, but
/// the order of the grid's axes has. Throws InputError where a file is missing.
Facts list_facts(const SweepRequest& request);

/// 64 digits: SHA-256 over the lines "name = value".
std::string calc_hash(const Facts& facts);

/// Lines "name: was A, is B" where two requests differ.
std::vector<std::string> compare_facts(const Facts& was, const Facts& is);

}  // namespace strut
