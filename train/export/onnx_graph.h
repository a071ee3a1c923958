// Builds the graph of an ONNX model: tensors by name, nodes in the order of their computation.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "train/export/protobuf_message.h"

namespace strut {

/// TensorProto.DataType
enum class OnnxType : std::int64_t { kFloat = 1, kInt64 = 7, kBool = 9, kDouble = 11 };

/// A size, or the name of one that is open.
struct OnnxDimension {
  OnnxDimension(std::int64_t fixed) : size(fixed) {}        // NOLINT: sizes mix freely with names
  OnnxDimension(const char* open) : size(0), name(open) {}  // NOLINT
  std::int64_t size;
  std::string name = {};
};

/// An integer attribute of a node.
struct OnnxAttribute {
  const char* name;
  std::int64_t value;
};

class OnnxGraph {
 public:
  using Value = std::string;  // a tensor's name

  /// `type`: of all constants that are not integers.
  explicit OnnxGraph(OnnxType type) : type_(type) {}

  OnnxType type() const { return type_; }

  Value add_constant(const std::string& name, const std::vector<std::int64_t>& shape,
                     const std::vector<double>& values);
  /// A constant without dimensions.
  Value add_number(double value);
  Value add_integers(const std::vector<std::int64_t>& shape,
                     const std::vector<std::int64_t>& values);
  Value add_integer(std::int64_t value) { return add_integers({}, {value}); }
  /// Returns the node's output.
  Value add_node(const std::string& type, const std::vector<Value>& inputs,
                 const std::vector<OnnxAttribute>& attributes = {}, const std::string& output = "");

  /// Nodes of frequent operators.
  Value add(const Value& a, const Value& b) { return add_node("Add", {a, b}); }
  Value subtract(const Value& a, const Value& b) { return add_node("Sub", {a, b}); }
  Value multiply(const Value& a, const Value& b) { return add_node("Mul", {a, b}); }
  Value divide(const Value& a, const Value& b) { return add_node("Div", {a, b}); }
  /// The sum over an axis, which stays with size 1.
  Value sum(const Value& a, std::int64_t axis) {
    return add_node("ReduceSum", {a, add_integers({1}, {axis})}, {{"keepdims", 1}});
  }
  /// Elements [begin, end) along an axis.
  Value slice(const Value& a, std::int64_t axis, std::int64_t begin, std::int64_t end);

  /// Declares the inputs and outputs of the graph, which nodes use and make.
  Value declare_input(const std::string& name, const std::vector<OnnxDimension>& shape);
  void declare_output(const std::string& name, const std::vector<OnnxDimension>& shape,
                      OnnxType type);

  /// The GraphProto.
  ProtobufMessage finish(const std::string& name) const;

 private:
  std::string name_next(const std::string& what) {
    return what + "_" + std::to_string(++last_number_);
  }

  OnnxType type_;
  ProtobufMessage message_;
  int last_number_ = 0;
};

}  // namespace strut
