#include "train/export/onnx_window.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "train/data/shift.h"

namespace strut {
namespace {

using Value = OnnxGraph::Value;

// Axes of records and of their windows.
constexpr std::int64_t kChannels = 1, kSamples = 2;
constexpr auto kBefore = static_cast<std::int64_t>(ShiftStencil::kBefore);

std::int64_t to_integer(std::size_t value) { return static_cast<std::int64_t>(value); }

std::vector<std::int64_t> count_from(std::int64_t first, std::size_t count) {
  std::vector<std::int64_t> values(count);
  std::iota(values.begin(), values.end(), first);
  return values;
}

/// Places of the windows in a record: every whole sample from the stencil's reach on.
struct OnnxPlaces {
  Value count;    // scalar
  Value windows;  // [N, channels, places, samples]
};

OnnxPlaces add_places(OnnxGraph& graph, const WindowTransform& window, const Value& record) {
  const std::size_t n = window.grid.samples;
  const Value shape = graph.add_node("Shape", {record});
  const Value samples = graph.add_node("Gather", {shape, graph.add_integer(kSamples)});
  const Value count = graph.subtract(samples, graph.add_integer(to_integer(n) + 2 * kBefore - 1));
  const Value places =
      graph.add_node("Range", {graph.add_integer(kBefore),
                               graph.add(count, graph.add_integer(kBefore)), graph.add_integer(1)});
  const Value column = graph.add_node("Unsqueeze", {places, graph.add_integers({1}, {1})});
  const Value within = graph.add_integers({1, to_integer(n)}, count_from(0, n));
  return {count,
          graph.add_node("Gather", {record, graph.add(column, within)}, {{"axis", kSamples}})};
}

/// (y - share * mean(y)) / sigma over the last axis; `share` and `sigma` a number per channel.
Value add_whitening(OnnxGraph& graph, const Value& y, std::int64_t axis, std::size_t samples,
                    const Value& share, const Value& sigma) {
  const Value mean =
      graph.divide(graph.sum(y, axis), graph.add_number(static_cast<double>(samples)));
  return graph.divide(graph.subtract(y, graph.multiply(share, mean)), sigma);
}

/// Squared distances of the windows from the reference: [N, places, 1].
Value add_distances(OnnxGraph& graph, const WindowTransform& window, const Value& windows) {
  const std::int64_t channels = to_integer(window.channels.size());
  const std::int64_t n = to_integer(window.grid.samples);
  const Value sigma = graph.add_constant("sigma_of_windows", {channels, 1, 1}, window.noise.sigma);
  const Value white = add_whitening(graph, windows, kSamples + 1, window.grid.samples,
                                    graph.add_number(1.0), sigma);
  const Value difference =
      graph.subtract(white, graph.add_constant("reference", {channels, 1, n}, window.reference));
  const Value squares = graph.sum(graph.multiply(difference, difference), kSamples + 1);
  const Value distances = graph.add_node(
      "ReduceSum", {squares, graph.add_integers({1}, {kChannels})}, {{"keepdims", 0}});
  const Value most = graph.add_number(std::numeric_limits<double>::max());
  return graph.add_node("Where",
                        {graph.add_node("LessOrEqual", {distances, most}), distances, most});
}

/// find_alignment(); begin and found are [N, 1, 1].
struct OnnxAlignment {
  Value begin, found;
};

OnnxAlignment add_alignment(OnnxGraph& graph, const WindowTransform& window, const Value& record) {
  const OnnxPlaces places = add_places(graph, window, record);
  const Value distances = add_distances(graph, window, places.windows);
  const Value least = graph.add_node("ArgMin", {distances}, {{"axis", 1}, {"keepdims", 1}});
  const Value one = graph.add_integer(1);
  const Value last = graph.subtract(places.count, one);
  const Value found =
      graph.add_node("And", {graph.add_node("Greater", {least, graph.add_integer(0)}),
                             graph.add_node("Less", {least, last})});
  // A place with neighbors, also where the least is at an end.
  const Value inner =
      graph.add_node("Min", {graph.add_node("Max", {least, one}), graph.subtract(last, one)});
  const auto read = [&](const Value& place) {
    return graph.add_node("GatherElements", {distances, place}, {{"axis", 1}});
  };
  const Value before = read(graph.subtract(inner, one)), here = read(inner),
              after = read(graph.add(inner, one));
  const Value curvature =
      graph.add(graph.subtract(before, graph.multiply(graph.add_number(2.0), here)), after);
  const Value zero = graph.add_number(0.0);
  const Value is_minimum =
      graph.add_node("And", {found, graph.add_node("Greater", {curvature, zero})});
  const Value divisor = graph.add_node("Where", {is_minimum, curvature, graph.add_number(1.0)});
  const Value vertex =
      graph.divide(graph.multiply(graph.add_number(0.5), graph.subtract(before, after)), divisor);
  const Value place = graph.add_node("Cast", {graph.add(least, graph.add_integer(kBefore))},
                                     {{"to", static_cast<std::int64_t>(graph.type())}});
  return {graph.add(place, graph.add_node("Where", {is_minimum, vertex, zero})), found};
}

/// calc_shift_weights(u) for u [N, 1, 1].
std::vector<Value> add_shift_weights(OnnxGraph& graph, const Value& u) {
  std::vector<Value> distances, weights;
  for (std::size_t k = 0; k < ShiftStencil::kSamples; ++k) {
    distances.push_back(graph.subtract(
        u, graph.add_number(static_cast<double>(k) - (ShiftStencil::kBefore - 1.0))));
  }
  for (std::size_t a = 0; a < ShiftStencil::kSamples; ++a) {
    double divisor = 1.0;
    Value product;
    for (std::size_t k = 0; k < ShiftStencil::kSamples; ++k) {
      if (k == a) continue;
      divisor *= static_cast<double>(a) - static_cast<double>(k);
      product = product.empty() ? distances[k] : graph.multiply(product, distances[k]);
    }
    weights.push_back(graph.divide(product, graph.add_number(divisor)));
  }
  return weights;
}

/// The samples of a window between those of the record, and calc_shift_gain() [N, 1, 1].
struct OnnxShifted {
  Value samples, gain;
};

/// read_shifted() of all channels.
OnnxShifted add_shifted(OnnxGraph& graph, const WindowTransform& window, const Value& record,
                        const Value& begin) {
  const std::size_t n = window.grid.samples, reach = n + ShiftStencil::kSamples - 1;
  const Value whole = graph.add_node("Floor", {begin});
  const std::vector<Value> weights = add_shift_weights(graph, graph.subtract(begin, whole));
  const Value start =
      graph.add_node("Cast", {whole}, {{"to", static_cast<std::int64_t>(OnnxType::kInt64)}});
  std::vector<std::int64_t> offsets;
  for (std::size_t c = 0; c < window.channels.size(); ++c) {
    const std::vector<std::int64_t> row = count_from(1 - kBefore, reach);
    offsets.insert(offsets.end(), row.begin(), row.end());
  }
  const Value index = graph.add(
      start,
      graph.add_integers({1, to_integer(window.channels.size()), to_integer(reach)}, offsets));
  const Value block = graph.add_node("GatherElements", {record, index}, {{"axis", kSamples}});
  OnnxShifted shifted;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const Value term =
        graph.multiply(weights[k], graph.slice(block, kSamples, to_integer(k), to_integer(k + n)));
    const Value square = graph.multiply(weights[k], weights[k]);
    shifted.samples = k == 0 ? term : graph.add(shifted.samples, term);
    shifted.gain = k == 0 ? square : graph.add(shifted.gain, square);
  }
  return shifted;
}

/// Sets components and leftover from the samples of the windows; `gain`: "" where it is 1.
void add_projection(OnnxGraph& graph, const WindowTransform& window, const Value& samples,
                    const Value& gain, OnnxWindow& result) {
  const std::int64_t channels = to_integer(window.channels.size());
  const std::size_t size = window.window_size(), count = window.components();
  const Value share = graph.add_constant("mean_share", {1, channels, 1}, calc_mean_shares(window));
  const Value sigma = graph.add_constant("sigma", {1, channels, 1}, window.noise.sigma);
  const Value white = add_whitening(graph, samples, kSamples, window.grid.samples, share, sigma);
  const Value rows =
      graph.add_node("Reshape", {white, graph.add_integers({2}, {0, to_integer(size)})});
  const Value x =
      graph.subtract(rows, graph.add_constant("mean", {1, to_integer(size)}, window.mean));
  std::vector<double> columns(window.basis.size());
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < size; ++i) columns[i * count + k] = window.basis[k * size + i];
  }
  result.components = graph.add_node(
      "MatMul", {x, graph.add_constant("basis", {to_integer(size), to_integer(count)}, columns)},
      {}, "components");
  const Value norm = graph.sum(graph.multiply(x, x), 1);
  const Value inside = graph.sum(graph.multiply(result.components, result.components), 1);
  const Value outside =
      graph.add_node("Max", {graph.subtract(norm, inside), graph.add_number(0.0)});
  const Value residual = graph.divide(outside, graph.add_number(window.residual_degrees()));
  result.leftover = gain.empty() ? graph.add_node("Identity", {residual}, {}, "leftover")
                                 : graph.add_node("Div", {residual, gain}, {}, "leftover");
}

}  // namespace

OnnxWindow add_window(OnnxGraph& graph, const WindowTransform& window, const Value& record) {
  OnnxWindow result;
  if (window.reference.empty()) {
    const Value samples = graph.slice(record, kSamples, 0, to_integer(window.grid.samples));
    add_projection(graph, window, samples, "", result);
    return result;
  }
  const auto to_column = [&](const Value& value, const std::string& name) {
    return graph.add_node("Reshape", {value, graph.add_integers({2}, {0, 1})}, {}, name);
  };
  const OnnxAlignment alignment = add_alignment(graph, window, record);
  const OnnxShifted shifted = add_shifted(graph, window, record, alignment.begin);
  result.begin = to_column(alignment.begin, "begin");
  result.found = to_column(alignment.found, "");
  add_projection(graph, window, shifted.samples, to_column(shifted.gain, ""), result);
  return result;
}

}  // namespace strut
