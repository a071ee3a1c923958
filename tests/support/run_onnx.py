"""Evaluates ONNX graphs with NumPy alone, by the definitions of their operators (operator set 13)."""

import numpy
import onnx
from onnx import numpy_helper


def take(values, index, axis=0):
    return numpy.take(values, index, axis=axis)


def cast(values, to):
    return values.astype(onnx.helper.tensor_dtype_to_np_dtype(to) if hasattr(
        onnx.helper, "tensor_dtype_to_np_dtype") else onnx.mapping.TENSOR_TYPE_TO_NP_TYPE[to])


def slice_axis(values, begin, end, axis):
    index = [slice(None)] * values.ndim
    index[int(axis[0])] = slice(int(begin[0]), int(end[0]))
    return values[tuple(index)]


def arg_min(values, axis, keepdims):
    index = numpy.argmin(values, axis=axis)
    return numpy.expand_dims(index, axis) if keepdims else index


def reshape(values, shape):
    """0 keeps a size."""
    return values.reshape([values.shape[i] if size == 0 else size for i, size in enumerate(shape)])


def gather_elements(values, index, axis):
    """The index has the values' sizes but along the axis, and no negative element here."""
    assert index.min() >= 0 and all(
        i == axis or a == b for i, (a, b) in enumerate(zip(values.shape, index.shape)))
    return numpy.take_along_axis(values, index, axis)


OPERATORS = {
    "Add": numpy.add, "Sub": numpy.subtract, "Mul": numpy.multiply, "Div": numpy.divide,
    "Tanh": numpy.tanh, "Floor": numpy.floor, "MatMul": numpy.matmul, "Identity": lambda x: x,
    "Max": numpy.maximum, "Min": numpy.minimum, "And": numpy.logical_and,
    "Greater": numpy.greater, "Equal": numpy.equal, "Less": numpy.less, "GreaterOrEqual": numpy.greater_equal,
    "LessOrEqual": numpy.less_equal, "Where": numpy.where, "Range": numpy.arange,
    "Shape": lambda x: numpy.array(x.shape, numpy.int64), "Gather": take, "Cast": cast,
    "Unsqueeze": lambda x, axes: numpy.expand_dims(x, tuple(axes)), "Slice": slice_axis,
    "Reshape": reshape, "ArgMin": arg_min,
    "ReduceSum": lambda x, axes, keepdims: x.sum(axis=tuple(axes), keepdims=bool(keepdims)),
    "GatherElements": gather_elements,
}


def gemm(a, b, c, transB):
    assert transB == 1
    return a @ b.T + c


def run_graph(graph, inputs):
    """The outputs of a graph by name, in the precision of `inputs`."""
    values = {tensor.name: numpy_helper.to_array(tensor) for tensor in graph.initializer}
    values[graph.input[0].name] = inputs
    for node in graph.node:
        arguments = [values[name] for name in node.input]
        flags = {attribute.name: onnx.helper.get_attribute_value(attribute)
                 for attribute in node.attribute}
        operator = gemm if node.op_type == "Gemm" else OPERATORS[node.op_type]
        values[node.output[0]] = operator(*arguments, **flags)
    return {output.name: values[output.name] for output in graph.output}
