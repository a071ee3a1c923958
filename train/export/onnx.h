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
  kFloat,  // for runtimes that support no double; about seven digits
};

/// Returns a serialized ModelProto of ONNX IR 7, operator set 13
/// (https://onnx.ai/onnx/repo-docs/IR.html): input `inputs` [N, inputs] and output `parameters` [N,
/// outputs] in the units of the model's columns, any N; nodes Sub, Mul, Sub for the normalization,
/// Gemm and Tanh per layer, Mul and Add to restore the units. Properties (metadata_props), each a
/// comma-separated list: input_names, input_units, input_low, input_high, the same for outputs,
/// output_ci95; and plan_hash and `provenance`.
std::string make_onnx(const TrainedModel& model, OnnxNumber number, const NamedTexts& provenance);

}  // namespace strut
