"""Sweeps: folders that `strut plan` makes and `strut run` fills."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._car import STATUSES, Channel, count_threads, describe_column
from ._program import Path, call

if TYPE_CHECKING:
    import pandas
    import xarray

    Progress = Callable[[dict[str, int]], object]


class Dataset:
    """The cases of a sweep, sorted by case.

    Attributes:
        case, stratum, status, attempt, event_time, failure_time: arrays, an element for each case.
        reason: list of texts, "" where a case is done.
        parameters, snapshot: dictionaries of arrays by name, (cases,).
        history: dictionary of arrays by channel, (cases, samples).
        time: times of the samples [s].
        units: unit by name.
        plan_hash: identity of the plan.
    """

    def __init__(self, tables: dict[str, Any]) -> None:
        self.case: npt.NDArray[np.int64] = tables["case"]
        self.stratum: npt.NDArray[np.int32] = tables["stratum"]
        self.status: npt.NDArray[np.int32] = tables["status"]
        self.attempt: npt.NDArray[np.int32] = tables["attempt"]
        self.event_time: npt.NDArray[np.float64] = tables["event_time"]
        self.failure_time: npt.NDArray[np.float64] = tables["failure_time"]
        self.reason: list[str] = tables["reason"]
        self.plan_hash: str = tables["plan_hash"]
        self._columns = {
            part: [Channel(*c) for c in tables[part + "_columns"]]
            for part in ("parameter", "snapshot", "history")
        }
        self.parameters = self._split("parameter", tables["parameters"])
        self.snapshot = self._split("snapshot", tables["snapshot"])
        self.history: dict[str, npt.NDArray[np.float64]] = {
            c.name: values for c, values in zip(self._columns["history"], tables["history"])
        }
        samples = next(iter(self.history.values())).shape[1] if self.history else 0
        self.time: npt.NDArray[np.float64] = tables["history_interval"] * np.arange(samples)
        self.units = {c.name: c.unit for part in self._columns.values() for c in part}

    def __len__(self) -> int:
        return len(self.case)

    def __repr__(self) -> str:
        done = int(np.count_nonzero(self.status == 0))
        return f"<strut.Dataset: {len(self)} cases, {done} done>"

    def to_dataframe(self) -> pandas.DataFrame:
        """pandas.DataFrame: a row for each case with parameters, snapshot, event_time, status and reason."""
        import pandas

        columns = {**self.parameters, **self.snapshot, "event_time": self.event_time,
                   "stratum": self.stratum, "status": [STATUSES[s] for s in self.status],
                   "reason": self.reason}
        frame = pandas.DataFrame(columns, index=pandas.Index(self.case, name="case"))
        frame.attrs["units"] = self.units
        return frame

    def to_xarray(self) -> xarray.Dataset:
        """xarray.Dataset over cases, with units; histories (NAME) over time, snapshots as
        snapshot_NAME."""
        import xarray

        data: dict[str, Any] = {
            "status": ("case", self.status),
            "stratum": ("case", self.stratum),
            "event_time": ("case", self.event_time, {"units": "s"}),
        }
        for c in self._columns["snapshot"]:
            data["snapshot_" + c.name] = ("case", self.snapshot[c.name], describe_column(c))
        for c in self._columns["history"]:
            if c.name == "time":
                continue
            data[c.name] = (("case", "time"), self.history[c.name], describe_column(c))
        coords: dict[str, Any] = {"case": ("case", self.case)}
        for c in self._columns["parameter"]:
            coords[c.name] = ("case", self.parameters[c.name], describe_column(c))
        if self.history:
            coords["time"] = ("time", self.time, {"units": "s"})
        return xarray.Dataset(data, coords=coords, attrs={"plan_hash": self.plan_hash})

    def _split(self, part: str, table: npt.NDArray[np.float64]) -> dict[str, npt.NDArray[np.float64]]:
        return {c.name: table[:, i] for i, c in enumerate(self._columns[part])}


def read_dataset(*paths: Path, partial: bool = False, histories: bool = True) -> Dataset:
    """Reads one sweep folder, one merged file, or shards, and returns a Dataset.

    Every byte is verified. With `partial` a folder may lack shards.
    Raises InputError that names the file at fault.
    """
    return Dataset(_core.read_dataset([os.fspath(p) for p in paths], partial, histories))


class Sweep:
    """A sweep in a folder.

    sweep = strut.Sweep("cars")
    sweep.plan("sweep.toml")
    sweep.run(progress=lambda p: print(p["done"], "of", p["cases"]))
    frame = sweep.to_dataframe()
    """

    def __init__(self, folder: Path) -> None:
        self.folder = os.fspath(folder)

    def __repr__(self) -> str:
        return f"strut.Sweep({self.folder!r})"

    def __fspath__(self) -> str:
        return self.folder

    def plan(self, request: Path, *, dry_run: bool = False) -> dict[str, Any]:
        """Creates the folder from a sweep file (TOML); returns what `strut plan --json` prints.

        Planning the same sweep again changes nothing; another one in the same folder is refused. With
        `dry_run` nothing is written.
        """
        if dry_run:
            return call("plan", request, dry_run=True)
        return call("plan", request, output=self.folder)

    def run(self, *, progress: Progress | None = None, threads: int | None = None) -> dict[str, Any]:
        """Simulates what is missing. Ctrl-C keeps what is finished; run again, it continues.

        Args:
            progress: called about ten times a second with a dictionary: cases, done, failed.
            threads: default: one for each processor.

        Returns:
            A dictionary: cases, present (done before), written, elsewhere (by other runners), failed,
            mended, shards, bytes, damaged (texts by shard), notes.

        Raises:
            InputError: no planned folder. EnvironmentError: the folder cannot be written.
        """
        return self._run(progress, threads, False)

    def resume(self, *, progress: Progress | None = None, threads: int | None = None) -> dict[str, Any]:
        """Like run(), and retries failed cases with smaller steps."""
        return self._run(progress, threads, True)

    def status(self) -> dict[str, Any]:
        """What `strut status --json` prints."""
        return call("status", self.folder)

    def verify(self, *, sample: int = 0) -> dict[str, Any]:
        """What `strut verify --json` prints; `sample` cases are simulated again."""
        return call("verify", self.folder, sample=sample)

    def merge(self, output: Path, *, partial: bool = False, force: bool = False) -> dict[str, Any]:
        """Writes one HDF5 file; returns what `strut merge --json` prints."""
        return call("merge", self.folder, output=output, partial=partial, force=force)

    def read(self, *, partial: bool = False, histories: bool = True) -> Dataset:
        """The cases as Dataset."""
        return read_dataset(self.folder, partial=partial, histories=histories)

    def to_dataframe(self, *, partial: bool = False) -> pandas.DataFrame:
        """Dataset.to_dataframe() of the cases."""
        return self.read(partial=partial, histories=False).to_dataframe()

    def to_xarray(self, *, partial: bool = False) -> xarray.Dataset:
        """Dataset.to_xarray() of the cases."""
        return self.read(partial=partial).to_xarray()

    def _run(self, progress: Progress | None, threads: int | None, retries: bool) -> dict[str, Any]:
        watch = None if progress is None else _make_watch(progress)
        return _core.run_sweep(self.folder, count_threads(threads), retries, watch)


def _make_watch(progress: Progress) -> Callable[[int, int, int], None]:
    def watch(cases: int, done: int, failed: int) -> None:
        progress({"cases": cases, "done": done, "failed": failed})

    return watch
