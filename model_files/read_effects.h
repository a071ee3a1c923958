// Effects switched on in a vehicle or rig file: its tables [[effect]].
//
//   [[effect]]
//   name = "damper_blow_off"
//   place = "rear"            # not on a rig
//   loss = 0.4                # the effect's parameters; those that only shape it are optional
#pragma once

#include <string>

#include "base/error/input_error.h"
#include "io/format/toml_document.h"
#include "model/effects/catalogue.h"
#include "model_files/parameter.h"

namespace strut {

/// Settings of the tables [[effect]] of a file of this kind, in the order of the file. Throws
/// InputError with file, line, key, value and allowed values for unknown effects, places and
/// parameters (with the nearest known name), effects that this kind of model does not have, values
/// out of range, and an effect that is given twice at one place.
EffectSettings read_effects(const Table& root, const ModelInfo& model);

/// The plausible range.
Range get_range(const EffectParameter& parameter);

/// A parameter of an effect at a place, for settings and fits.
Parameter make_effect_parameter(const EffectInfo& effect, const std::string& place,
                                const EffectParameter& parameter, const ModelInfo& model);

/// Replaces the tables [[effect]] in the text of a vehicle or rig file; the other text is
/// unchanged. Reads back as exactly these settings. Throws InputError where the text writes its
/// effects in another form.
std::string replace_effects(const std::string& text, const EffectSettings& settings,
                            const ModelInfo& model);

}  // namespace strut
