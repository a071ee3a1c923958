#!/usr/bin/env python3
"""Reads a shard, a merged file and a view as users do, with h5py and h5dump.

usage: read_with_h5py.py TEST_PROGRAM

The test program writes them with the bytes that every dataset must have. Exit code 77: h5py is not
there.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import h5py
except ImportError:
    print("skipped: no h5py (Debian: python3-h5py)")
    sys.exit(77)


def check(good, what):
    if not good:
        sys.exit(f"failed: {what}")


def check_file(path, folder):
    with h5py.File(path) as file:
        for expected in folder.glob("*.bin"):
            name = expected.stem.replace("+", "/")
            check(file[name][()].tobytes() == expected.read_bytes(),
                  f"{path.name}: {name} has other bytes")
        check([text.decode() for text in file["reason"][()]]
              == (folder / "reason.txt").read_text().split("\n")[:-1], f"{path.name}: reasons")
        snapshot = file["snapshot"]
        check(list(snapshot.attrs["names"]) == ["pitch_angle", "body_position_z"], "names")
        check(list(snapshot.attrs["units"]) == ["rad", "m"], "units")
        check(snapshot.attrs["unit"] == "mixed", "unit")
        check(file["event_time"].attrs["unit"] == "s", "unit of event_time")
        check(file.attrs["plan_hash"] == "a" * 64, "plan_hash")
        check(file.attrs["schema_version"] == 1, "schema_version")


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
        check(len(files) == 3, "shard, merged file and view are not there")
        for path in files:
            check_file(path, folder)
            check_dump(path)


main()
