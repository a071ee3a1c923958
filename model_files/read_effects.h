// Effects switched on in a vehicle or rig file: its tables [[effect]].
//
//   [[effect]]
//   name = "damper_blow_off"
//   place = "rear"            # not on a rig
//   loss = 0.4                # the effect's parameters; mere shapes may be left out
#pragma once

#include <string>

#include "base/error/input_error.h"
#include "io/format/toml_document.h"
#include "model/effects/catalogue.h"
#include "model_files/parameter.h"

namespace strut {

/// Settings of the tables [[effect]] of a file of this kind, in the order of the file. Throws
/// InputError with file, line, key, value and what is allowed: unknown effects, places and
/// parameters (with the nearest known name), effects that this kind of model does not have, values
/// out of range, an effect that is twice at one place.
EffectSettings read_effects(const Table& root, const ModelInfo& model);

/// The plausible range.
Range get_range(const EffectParameter& parameter);

/// A parameter of an effect at a place, as settings and fits know it.
Parameter make_effect_parameter(const EffectInfo& effect, const std::string& place,
                                const EffectParameter& parameter, const ModelInfo& model);

/// `text`, that of a vehicle or rig file, with its tables [[effect]] replaced by these; all else as
/// it stands. Reads back as exactly these settings. Throws InputError where the text writes its
/// effects in another form.
std::string replace_effects(const std::string& text, const EffectSettings& settings,
                            const ModelInfo& model);

}  // namespace strut
