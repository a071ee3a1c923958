#!/usr/bin/env python3
"""Reads exported ONNX models as users do: checks them against the standard with onnx, evaluates
their graphs with NumPy alone, in double precision, and lets OpenCV run them, in single precision.

usage: read_with_onnx.py TEST_PROGRAM

The test program writes models, inputs, and the answers and derivatives that its library gives. Exit
code 77: onnx is not there.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy
    import onnx
except ImportError:
    print("skipped: no onnx (Debian: python3-onnx)")
    sys.exit(77)

try:
    import cv2
except ImportError:
    cv2 = None
    print("not checked: OpenCV (Debian: python3-opencv)")

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_commands import check
from run_onnx import run_graph

FLOAT_STEP = 2.0**-24  # largest relative error of rounding to single precision


def read_properties(model):
    return {entry.key: entry.value for entry in model.metadata_props}


def read_numbers(text):
    return numpy.array([float(part) for part in text.split(",")])


def check_description(model, name, columns):
    properties = read_properties(model)
    names = ["body_position_z", "body_velocity_z", "body_acceleration_z", "pitch_angle"]
    check(properties["input_names"].split(", ") == names[:columns], f"{name}: input_names")
    check(properties["input_units"].split(", ")[0] == "m", f"{name}: input_units")
    check(properties["plan_hash"] == "a" * 64, f"{name}: plan_hash")
    check(properties["strut_version"] == "1.2.3", f"{name}: strut_version")
    check(set(read_numbers(properties["output_ci95"])) == {0.25}, f"{name}: output_ci95")
    check([entry.version for entry in model.opset_import] == [13], f"{name}: operator set")
    dimension = model.graph.input[0].type.tensor_type.shape.dim[0]
    check(dimension.WhichOneof("value") == "dim_param", f"{name}: the batch has a fixed size")


def run_opencv(path, inputs, outputs):
    net = cv2.dnn.readNetFromONNX(str(path))
    answers = numpy.empty(outputs.shape)
    for row, values in enumerate(inputs):
        net.setInput(values.astype(numpy.float32).reshape(1, -1))
        answers[row] = net.forward().ravel()
    return answers


def check_model(folder, stem, precision):
    name = f"{stem}_{precision}"
    path = folder / f"{name}.onnx"
    model = onnx.load(str(path))
    onnx.checker.check_model(model, full_check=True)
    properties = read_properties(model)
    low, high = (read_numbers(properties["input_" + end]) for end in ("low", "high"))
    width = read_numbers(properties["output_high"]) - read_numbers(properties["output_low"])
    inputs = numpy.fromfile(folder / f"{stem}_inputs.bin").reshape(-1, len(low))
    outputs = numpy.fromfile(folder / f"{stem}_outputs.bin").reshape(-1, len(width))
    jacobians = numpy.fromfile(folder / f"{stem}_jacobians.bin").reshape(-1, len(width), len(low))
    check_description(model, name, len(low))
    # Rounding of x and of low to single precision, through the derivatives; and of the rest, some
    # 50 operations on values of order one, or of the size of the result.
    rounded = 2 * FLOAT_STEP * numpy.abs(jacobians) @ numpy.maximum(abs(low), abs(high))
    single = rounded + 50 * FLOAT_STEP * width + 4 * FLOAT_STEP * abs(outputs)
    if precision == "double":
        answers, allowed = run_graph(model.graph, inputs)["parameters"], 1e-12 * width
    else:
        answers = run_graph(model.graph, inputs.astype(numpy.float32))["parameters"]
        allowed = single
        check(answers.dtype == numpy.float32, f"{name}: not single precision")
    check(answers.shape == outputs.shape, f"{name}: shape of the answers")
    check((abs(answers - outputs) <= allowed).all(), f"{name}: NumPy's answers are others")
    if cv2 is not None:
        answers = run_opencv(path, inputs, outputs)
        worst = (abs(answers - outputs) / single).max()
        check(worst <= 1, f"{name}: OpenCV's answers are others, by {worst:.2g} of what is allowed")
        print(f"{name}: OpenCV differs by {worst:.2g} of what single precision allows")


def main():
    with tempfile.TemporaryDirectory() as name:
        subprocess.run([sys.argv[1], "[example_models]"], check=True, stdout=subprocess.DEVNULL,
                       env=os.environ | {"STRUT_EXAMPLE_FOLDER": name})
        folder = pathlib.Path(name)
        check(len(list(folder.glob("*.onnx"))) == 4, "the models are not there")
        for stem in ("deep", "linear"):
            for precision in ("double", "float"):
                check_model(folder, stem, precision)


main()
