// Exports a trained network as an ONNX model, for other tools.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/format/named_texts.h"
#include "train/model/model_file.h"

namespace strut {

enum class OnnxNumber {
  kDouble,
  kFloat,  // for runtimes that support no double; about seven digits; not of windows
};

/// Returns a serialized ModelProto of ONNX IR 7, operator set 13
/// (https://onnx.ai/onnx/repo-docs/IR.html): input `inputs` [N, inputs] and output `parameters` [N,
/// outputs] in the units of the model's columns, any N; nodes Sub, Mul, Sub for the normalization,
/// Gemm and Tanh per layer, Mul and Add to restore the units. Properties (metadata_props), each a
/// comma-separated list: input_names, input_units, input_low, input_high, the same for outputs,
/// output_ci95; and plan_hash and `provenance`.
///
/// The model of a network over windows has the input `record` [N, channels, samples] in the units
/// of the channels, with any number of samples, and the outputs `parameters`, `in_range` [N, 1],
/// the flag of identify_record(), `components`, `leftover` [N, 1] and, where records are aligned,
/// `begin` [N, 1], the start of the window in samples. Properties: channel_names, channel_units,
/// interval [s], window_samples, minimum_samples, leftover_limit, and component_... in place of
/// input_...
std::string make_onnx(const TrainedModel& model, OnnxNumber number, const NamedTexts& provenance);

}  // namespace strut
