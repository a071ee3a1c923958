#!/usr/bin/env python3
"""examples/python on a sweep and a network that the program makes, against what the program says.

usage: check_python_examples.py STRUT SOURCE_FOLDER

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
from run_commands import check, run

EXAMPLES = pathlib.Path(sys.argv[2]) / "examples"
sys.path.insert(0, str(EXAMPLES / "python"))
sys.dont_write_bytecode = True
import identify_with_network
import read_dataset


def make_sweep(strut, folder):
    """The folder of a small sweep, beside it the same as a merged file."""
    run(strut, "plan", EXAMPLES / "api/small_sweep.toml", "-o", folder / "cars")
    run(strut, "run", folder / "cars")
    run(strut, "merge", folder / "cars", "-o", folder / "merged.h5")
    return folder / "cars"


def check_same(tables, others, what):
    check(tables.keys() == others.keys() and len(tables) > 6, f"{what}: tables")
    for name, values in tables.items():
        check(np.array_equal(values, others[name], equal_nan=values.dtype.kind == "f"),
              f"{what}: {name}")


def check_retries(folder, sweep):
    """Rows of a retry replace the shard's, the last round's win; the tenth comes after the ninth."""
    (folder / "copy/shards").mkdir(parents=True)
    (folder / "copy/retries").mkdir()
    shard = sweep / "shards/000001.h5"
    (folder / "copy/shards/000001.h5").write_bytes(shard.read_bytes())
    plain = read_dataset.read_file(shard)
    for round_number in (0, 9, 10):
        with h5py.File(folder / f"copy/retries/000001.{round_number}.h5", "w") as file:
            for name, values in plain.items():
                file[name] = values[2:4]
            file["attempt"][...] = round_number + 2
    tables, _ = read_dataset.read_dataset(folder / "copy")
    mended = np.isin(tables["case_id"], plain["case_id"][2:4])
    check(mended.sum() == 2 and (tables["attempt"][mended] == 12).all()
          and (tables["attempt"][~mended] == 0).all(), f"retries: {tables['attempt']}")


def check_dataset(folder, sweep):
    tables, columns = read_dataset.read_dataset(sweep)
    check(list(tables["case_id"]) == list(range(20)), f"cases {tables['case_id']}")
    check(read_dataset.list_columns(columns, "parameters")
          == [("front_stiffness", "N/m"), ("rear_damping", "N s/m")], "columns")
    # The first axis is the slowest.
    check((tables["parameters"][:, 0] == np.repeat(np.arange(40e3, 35e3, -1e3), 4)).all(), "values")
    check_same(read_dataset.read_dataset(folder / "merged.h5")[0], tables, "merged.h5")
    check_retries(folder, sweep)
    out = run(sys.executable, EXAMPLES / "python/read_dataset.py", sweep)
    check(out.startswith("20 cases, 20 done\n") and "36000 to          40000 N/m" in out, out)


def write_snapshots(folder, tables, names):
    """All cases, and one whose first input lies beyond all of them."""
    rows = np.vstack([tables["snapshot"], tables["snapshot"][:1]])
    rows[-1, 0] += 1.0
    path = folder / "measured.csv"
    np.savetxt(path, rows, delimiter=",", fmt="%.17g", header=",".join(names), comments="")
    return path


def check_network(strut, folder, sweep):
    model = folder / "model.h5"
    run(strut, "train", sweep, "-o", model, "--hidden", "4,3", "--epochs", "30", "--allow-few")
    tables, columns = read_dataset.read_dataset(sweep)
    names = [name for name, _ in read_dataset.list_columns(columns, "snapshot")]
    measured = write_snapshots(folder, tables, names)
    told = json.loads(run(strut, "identify", model, measured, "--json", codes=(1,)))["rows"]
    with h5py.File(model) as file:
        values, in_range = identify_with_network.identify(
            file, identify_with_network.read_csv(measured))
        targets = identify_with_network.list_names(file["targets"])
    check(len(told) == len(values) == 21 and not in_range[-1], "a row beyond the range is flagged")
    check(in_range.sum() >= 14, "rows that trained lie in the range")
    compared, worst = 0, 0.0
    for row, own, inside in zip(told, values, in_range):
        check(inside == (not row["outside"]), f"{row['outside']}: {inside}")
        for name, value in zip(targets, own):
            expected = row["parameters"][name]["value"]
            check(np.isnan(value) == (expected is None), f"{name} = {value}, strut: {expected}")
            if expected is not None:
                worst = max(worst, abs(value / expected - 1))
                compared += 1
    # Some ten roundings of 1e-16, of numbers of the size of the largest weights.
    check(compared >= 28 and worst <= 1e-12, f"worst of {compared}: {worst} relative")
    out = run(sys.executable, EXAMPLES / "python/identify_with_network.py", model, measured)
    check(f"{targets[0]:24} {values[0][0]:.17g} +- " in out, out)
    check("outside of the range trained on" in out, out)
    print(f"{compared} values, worst {worst:.2g} relative")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        sweep = make_sweep(sys.argv[1], folder)
        check_dataset(folder, sweep)
        check_network(sys.argv[1], folder, sweep)


main()
