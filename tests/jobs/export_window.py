#!/usr/bin/env python3
"""Compares exported networks over windows with `strut identify` on 1,000 noisy records: the C source,
compiled, and the ONNX model, evaluated with NumPy alone.

usage: export_window.py STRUT SOURCE_FOLDER

Exit code 77: onnx is not there.
"""

import json
import pathlib
import sys
import tempfile

try:
    import numpy as np
    import onnx
except ImportError:
    print("skipped: no onnx (Debian: python3-onnx)")
    sys.exit(77)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_commands import check, run
from run_onnx import run_graph
from window_sweep import CHANNELS, RATE, run_window_sweep

RECORDS, SEED = 1000, 5
NOISE = (0.02, 1e-3)  # m/s^2, rad/s
BIAS = (0.3, 0.02)

DRIVER = """
#include "car.h"
#include <stdio.h>
int main(void) {{
  static double record[{size}], out[2];
  while (fread(record, sizeof(double), {size}, stdin) == {size}) {{
    const int flags = strut_identify_car(record, {samples}, out);
    printf("%d %.17g %.17g\\n", flags, out[0], out[1]);
  }}
  return strut_identify_car(record, {too_few}, out) == 8 ? 0 : 1;
}}
"""


def read_clean(strut, examples, folder):
    """Records without noise at 4 kHz, some of cars and speeds out of range."""
    random = np.random.default_rng(SEED)
    records = []
    for _ in range(20):
        settings = {"front_stiffness": random.uniform(35000, 40500),
                    "rear_damping": random.uniform(1790, 1990), "speed": random.uniform(19.4, 20.6)}
        words = [word for name, value in settings.items() for word in ("--set", f"{name}={value}")]
        run(strut, "simulate", examples / "vehicles/paper_sedan.toml",
            examples / "maneuvers/bump_20mps.toml", "-o", folder / "clean.csv", "--force", "--rate",
            "4000", *words)
        with open(folder / "clean.csv") as file:
            names = file.readline().lstrip("# ").strip().split(",")
            rows = np.loadtxt(file, delimiter=",")
        names = [name.split("[")[0].strip() for name in names]
        records.append(rows[:, [names.index(channel) for channel in CHANNELS]].T)
    return records


def draw_records(clean, samples):
    """Each sampled from a time of its own on, with noise and offsets; a few without the bump."""
    random = np.random.default_rng(SEED + 1)
    step = 4000 // RATE
    records = np.empty((RECORDS, len(CHANNELS), samples))
    for i, record in enumerate(records):
        first = 6000 if i % 100 == 99 else int(random.integers(600, 1400))
        source = clean[i % len(clean)]
        places = np.minimum(first + step * np.arange(samples), source.shape[1] - 1)
        record[:] = source[:, places]
        for c in range(len(CHANNELS)):
            record[c] += random.normal(0, NOISE[c], samples) + random.normal(0, BIAS[c])
    for i, size in enumerate((1e3, 1e160, 1e300)):  # spikes whose squares overflow
        records[50 * i + 7, 0, 2] = size
        records[50 * i + 8, 1, samples // 2] = size
    return records


def identify(strut, model, records, folder):
    """Values [RECORDS, 2] and flags of `strut identify --extrapolate`."""
    files = []
    for i, record in enumerate(records):
        files.append(folder / f"{i:04}.csv")
        times = np.arange(record.shape[1]) / RATE
        np.savetxt(files[-1], np.column_stack([times, record.T]), delimiter=",", fmt="%.17g",
                   header="time," + ",".join(CHANNELS), comments="")
    told = json.loads(run(strut, "identify", model, *files, "--extrapolate", "--json", codes=(0, 1)))
    values = [[p["value"] for p in row["parameters"].values()] for row in told["rows"]]
    return np.array(values, float), told["rows"]


def run_c(strut, model, records, folder):
    run(strut, "export", model, "-o", folder / "car.h", "--force")
    channels, samples = records.shape[1:]
    (folder / "main.c").write_text(DRIVER.format(size=channels * samples, samples=samples, too_few=100))
    run("cc", "-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror",
        folder / "main.c", "-o", folder / "main", "-lm")
    run(strut, "export", model, "-o", folder / "car.c", "--force")
    run("cc", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-c", folder / "car.c", "-o",
        folder / "car.o")
    run("c++", "-x", "c++", "-std=c++20", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only",
        folder / "main.c")
    records.tofile(folder / "records.bin")
    with open(folder / "records.bin") as file:
        lines = run(folder / "main", stdin=file).splitlines()
    rows = np.array([line.split() for line in lines], float)
    return rows[:, 1:], rows[:, 0].astype(int)


def run_onnx(strut, model, records, folder):
    path = folder / "car.onnx"
    run(strut, "export", model, "-o", path, "--force")
    loaded = onnx.load(str(path))
    onnx.checker.check_model(loaded, full_check=True)
    outputs = [run_graph(loaded.graph, part) for part in np.array_split(records, 50)]
    return {name: np.concatenate([part[name] for part in outputs]) for name in outputs[0]}, loaded


def compare(strut, examples, folder, window, samples, clean):
    """`window`: options of train. Trains, exports, and compares all three."""
    model = folder / "m.h5"
    run(strut, "train", folder / "sweep", "-o", model, "--force", "--hidden", "8,6", "--epochs", "60",
        "--targets", "front_stiffness,rear_damping", *window)
    records = draw_records(clean, samples)
    (folder / "records").mkdir(exist_ok=True)
    values, rows = identify(strut, model, records, folder / "records")
    aligned = np.array([all(o["channel"] != "alignment" for o in row["outside"]) for row in rows])
    c_values, flags = run_c(strut, model, records, folder)
    outputs, loaded = run_onnx(strut, model, records, folder)
    width = np.array([4500.0, 180.0])
    for name, other in (("C", c_values), ("ONNX", outputs["parameters"])):
        worst = np.abs(other - values)[aligned] / width
        print(f"{name}: differs by {worst.max():.2g} of the range")
        check(worst.max() <= 1e-10, f"{name}'s values are others, by {worst.max():.2g} of the range")
    good = np.array([row["in_range"] for row in rows])
    check((outputs["in_range"][:, 0] == good).all(), "ONNX's flags are others")
    check(((flags == 0) == good).all(), "C's flags are others")
    check((((flags & 4) == 0) == aligned).all(), "C's alignment is another one")
    inside = np.array([not row["outside"] for row in rows])
    check((((flags & 5) == 0) == inside).all(), "C's flag of the inputs is another one")
    print(f"{good.sum()} of {len(good)} in range, {(~aligned).sum()} without a bump")
    odd = records[:40].copy()
    for i, record in enumerate(odd):
        record[i % 2, (i // 2) * (samples // 20)] = (np.nan, np.inf)[i % 4 // 2]
    check((run_c(strut, model, odd, folder)[1] & 1 == 1).all(), "C takes what is no number")
    with np.errstate(invalid="ignore", over="ignore"):
        flagged = ~run_graph(loaded.graph, odd)["in_range"][:, 0]
    check(flagged.all(), "ONNX takes what is no number")
    properties = {entry.key: entry.value for entry in loaded.metadata_props}
    check(properties["channel_names"] == ", ".join(CHANNELS), "channel_names")
    check(float(properties["interval"]) == 1 / RATE, "interval")
    return good, aligned, properties


def main():
    strut = sys.argv[1]
    examples = pathlib.Path(sys.argv[2]) / "examples"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run_window_sweep(strut, examples, folder, 200, "rear_damping = { from = 1980, to = 1800 }\n")
        clean = read_clean(strut, examples, folder)
        good, aligned, properties = compare(strut, examples, folder, ["--window", "0.4:1.6"], 420, clean)
        check(0 < good.sum() < len(good) and not aligned.all(), "not all kinds of records were tried")
        check(int(properties["minimum_samples"]) == int(properties["window_samples"]) + 8, "samples")
        for extra in (["--float"], ["--name", "x y"]):
            run(strut, "export", folder / "m.h5", "-o", folder / "no.onnx", *extra, codes=(2,))
        compare(strut, examples, folder,
                ["--window", "0:1.6", "--align", "0", "--hit-time-sigma", "0"], 420, clean)


main()
