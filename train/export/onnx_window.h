// The part of an ONNX graph that reads a window of a record: WindowTransform as operators.
#pragma once

#include "train/data/transform.h"
#include "train/export/onnx_graph.h"

namespace strut {

/// Tensors of N records.
struct OnnxWindow {
  OnnxGraph::Value components;  // [N, K]
  OnnxGraph::Value leftover;    // [N, 1], WindowReading::residual
  OnnxGraph::Value begin;       // [N, 1], start of the window in samples; "": not aligned
  OnnxGraph::Value found;       // [N, 1], WindowAlignment::found; "": not aligned
};

/// Adds read_components() of `record` [N, channels, samples], any number of samples that the window
/// has room in.
OnnxWindow add_window(OnnxGraph& graph, const WindowTransform& window,
                      const OnnxGraph::Value& record);

}  // namespace strut
