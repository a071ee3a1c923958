// The verdict of a diagnosis in words.
#pragma once

#include <string>

#include "diagnose/decide/diagnosis.h"

namespace strut {

/// A few sentences: the claim, what it does not explain, and the measured improvement. From all
/// other parts of the diagnosis.
std::string write_sentence(const CampaignData& data, const Diagnosis& diagnosis);

/// The causes of the extended model and its force map: "damper_asymmetry at rear and a force map"
std::string describe_extension(const Diagnosis& diagnosis);

/// The name of a location in a sentence: "strut" for a rig's only strut, which has none in its
/// file.
std::string name_strut(const std::string& place);

}  // namespace strut
