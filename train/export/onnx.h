// A trained network as an ONNX model, which other tools load.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/format/named_texts.h"
#include "train/model/model_file.h"

namespace strut {

enum class OnnxNumber {
  kDouble,
  kFloat,  // for runtimes that know no other; about seven digits
};

/// A serialized ModelProto of ONNX IR 7, operator set 13 (https://onnx.ai/onnx/repo-docs/IR.html):
/// input `inputs` [N, inputs] in the units of the model's columns, output `parameters` [N,
/// outputs], N of any size; nodes Sub, Mul, Sub for the normalization, Gemm and Tanh per layer, Mul
/// and Add to restore. Properties (metadata_props): input_names, input_units, input_low,
/// input_high, the same of outputs, output_ci95, each a list parted by commas, plan_hash, and
/// `provenance`.
std::string make_onnx(const TrainedModel& model, OnnxNumber number, const NamedTexts& provenance);

}  // namespace strut
