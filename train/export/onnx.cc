#include "train/export/onnx.h"

#include <fmt/format.h>

#include "base/error/check.h"
#include "base/math/normal.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "io/store/shard_layout.h"
#include "train/export/layer_values.h"
#include "train/export/onnx_window.h"
#include "train/model/identifier.h"

namespace strut {
namespace {

// Numbers of fields, from onnx/onnx.proto, version 1.12.
constexpr std::int64_t kIrVersion = 7, kOperatorSet = 13;
struct ModelField {
  enum { kIr = 1, kProducer = 2, kDocument = 6, kGraph = 7, kOperators = 8, kProperties = 14 };
};

using Value = OnnxGraph::Value;

constexpr char kInputName[] = "inputs", kRecordName[] = "record", kOutputName[] = "parameters";

ProtobufMessage make_property(const std::string& key, const std::string& value) {
  return ProtobufMessage().add(1, key).add(2, value);
}

std::string list_numbers(const std::vector<double>& values) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double value : values) texts.push_back(format_number(value));
  return join_names(texts);
}

Value add_row(OnnxGraph& graph, const std::string& name, const std::vector<double>& values) {
  return graph.add_constant(name, {1, static_cast<std::int64_t>(values.size())}, values);
}

/// 2 (x - low) / (high - low) - 1
Value add_normalization(OnnxGraph& graph, const Normalizer& map, const Value& x) {
  std::vector<double> scale(map.columns());
  for (std::size_t i = 0; i < scale.size(); ++i) scale[i] = 2.0 / (map.high()[i] - map.low()[i]);
  const Value scaled = graph.multiply(graph.subtract(x, add_row(graph, "input_low", map.low())),
                                      add_row(graph, "input_scale", scale));
  return graph.subtract(scaled, add_row(graph, "one", std::vector<double>(map.columns(), 1.0)));
}

Value add_layer(OnnxGraph& graph, const TrainedModel& model, const NetworkLayer& layer,
                std::size_t number, const Value& x) {
  const LayerValues values = get_layer_values(model, layer);
  const std::int64_t outputs = layer.outputs;
  const Value weights = graph.add_constant(fmt::format("weights_{}", number),
                                           {outputs, layer.inputs}, values.weights);
  const Value biases =
      graph.add_constant(fmt::format("biases_{}", number), {outputs}, values.biases);
  return graph.add_node("Gemm", {x, weights, biases}, {{"transB", 1}});  // rows of W are neurons
}

/// low + (y + 1) (high - low) / 2 = middle + y (high - low) / 2
Value add_restoration(OnnxGraph& graph, const Normalizer& map, const Value& y) {
  std::vector<double> half(map.columns()), middle(map.columns());
  for (std::size_t i = 0; i < half.size(); ++i) {
    half[i] = 0.5 * (map.high()[i] - map.low()[i]);
    middle[i] = map.low()[i] + half[i];
  }
  const Value scaled = graph.multiply(y, add_row(graph, "output_half_width", half));
  return graph.add_node("Add", {scaled, add_row(graph, "output_middle", middle)}, {}, kOutputName);
}

/// The parameters from the network's inputs.
Value add_network(OnnxGraph& graph, const TrainedModel& model, const Value& inputs) {
  const NetworkShape shape(model.sizes);
  Value last = add_normalization(graph, model.input_map, inputs);
  for (std::size_t l = 0; l < shape.layers.size(); ++l) {
    last = add_layer(graph, model, shape.layers[l], l + 1, last);
    if (l + 1 < shape.layers.size()) last = graph.add_node("Tanh", {last});
  }
  return add_restoration(graph, model.target_map, last);
}

/// Whether all columns of x [N, M] lie in [low, high], widened by `margin`: [N, 1].
Value add_range_check(OnnxGraph& graph, const std::string& name, const Value& x,
                      const Normalizer& map, const std::vector<double>& margin) {
  std::vector<double> low(map.columns()), high(map.columns());
  for (std::size_t i = 0; i < low.size(); ++i) {
    low[i] = map.low()[i] - margin[i];
    high[i] = map.high()[i] + margin[i];
  }
  const Value inside = graph.add_node(
      "And", {graph.add_node("GreaterOrEqual", {x, add_row(graph, name + "_least", low)}),
              graph.add_node("LessOrEqual", {x, add_row(graph, name + "_most", high)})});
  const Value numbers =
      graph.add_node("Cast", {inside}, {{"to", static_cast<std::int64_t>(graph.type())}});
  const Value count = graph.add_number(static_cast<double>(map.columns()) - 0.5);
  return graph.add_node("Greater", {graph.sum(numbers, 1), count});
}

/// The flag of identify_record(), for a record of finite numbers.
void add_flag(OnnxGraph& graph, const TrainedModel& model, const Value& record,
              const OnnxWindow& window, const Value& parameters) {
  const std::vector<double> margin(model.inputs.size(), kNormal95);
  std::vector<double> output_margin;
  for (std::size_t t = 0; t < model.targets.size(); ++t) {
    output_margin.push_back(calc_parameter_margin(model, t, model.ci95[t]));
  }
  const Value limit = graph.add_number(calc_residual_limit(*model.window));
  Value good = graph.add_node(
      "And", {graph.add_node("LessOrEqual", {window.leftover, limit}),
              add_range_check(graph, "component", window.components, model.input_map, margin)});
  if (!window.found.empty()) good = graph.add_node("And", {good, window.found});
  // 0 times a number is 0 unless the number is not finite.
  const Value zeros = graph.multiply(record, graph.add_number(0.0));
  const Value sum =
      graph.add_node("ReduceSum", {zeros, graph.add_integers({2}, {1, 2})}, {{"keepdims", 0}});
  const Value column = graph.add_node("Reshape", {sum, graph.add_integers({2}, {0, 1})});
  good = graph.add_node("And", {good, graph.add_node("Equal", {column, graph.add_number(0.0)})});
  graph.add_node(
      "And",
      {good, add_range_check(graph, "parameter", parameters, model.target_map, output_margin)}, {},
      "in_range");
}

OnnxGraph make_snapshot_graph(const TrainedModel& model, OnnxType type) {
  OnnxGraph graph(type);
  const auto inputs = static_cast<std::int64_t>(model.inputs.size()),
             outputs = static_cast<std::int64_t>(model.targets.size());
  add_network(graph, model, graph.declare_input(kInputName, {"N", inputs}));
  graph.declare_output(kOutputName, {"N", outputs}, type);
  return graph;
}

OnnxGraph make_window_graph(const TrainedModel& model) {
  OnnxGraph graph(OnnxType::kDouble);
  const auto channels = static_cast<std::int64_t>(model.window->channels.size()),
             components = static_cast<std::int64_t>(model.inputs.size()),
             outputs = static_cast<std::int64_t>(model.targets.size());
  const Value record = graph.declare_input(kRecordName, {"N", channels, "samples"});
  const OnnxWindow window = add_window(graph, *model.window, record);
  add_flag(graph, model, record, window, add_network(graph, model, window.components));
  graph.declare_output(kOutputName, {"N", outputs}, OnnxType::kDouble);
  graph.declare_output("in_range", {"N", 1}, OnnxType::kBool);
  graph.declare_output(window.components, {"N", components}, OnnxType::kDouble);
  graph.declare_output(window.leftover, {"N", 1}, OnnxType::kDouble);
  if (!window.begin.empty()) graph.declare_output(window.begin, {"N", 1}, OnnxType::kDouble);
  return graph;
}

void add_properties(ProtobufMessage& proto, const NamedTexts& properties) {
  for (const auto& [key, value] : properties) {
    proto.add(ModelField::kProperties, make_property(key, value));
  }
}

std::string list_units(const std::vector<ColumnInfo>& columns) {
  std::vector<std::string> units;
  units.reserve(columns.size());
  for (const ColumnInfo& column : columns) units.push_back(column.unit);
  return join_names(units);
}

void add_columns(ProtobufMessage& proto, const std::string& what,
                 const std::vector<ColumnInfo>& columns, const Normalizer& map) {
  add_properties(proto, {{what + "_names", join_names(list_names(columns))},
                         {what + "_units", list_units(columns)},
                         {what + "_low", list_numbers(map.low())},
                         {what + "_high", list_numbers(map.high())}});
}

void add_window_properties(ProtobufMessage& proto, const WindowTransform& window) {
  add_properties(proto, {{"channel_names", join_names(list_names(window.channels))},
                         {"channel_units", list_units(window.channels)},
                         {"interval", format_number(window.grid.interval)},
                         {"window_samples", std::to_string(window.grid.samples)},
                         {"minimum_samples", std::to_string(window.minimum_samples())},
                         {"leftover_limit", format_number(calc_residual_limit(window))}});
}

constexpr char kSnapshotDocument[] =
    "Parameters of a car from measured channels. Outside of input_low to input_high the values are "
    "extrapolated.";
constexpr char kWindowDocument[] =
    "Parameters of a car from a record of its channels, sampled every `interval` seconds, at least "
    "minimum_samples of them, in the units of the channels; the window is searched for in all of "
    "it. Where in_range is false, values are extrapolated, or the bump is not in the record.";

}  // namespace

std::string make_onnx(const TrainedModel& model, OnnxNumber number, const NamedTexts& provenance) {
  const bool is_window = model.window.has_value();
  STRUT_CHECK(!is_window || number == OnnxNumber::kDouble, "windows need double precision");
  const OnnxType type = number == OnnxNumber::kDouble ? OnnxType::kDouble : OnnxType::kFloat;
  const OnnxGraph graph = is_window ? make_window_graph(model) : make_snapshot_graph(model, type);
  ProtobufMessage proto;
  proto.add(ModelField::kIr, kIrVersion)
      .add(ModelField::kProducer, std::string("strut"))
      .add(ModelField::kDocument, std::string(is_window ? kWindowDocument : kSnapshotDocument))
      .add(ModelField::kGraph, graph.finish("strut_identify"))
      .add(ModelField::kOperators, ProtobufMessage().add(1, std::string()).add(2, kOperatorSet));
  if (is_window) add_window_properties(proto, *model.window);
  add_columns(proto, is_window ? "component" : "input", model.inputs, model.input_map);
  add_columns(proto, "output", model.targets, model.target_map);
  add_properties(proto,
                 {{"output_ci95", list_numbers(model.ci95)}, {"plan_hash", model.plan_hash}});
  add_properties(proto, provenance);
  return proto.bytes();
}

}  // namespace strut
