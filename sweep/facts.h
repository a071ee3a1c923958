// Everything that the results of a sweep depend on, as text: the identity of a plan.
#pragma once

#include <string>
#include <vector>

#include "io/format/named_texts.h"
#include "sweep/request.h"

namespace strut {

/// The (name, value) pairs that the plan's hash covers, in order.
using Facts = NamedTexts;

/// Name of the fact that SweepRequest::results_version is.
inline constexpr char kResultsVersionName[] = "results_version";

/// Lists the request with its defaults resolved, every value of the vehicle and maneuver files, and
/// the SHA-256 of each file that those name. File names, comments and the order of keys do not
/// matter; the order of the grid's axes does. Throws InputError if a file is missing.
Facts list_facts(const SweepRequest& request);

/// SHA-256 over the lines "name = value", 64 hexadecimal digits.
std::string calc_hash(const Facts& facts);

/// One line "name: was A, is B" for each difference.
std::vector<std::string> compare_facts(const Facts& was, const Facts& is);

}  // namespace strut
