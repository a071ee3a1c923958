#!/usr/bin/env python3
"""Reads a shard and a merged file as users do, with h5py and h5dump, and computes their data digest
anew and checks their seals, from docs/data_format.md alone.

usage: read_with_h5py.py TEST_PROGRAM

The test program writes them with the bytes that every dataset must have. Exit code 77: h5py is not
there.
"""

import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import h5py
    import numpy
except ImportError:
    print("skipped: no h5py (Debian: python3-h5py)")
    sys.exit(77)


def check(good, what):
    if not good:
        sys.exit(f"failed: {what}")


def calc_row_hashes(file):
    """SHA-256 of each case, step 1 of the data digest."""
    columns = [("case_id", "<i8"), ("parameters", "<f8"), ("snapshot", "<f8"), ("layer", "<i4"),
               ("status", "<i4"), ("attempt", "<i4"), ("event_time", "<f8"), ("failure_time", "<f8")]
    if "history" in file:
        columns += [("history/" + name.decode(), "<f8") for name in file["history"].attrs["names"]]
    rows = [b""] * len(file["case_id"])
    for name, kind in columns:
        values = file[name][()].astype(kind)
        if kind == "<f8":
            values[numpy.isnan(values)] = numpy.frombuffer(bytes.fromhex("000000000000f87f"), "<f8")
        rows = [row + value.tobytes() for row, value in zip(rows, values)]
    return [hashlib.sha256(row).digest() for row in rows]


def calc_data_digest(file):
    sums = [0, 0, 0, 0]
    hashes = calc_row_hashes(file)
    for row in hashes:
        words = [int.from_bytes(row[i:i + 8], "little") for i in (0, 8, 16, 24)]
        sums = [(a + b) % 2**64 for a, b in zip(sums, words)]
    text = ":".join([str(len(hashes))] + [format(total, "x") for total in sums])
    return hashlib.sha256(text.encode()).hexdigest()


def check_file(path, folder):
    with h5py.File(path) as file:
        for expected in folder.glob("*.bin"):
            name = expected.stem.replace("+", "/")
            check(file[name][()].tobytes() == expected.read_bytes(),
                  f"{path.name}: {name} has other bytes")
        reasons = file["reason"][()]
        if reasons.ndim == 2:  # of a merged file, by character
            reasons = numpy.ascontiguousarray(reasons).view(f"S{reasons.shape[1]}")[:, 0]
        check([text.decode() for text in reasons]
              == (folder / "reason.txt").read_text().split("\n")[:-1], f"{path.name}: reasons")
        snapshot = file["snapshot"]
        check(list(snapshot.attrs["names"].astype(str)) == ["pitch_angle", "body_position_z"], "names")
        check(list(snapshot.attrs["units"].astype(str)) == ["rad", "m"], "units")
        check(snapshot.attrs["unit"].decode() == "mixed", "unit")
        check(file["event_time"].attrs["unit"].decode() == "s", "unit of event_time")
        check(file.attrs["plan_hash"].decode() == "a" * 64, "plan_hash")
        check(file.attrs["schema_version"] == 1, "schema_version")
        check(file.attrs["checksum"].decode() == calc_data_digest(file),
              f"{path.name}: the data digest by the documentation is another one")


def check_seal(path):
    """The first 512 bytes, of a merged file the last ones: lines of text, then zeros."""
    data = path.read_bytes()
    is_merged = path.stem == "merged"
    seal, rest = (data[-512:], data[:-512]) if is_merged else (data[:512], data[512:])
    lines = seal.rstrip(b"\0").decode().splitlines()
    words = dict(line.split(" ", 1) for line in lines[1:])
    above = "".join(line + "\n" for line in lines[:-1])
    check(lines[0] == f"strut {path.stem} seal 1", f"{path.name}: {lines[0]}")
    check(words["plan"] == "a" * 64, f"{path.name}: plan of the seal")
    check(int(words["size"]) == len(data), f"{path.name}: size of the seal")
    check(words["sha256"] == hashlib.sha256(rest).hexdigest(), f"{path.name}: sha256")
    check(words["seal"] == hashlib.sha256(above.encode()).hexdigest(), f"{path.name}: seal")


def check_dump(path):
    if shutil.which("h5dump") is None:
        print("not checked: h5dump (Debian: hdf5-tools)")
        return
    text = subprocess.run(["h5dump", "-d", "/layer", "-y", "-w", "200", path], check=True,
                          capture_output=True, text=True, cwd=path.parent).stdout
    check("0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0" in text, f"{path.name}: h5dump prints other layers")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([sys.argv[1], "[example_files]"], check=True, stdout=subprocess.DEVNULL,
                       env=os.environ | {"STRUT_EXAMPLE_FOLDER": name})
        files = sorted(folder.glob("*.h5"))
        check(len(files) == 2, "shard and merged file are not there")
        for path in files:
            check_seal(path)
            check_file(path, folder)
            check_dump(path)


main()
