#include "train/export/onnx_graph.h"

#include <bit>
#include <cstring>

namespace strut {
namespace {

// Numbers of fields and enumerations, from onnx/onnx.proto, version 1.12.
constexpr std::int64_t kIntAttribute = 2;  // AttributeProto.AttributeType
struct GraphField {
  enum { kNode = 1, kName = 2, kInitializer = 5, kInput = 11, kOutput = 12 };
};
struct NodeField {
  enum { kInput = 1, kOutput = 2, kName = 3, kType = 4, kAttribute = 5 };
};
struct AttributeField {
  enum { kName = 1, kInt = 3, kType = 20 };
};
struct TensorField {
  enum { kDimension = 1, kDataType = 2, kName = 8, kRaw = 9, kDoubleData = 10 };
};

static_assert(std::endian::native == std::endian::little, "numbers of the file are little-endian");

template <class T, class From>
std::string to_bytes(const std::vector<From>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    const T value = static_cast<T>(values[i]);
    std::memcpy(bytes.data() + i * sizeof(T), &value, sizeof(T));
  }
  return bytes;
}

ProtobufMessage start_tensor(const std::string& name, const std::vector<std::int64_t>& shape,
                             OnnxType type) {
  ProtobufMessage tensor;
  for (const std::int64_t size : shape) tensor.add(TensorField::kDimension, size);
  tensor.add(TensorField::kDataType, static_cast<std::int64_t>(type)).add(TensorField::kName, name);
  return tensor;
}

/// A ValueInfoProto.
ProtobufMessage make_value(const std::string& name, const std::vector<OnnxDimension>& dimensions,
                           OnnxType type) {
  // TensorShapeProto.Dimension: dim_value = 1, dim_param = 2.
  ProtobufMessage shape;
  for (const OnnxDimension& d : dimensions) {
    shape.add(1,
              d.name.empty() ? ProtobufMessage().add(1, d.size) : ProtobufMessage().add(2, d.name));
  }
  const ProtobufMessage tensor =
      ProtobufMessage().add(1, static_cast<std::int64_t>(type)).add(2, shape);
  return ProtobufMessage().add(1, name).add(2, ProtobufMessage().add(1, tensor));
}

}  // namespace

OnnxGraph::Value OnnxGraph::add_constant(const std::string& name,
                                         const std::vector<std::int64_t>& shape,
                                         const std::vector<double>& values) {
  ProtobufMessage tensor = start_tensor(name, shape, type_);
  // OpenCV accepts doubles only in this field; packed, they are the same bytes.
  if (type_ == OnnxType::kDouble) tensor.add(TensorField::kDoubleData, to_bytes<double>(values));
  if (type_ == OnnxType::kFloat) tensor.add(TensorField::kRaw, to_bytes<float>(values));
  message_.add(GraphField::kInitializer, tensor);
  return name;
}

OnnxGraph::Value OnnxGraph::add_number(double value) {
  return add_constant(name_next("number"), {}, {value});
}

OnnxGraph::Value OnnxGraph::add_integers(const std::vector<std::int64_t>& shape,
                                         const std::vector<std::int64_t>& values) {
  std::string name = name_next("integers");
  ProtobufMessage tensor = start_tensor(name, shape, OnnxType::kInt64);
  tensor.add(TensorField::kRaw, to_bytes<std::int64_t>(values));
  message_.add(GraphField::kInitializer, tensor);
  return name;
}

OnnxGraph::Value OnnxGraph::add_node(const std::string& type, const std::vector<Value>& inputs,
                                     const std::vector<OnnxAttribute>& attributes,
                                     const std::string& output) {
  const std::string name = name_next(type);
  Value result = output.empty() ? "value_of_" + name : output;
  ProtobufMessage node;
  for (const Value& input : inputs) node.add(NodeField::kInput, input);
  node.add(NodeField::kOutput, result).add(NodeField::kName, name).add(NodeField::kType, type);
  for (const OnnxAttribute& attribute : attributes) {
    node.add(NodeField::kAttribute, ProtobufMessage()
                                        .add(AttributeField::kName, std::string(attribute.name))
                                        .add(AttributeField::kInt, attribute.value)
                                        .add(AttributeField::kType, kIntAttribute));
  }
  message_.add(GraphField::kNode, node);
  return result;
}

OnnxGraph::Value OnnxGraph::slice(const Value& a, std::int64_t axis, std::int64_t begin,
                                  std::int64_t end) {
  return add_node("Slice", {a, add_integers({1}, {begin}), add_integers({1}, {end}),
                            add_integers({1}, {axis})});
}

OnnxGraph::Value OnnxGraph::declare_input(const std::string& name,
                                          const std::vector<OnnxDimension>& shape) {
  message_.add(GraphField::kInput, make_value(name, shape, type_));
  return name;
}

void OnnxGraph::declare_output(const std::string& name, const std::vector<OnnxDimension>& shape,
                               OnnxType type) {
  message_.add(GraphField::kOutput, make_value(name, shape, type));
}

ProtobufMessage OnnxGraph::finish(const std::string& name) const {
  ProtobufMessage message = message_;
  message.add(GraphField::kName, name);
  return message;
}

}  // namespace strut
