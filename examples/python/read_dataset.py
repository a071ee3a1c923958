#!/usr/bin/env python3
"""Reads the cases of a sweep with h5py and numpy, from its folder, a shard, or a merged file.

usage: read_dataset.py SWEEP_FOLDER|FILE.h5
"""

import pathlib
import sys

import h5py
import numpy as np

TABLES = ("case_id", "parameters", "snapshot", "layer", "status", "attempt", "event_time",
          "failure_time")


def read_file(path):
    """Returns the tables and histories of a shard or a merged file by name, "history/pitch_rate": arrays
    with a row for each case."""
    with h5py.File(path) as file:
        histories = file["history"].attrs["names"].astype(str) if "history" in file else []
        names = TABLES + tuple(f"history/{name}" for name in histories)
        return {name: file[name][()] for name in names if name in file}


def calc_times(path, histories):
    """Returns the time of each column of a history [s]."""
    with h5py.File(path) as file:
        return np.arange(histories.shape[1]) * file.attrs["history_interval"]


def list_columns(path, table):
    """Returns names and units of the columns of `parameters` or `snapshot`."""
    with h5py.File(path) as file:
        attributes = file[table].attrs
        return list(zip(attributes["names"].astype(str), attributes["units"].astype(str)))


def read_folder(folder):
    """Returns all cases of a sweep's folder. Rows of retries replace those of their shard; later
    retries replace earlier ones."""
    pieces = []
    for shard in sorted((folder / "shards").glob("*.h5")):
        rows = read_file(shard)
        place = {case: row for row, case in enumerate(rows["case_id"])}
        retries = (folder / "retries").glob(shard.stem + ".*.h5")
        for retry in sorted(retries, key=lambda path: int(path.suffixes[-2][1:])):
            mended = read_file(retry)
            at = [place[case] for case in mended["case_id"]]
            for name, values in mended.items():
                rows[name][at] = values
        pieces.append(rows)
    return {name: np.concatenate([rows[name] for rows in pieces]) for name in pieces[0]}


def read_dataset(path):
    """Returns the tables in the order of the cases, and a file that has their column names and units."""
    path = pathlib.Path(path)
    tables = read_folder(path) if path.is_dir() else read_file(path)
    order = np.argsort(tables["case_id"])
    columns = min((path / "shards").glob("*.h5")) if path.is_dir() else path
    return {name: values[order] for name, values in tables.items()}, columns


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    tables, columns = read_dataset(sys.argv[1])
    done = tables["status"] == 0
    print(f"{len(done)} cases, {done.sum()} done")
    for table in ("parameters", "snapshot"):
        if table not in tables:
            continue
        for (name, unit), values in zip(list_columns(columns, table), tables[table][done].T):
            print(f"{name:24} {values.min():14.8g} to {values.max():14.8g} {unit}")
    for name, values in tables.items():
        if name.startswith("history/"):
            times = calc_times(columns, values)
            print(f"{name:24} {len(times)} samples from {times[0]:g} to {times[-1]:g} s")


if __name__ == "__main__":
    main()
