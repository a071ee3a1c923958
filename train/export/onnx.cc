#include "train/export/onnx.h"

#include <bit>
#include <cstring>

#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "io/store/shard_layout.h"
#include "train/export/protobuf_message.h"
#include "train/network/network.h"

namespace strut {
namespace {

// Numbers of fields and enumerations: onnx/onnx.proto, version 1.12.
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

/// Writes the graph of one model node by node, each feeding the next.
class OnnxGraph {
 public:
  OnnxGraph(const TrainedModel& model, OnnxNumber number) : model_(model), number_(number) {}

  ProtobufMessage write() {
    const NetworkShape shape(model_.sizes);
    graph_.add(GraphField::kName, std::string("strut_identify"));
    write_normalization();
    for (const NetworkLayer& layer : shape.layers) {
      write_layer(layer);
      if (&layer != &shape.layers.back()) add_node("Tanh", {});
    }
    write_restoration();
    graph_.add(GraphField::kInput, make_table(kInputName, shape.inputs()));
    graph_.add(GraphField::kOutput, make_table(kOutputName, shape.outputs()));
    return graph_;
  }

 private:
  std::int64_t data_type() const { return number_ == OnnxNumber::kDouble ? kDouble : kFloat; }

  /// A constant of the graph; returns its name.
  std::string add_constant(const std::string& name, const std::vector<std::int64_t>& shape,
                           const std::vector<double>& values) {
    ProtobufMessage tensor;
    for (const std::int64_t size : shape) tensor.add(TensorField::kDimension, size);
    tensor.add(TensorField::kDataType, data_type()).add(TensorField::kName, name);
    // OpenCV takes doubles from here only; packed, they are the same bytes.
    if (number_ == OnnxNumber::kDouble)
      tensor.add(TensorField::kDoubleData, to_bytes<double>(values));
    if (number_ == OnnxNumber::kFloat) tensor.add(TensorField::kRaw, to_bytes<float>(values));
    graph_.add(GraphField::kInitializer, tensor);
    return name;
  }

  std::string add_row(const std::string& name, const std::vector<double>& values) {
    return add_constant(name, {1, static_cast<std::int64_t>(values.size())}, values);
  }

  /// A node that takes what the last one gave, and `constants`.
  void add_node(const std::string& type, const std::vector<std::string>& constants,
                const std::string& output = "") {
    ++count_;
    const std::string name = type + "_" + std::to_string(count_);
    ProtobufMessage node;
    node.add(NodeField::kInput, last_);
    for (const std::string& constant : constants) node.add(NodeField::kInput, constant);
    last_ = output.empty() ? "value_" + std::to_string(count_) : output;
    node.add(NodeField::kOutput, last_).add(NodeField::kName, name).add(NodeField::kType, type);
    if (type == "Gemm") {  // x W' + b: rows of W are neurons
      node.add(NodeField::kAttribute, ProtobufMessage()
                                          .add(1, std::string("transB"))
                                          .add(3, std::int64_t{1})
                                          .add(20, kIntAttribute));
    }
    graph_.add(GraphField::kNode, node);
  }

  /// 2 (x - low) / (high - low) - 1
  void write_normalization() {
    const Normalizer& map = model_.input_map;
    std::vector<double> scale(map.columns());
    for (std::size_t i = 0; i < scale.size(); ++i) scale[i] = 2.0 / (map.high()[i] - map.low()[i]);
    add_node("Sub", {add_row("input_low", map.low())});
    add_node("Mul", {add_row("input_scale", scale)});
    add_node("Sub", {add_row("one", std::vector<double>(map.columns(), 1.0))});
  }

  void write_layer(const NetworkLayer& layer) {
    const auto part = [&](std::size_t begin, std::size_t end) {
      const auto from = model_.weights.begin();
      return std::vector<double>(from + static_cast<std::ptrdiff_t>(begin),
                                 from + static_cast<std::ptrdiff_t>(end));
    };
    const std::int64_t outputs = layer.outputs;
    const std::string number = std::to_string(++layer_);
    const std::string weights = add_constant("weights_" + number, {outputs, layer.inputs},
                                             part(layer.weights, layer.biases));
    const std::string biases =
        add_constant("biases_" + number, {outputs},
                     part(layer.biases, layer.biases + static_cast<std::size_t>(layer.outputs)));
    add_node("Gemm", {weights, biases});
  }

  /// low + (y + 1) (high - low) / 2 = middle + y (high - low) / 2
  void write_restoration() {
    const Normalizer& map = model_.target_map;
    std::vector<double> half(map.columns()), middle(map.columns());
    for (std::size_t i = 0; i < half.size(); ++i) {
      half[i] = 0.5 * (map.high()[i] - map.low()[i]);
      middle[i] = map.low()[i] + half[i];
    }
    add_node("Mul", {add_row("output_half_width", half)});
    add_node("Add", {add_row("output_middle", middle)}, kOutputName);
  }

  ProtobufMessage make_table(const char* name, int columns) const {
    // TensorShapeProto.Dimension: dim_value = 1, dim_param = 2.
    const ProtobufMessage shape = ProtobufMessage()
                                      .add(1, ProtobufMessage().add(2, std::string("N")))
                                      .add(1, ProtobufMessage().add(1, std::int64_t{columns}));
    const ProtobufMessage tensor = ProtobufMessage().add(1, data_type()).add(2, shape);
    return ProtobufMessage().add(1, std::string(name)).add(2, ProtobufMessage().add(1, tensor));
  }

  const TrainedModel& model_;
  const OnnxNumber number_;
  ProtobufMessage graph_;
  std::string last_ = kInputName;
  int count_ = 0, layer_ = 0;
};

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
      .add(ModelField::kGraph, OnnxGraph(model, number).write())
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
