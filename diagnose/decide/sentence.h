// The verdict of a diagnosis in words.
#pragma once

#include <string>

#include "diagnose/decide/diagnosis.h"

namespace strut {

/// One or two sentences, from all other parts of the diagnosis.
std::string write_sentence(const Diagnosis& diagnosis);

/// The name of a location in a sentence: "strut" for a rig's only strut, which has none in its
/// file.
std::string name_strut(const std::string& place);

}  // namespace strut
