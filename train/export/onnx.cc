#include "train/export/onnx.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "io/store/shard_layout.h"
#include "train/export/layer_values.h"
#include "train/export/protobuf_message.h"

namespace strut {
namespace {

// Numbers of fields and enumerations, from onnx/onnx.proto, version 1.12.
constexpr std::int64_t kIrVersion = 7, kOperatorSet = 13;
constexpr std::int64_t kFloat = 1, kDouble = 11;  // TensorProto.DataType
constexpr std::int64_t kIntAttribute = 2;         // AttributeProto.AttributeType
struct ModelField {
  enum { kIr = 1, kProducer = 2, kDocument = 6, kGraph = 7, kOperators = 8, kProperties = 14 };
};
struct GraphField {
  enum { kNode = 1, kName = 2, kInitializer = 5, kInput = 11, kOutput = 12 };
};
struct NodeField {
  enum { kInput = 1, kOutput = 2, kName = 3, kType = 4, kAttribute = 5 };
};
struct TensorField {
  enum { kDimension = 1, kDataType = 2, kName = 8, kRaw = 9, kDoubleData = 10 };
};

constexpr char kInputName[] = "inputs", kOutputName[] = "parameters";
constexpr char kGemm[] = "Gemm";

static_assert(std::endian::native == std::endian::little, "numbers of the file are little-endian");

template <class T>
std::string to_bytes(const std::vector<double>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    const T value = static_cast<T>(values[i]);
    std::memcpy(bytes.data() + i * sizeof(T), &value, sizeof(T));
  }
  return bytes;
}

ProtobufMessage make_property(const std::string& key, const std::string& value) {
  return ProtobufMessage().add(1, key).add(2, value);
}

std::string list_numbers(const std::vector<double>& values) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double value : values) texts.push_back(format_number(value));
  return join_names(texts);
}

/// A graph under construction, in which each node takes the output of the one before.
struct OnnxGraph {
  std::int64_t data_type = kDouble;
  ProtobufMessage message;
  std::string last = kInputName;  // output of the last node
  int nodes = 0;
};

/// Adds a constant to the graph; returns its name.
std::string add_constant(OnnxGraph& graph, const std::string& name,
                         const std::vector<std::int64_t>& shape,
                         const std::vector<double>& values) {
  ProtobufMessage tensor;
  for (const std::int64_t size : shape) tensor.add(TensorField::kDimension, size);
  tensor.add(TensorField::kDataType, graph.data_type).add(TensorField::kName, name);
  // OpenCV accepts doubles only in this field; packed, they are the same bytes.
  if (graph.data_type == kDouble) tensor.add(TensorField::kDoubleData, to_bytes<double>(values));
  if (graph.data_type == kFloat) tensor.add(TensorField::kRaw, to_bytes<float>(values));
  graph.message.add(GraphField::kInitializer, tensor);
  return name;
}

std::string add_row(OnnxGraph& graph, const std::string& name, const std::vector<double>& values) {
  return add_constant(graph, name, {1, static_cast<std::int64_t>(values.size())}, values);
}

/// Adds a node that takes the output of the last one and `constants`.
void add_node(OnnxGraph& graph, const std::string& type, const std::vector<std::string>& constants,
              const std::string& output = "") {
  ++graph.nodes;
  ProtobufMessage node;
  node.add(NodeField::kInput, graph.last);
  for (const std::string& constant : constants) node.add(NodeField::kInput, constant);
  graph.last = output.empty() ? fmt::format("value_{}", graph.nodes) : output;
  node.add(NodeField::kOutput, graph.last)
      .add(NodeField::kName, fmt::format("{}_{}", type, graph.nodes))
      .add(NodeField::kType, type);
  if (type == kGemm) {  // x W' + b: rows of W are neurons
    node.add(NodeField::kAttribute, ProtobufMessage()
                                        .add(1, std::string("transB"))
                                        .add(3, std::int64_t{1})
                                        .add(20, kIntAttribute));
  }
  graph.message.add(GraphField::kNode, node);
}

/// 2 (x - low) / (high - low) - 1
void add_normalization(OnnxGraph& graph, const Normalizer& map) {
  std::vector<double> scale(map.columns());
  for (std::size_t i = 0; i < scale.size(); ++i) scale[i] = 2.0 / (map.high()[i] - map.low()[i]);
  add_node(graph, "Sub", {add_row(graph, "input_low", map.low())});
  add_node(graph, "Mul", {add_row(graph, "input_scale", scale)});
  add_node(graph, "Sub", {add_row(graph, "one", std::vector<double>(map.columns(), 1.0))});
}

void add_layer(OnnxGraph& graph, const TrainedModel& model, const NetworkLayer& layer,
               std::size_t number) {
  const LayerValues values = get_layer_values(model, layer);
  const std::int64_t outputs = layer.outputs;
  const std::string weights = add_constant(graph, fmt::format("weights_{}", number),
                                           {outputs, layer.inputs}, values.weights);
  const std::string biases =
      add_constant(graph, fmt::format("biases_{}", number), {outputs}, values.biases);
  add_node(graph, kGemm, {weights, biases});
}

/// low + (y + 1) (high - low) / 2 = middle + y (high - low) / 2
void add_restoration(OnnxGraph& graph, const Normalizer& map) {
  std::vector<double> half(map.columns()), middle(map.columns());
  for (std::size_t i = 0; i < half.size(); ++i) {
    half[i] = 0.5 * (map.high()[i] - map.low()[i]);
    middle[i] = map.low()[i] + half[i];
  }
  add_node(graph, "Mul", {add_row(graph, "output_half_width", half)});
  add_node(graph, "Add", {add_row(graph, "output_middle", middle)}, kOutputName);
}

ProtobufMessage make_table(const char* name, int columns, std::int64_t data_type) {
  // TensorShapeProto.Dimension: dim_value = 1, dim_param = 2.
  const ProtobufMessage shape = ProtobufMessage()
                                    .add(1, ProtobufMessage().add(2, std::string("N")))
                                    .add(1, ProtobufMessage().add(1, std::int64_t{columns}));
  const ProtobufMessage tensor = ProtobufMessage().add(1, data_type).add(2, shape);
  return ProtobufMessage().add(1, std::string(name)).add(2, ProtobufMessage().add(1, tensor));
}

ProtobufMessage make_graph(const TrainedModel& model, OnnxNumber number) {
  const NetworkShape shape(model.sizes);
  OnnxGraph graph;
  graph.data_type = number == OnnxNumber::kDouble ? kDouble : kFloat;
  graph.message.add(GraphField::kName, std::string("strut_identify"));
  add_normalization(graph, model.input_map);
  for (std::size_t l = 0; l < shape.layers.size(); ++l) {
    add_layer(graph, model, shape.layers[l], l + 1);
    if (l + 1 < shape.layers.size()) add_node(graph, "Tanh", {});
  }
  add_restoration(graph, model.target_map);
  graph.message.add(GraphField::kInput, make_table(kInputName, shape.inputs(), graph.data_type))
      .add(GraphField::kOutput, make_table(kOutputName, shape.outputs(), graph.data_type));
  return graph.message;
}

void add_columns(ProtobufMessage& proto, const std::string& what,
                 const std::vector<ColumnInfo>& columns, const Normalizer& map) {
  std::vector<std::string> units;
  units.reserve(columns.size());
  for (const ColumnInfo& column : columns) units.push_back(column.unit);
  const NamedTexts properties = {{what + "_names", join_names(list_names(columns))},
                                 {what + "_units", join_names(units)},
                                 {what + "_low", list_numbers(map.low())},
                                 {what + "_high", list_numbers(map.high())}};
  for (const auto& [key, value] : properties) {
    proto.add(ModelField::kProperties, make_property(key, value));
  }
}

}  // namespace

std::string make_onnx(const TrainedModel& model, OnnxNumber number, const NamedTexts& provenance) {
  ProtobufMessage proto;
  proto.add(ModelField::kIr, kIrVersion)
      .add(ModelField::kProducer, std::string("strut"))
      .add(ModelField::kDocument,
           std::string("Parameters of a car from measured channels. Outside of input_low to "
                       "input_high the values are extrapolated."))
      .add(ModelField::kGraph, make_graph(model, number))
      .add(ModelField::kOperators, ProtobufMessage().add(1, std::string()).add(2, kOperatorSet));
  add_columns(proto, "input", model.inputs, model.input_map);
  add_columns(proto, "output", model.targets, model.target_map);
  NamedTexts rest = {{"output_ci95", list_numbers(model.ci95)}, {"plan_hash", model.plan_hash}};
  rest.insert(rest.end(), provenance.begin(), provenance.end());
  for (const auto& [key, value] : rest) {
    proto.add(ModelField::kProperties, make_property(key, value));
  }
  return proto.bytes();
}

}  // namespace strut
