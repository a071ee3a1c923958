#!/usr/bin/env python3
"""Identifies a car's parameters with a network of `strut train`, using only h5py and numpy.

usage: identify_with_network.py MODEL.h5 MEASURED.csv

MEASURED.csv: a line with the names of the columns, then one snapshot per row, as for `strut identify`.
Prints a table of parameters with the half-widths of their 95 % intervals.
"""

import sys

import h5py
import numpy as np


def calc_outputs(model, inputs):
    """Returns the network's outputs for rows of inputs, both in their own units. `model`: the open file."""
    low, high = model["inputs"][()]
    a = 2.0 * (inputs - low) / (high - low) - 1.0  # onto [-1, 1]
    sizes, weights, at = model["layer_sizes"][()], model["weights"][()], 0
    for layer, (n, m) in enumerate(zip(sizes[:-1], sizes[1:])):
        w = weights[at:at + n * m].reshape(m, n)
        b = weights[at + n * m:at + n * m + m]
        at += n * m + m
        a = a @ w.T + b
        if layer < len(sizes) - 2:  # all layers except the last are hidden
            a = np.tanh(a)
    low, high = model["targets"][()]
    return low + 0.5 * (a + 1.0) * (high - low)


def list_names(table):
    return list(table.attrs["names"].astype(str))


def identify(model, snapshots):
    """Returns the parameters for `snapshots` (a dict of columns), and which rows lie in the training
    range. Outside it the network is not valid, and the parameters are NaN."""
    inputs = np.column_stack([snapshots[name] for name in list_names(model["inputs"])])
    low, high = model["inputs"][()]
    in_range = ((inputs >= low) & (inputs <= high)).all(axis=1)
    return np.where(in_range[:, None], calc_outputs(model, inputs), np.nan), in_range


def read_csv(path):
    with open(path, encoding="utf-8") as file:
        lines = [line for line in file if line.strip()]
    values = np.loadtxt([line for line in lines[1:] if not line.startswith("#")], delimiter=",",
                        ndmin=2)
    return dict(zip(lines[0].strip().split(","), values.T))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with h5py.File(sys.argv[1]) as model:
        if "window" in model:
            sys.exit(f"{sys.argv[1]}: a network over windows of records: docs/window.md")
        values, in_range = identify(model, read_csv(sys.argv[2]))
        names, units = list_names(model["targets"]), model["targets"].attrs["units"].astype(str)
        half_widths = model["ci95"][()]
    for row, inside in zip(values, in_range):
        if not inside:
            print("outside of the range trained on")
        for name, value, half_width, unit in zip(names, row, half_widths, units):
            print(f"{name:24} {value:.17g} +- {half_width:.3g} {unit}")


if __name__ == "__main__":
    main()
