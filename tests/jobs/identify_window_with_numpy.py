#!/usr/bin/env python3
"""Identifies a recorded window from the model's file alone, with h5py and numpy, as docs/window.md
says, and compares with `strut identify`.

usage: identify_window_with_numpy.py STRUT SOURCE_FOLDER

Exit code 77: h5py is not there.
"""

import json
import pathlib
import sys
import tempfile

try:
    import h5py
    import numpy as np
except ImportError:
    print("skipped: no h5py (Debian: python3-h5py)")
    sys.exit(77)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_commands import run
from window_sweep import RATE, run_window_sweep

sys.path.insert(0, str(pathlib.Path(sys.argv[2]) / "examples/python"))
sys.dont_write_bytecode = True
from identify_with_network import calc_outputs, read_csv


def find_begin(y, reference, n):
    """The place of the least distance, refined by a parabola."""
    distance = []
    for begin in range(3, y.shape[1] - n - 3 + 1):
        w = y[:, begin:begin + n]
        w = w - w.mean(axis=1, keepdims=True)
        distance.append(((w - reference) ** 2).sum())
    k = int(np.argmin(distance))
    a, b, c = distance[k - 1:k + 2]
    return 3 + k + 0.5 * (a - c) / (a - 2 * b + c)


def shift(y, begin, n):
    """Through six samples around each place."""
    whole = int(np.floor(begin))
    u = begin - whole
    out = np.zeros((y.shape[0], n))
    for a in range(-2, 4):
        weight = np.prod([(u - b) / (a - b) for b in range(-2, 4) if b != a])
        out += weight * y[:, whole + a:whole + a + n]
    return out


def identify(model, record):
    window = model["window"]
    sigma, bias = window["noise"][:]
    n = int(window.attrs["samples"])
    y = np.stack([record[name.decode()] for name in window["noise"].attrs["names"]])
    begin = find_begin(y / sigma[:, None], window["reference"][:].reshape(-1, n), n)
    z = shift(y, begin, n)
    for c in range(len(sigma)):  # (s^2 I + b^2 1 1')^(-1/2), by its eigenvectors
        values, vectors = np.linalg.eigh(sigma[c] ** 2 * np.eye(n) + bias[c] ** 2 * np.ones((n, n)))
        z[c] = vectors @ ((vectors.T @ z[c]) / np.sqrt(values))
    x = window["basis"][:] @ (z - window["mean"][:].reshape(-1, n)).ravel()
    return calc_outputs(model, x[None, :])[0]


def main():
    strut = sys.argv[1]
    examples = pathlib.Path(sys.argv[2]) / "examples"
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        run_window_sweep(strut, examples, folder, 60)
        run(strut, "train", folder / "sweep", "-o", folder / "m.h5", "--window", "0.4:1.6",
            "--hidden", "5,4", "--epochs", "10", "--targets", "front_stiffness")
        run(strut, "simulate", examples / "vehicles/paper_sedan.toml",
            examples / "maneuvers/bump_20mps.toml", "-o", folder / "run.csv", "--rate", RATE,
            "--set", "front_stiffness=37654", "--set", "bump_distance=10.234")
        told = json.loads(run(strut, "identify", folder / "m.h5", folder / "run.csv", "--json",
                              codes=(0, 1)))
        value = told["parameters"]["front_stiffness"]["value"]
        with h5py.File(folder / "m.h5") as model:
            own = identify(model, read_csv(folder / "run.csv"))[0]
    # The range of 4500 N/m times what eigenvectors of condition 10^4 lose.
    if not abs(value - own) < 1e-6:
        sys.exit(f"failed: strut says {value}, numpy {own}")
    print(f"strut {value}, numpy {own}")


main()
