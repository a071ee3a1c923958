"""Trained networks, and the verbs of the program that take minutes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt

from . import _core
from ._car import make_array
from ._errors import InputError
from ._program import Path, call

if TYPE_CHECKING:
    import pandas


class Network:
    """A network of `strut train` that maps snapshots to parameters.

    network = strut.Network.load("model.h5")
    values, half = network.predict(X)
    """

    def __init__(self, core: _core.Network, path: str) -> None:
        self._core = core
        self._path = path
        self._inputs = core.inputs
        self._targets = core.targets

    @classmethod
    def load(cls, path: Path) -> Network:
        """Reads a model file. Raises InputError for another file, or a network over windows."""
        core = _core.Network(os.fspath(path))
        if core.is_window:
            raise InputError(f"{os.fspath(path)}: a network over windows of records; "
                             "allowed: strut.identify")
        return cls(core, os.fspath(path))

    def __repr__(self) -> str:
        return f"<strut.Network: {', '.join(self.inputs)} to {', '.join(self.targets)}>"

    @property
    def inputs(self) -> list[str]:
        """Names of the inputs, in order."""
        return [i[0] for i in self._inputs]

    @property
    def targets(self) -> list[str]:
        """Names of the parameters, in order."""
        return [t[0] for t in self._targets]

    @property
    def units(self) -> dict[str, str]:
        """Units by name."""
        return {**{i[0]: i[1] for i in self._inputs}, **{t[0]: t[1] for t in self._targets}}

    def predict(
        self, inputs: npt.ArrayLike | Mapping[str, npt.ArrayLike] | pandas.DataFrame, *,
        extrapolate: bool = False
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Parameters of snapshots.

        Args:
            inputs: array (rows, inputs) or (inputs,); or by input name numbers or arrays: a snapshot of a
                run, a DataFrame.
            extrapolate: also give values outside of the range trained on; otherwise they are NaN.

        Returns:
            (values, half_width): arrays (rows, targets), and half the width of the 95 % interval of
            each target (targets,), both in the targets' units.
        """
        if hasattr(inputs, "keys"):
            table = cast("Mapping[str, npt.ArrayLike]", inputs)
            missing = [name for name in self.inputs if name not in table]
            if missing:
                raise InputError(f"inputs: lack {', '.join(missing)}")
            columns = [make_array(name, np.atleast_1d(table[name]), 1) for name in self.inputs]
            if len({len(column) for column in columns}) > 1:
                raise InputError("inputs: have columns of different lengths")
            rows = np.column_stack(columns)
        else:
            rows = make_array("inputs", np.atleast_2d(inputs), 2)
        values = self._core.predict(rows)
        if not extrapolate:
            low = np.array([i[2] for i in self._inputs])
            high = np.array([i[3] for i in self._inputs])
            inside = np.all((rows >= low) & (rows <= high), axis=1)
            values[~inside] = np.nan
        return values, np.array([t[2] for t in self._targets])


def train(data: Path | Iterable[Path], output: Path, **options: Any) -> dict[str, Any]:
    """Trains a network on a sweep folder, shards or a merged file; returns what `strut train --json`
    prints. Options are those of the program, e.g. hidden="27,19,11", goal=1e-8, threads=2."""
    data = [data] if isinstance(data, (str, os.PathLike)) else list(data)
    return call("train", *data, output=output, **options)


def evaluate(model: Path, *data: Path, **options: Any) -> dict[str, Any]:
    """Errors of a network on data; returns what `strut evaluate --json` prints."""
    return call("evaluate", model, *data, **options)


def identify(model: Path, *measured: Path, **options: Any) -> dict[str, Any]:
    """Identifies parameters from measured files; returns what `strut identify --json` prints.

    Options are those of the program: identify("model.h5", "drive.csv", event_time=0.632,
    noise={"pitch_angle": 2e-4}), identify("car.toml", "drive.csv", maneuver="bump.toml").
    """
    return call("identify", model, *measured, **options)


def compare(campaign: Path, output: Path, **options: Any) -> dict[str, Any]:
    """Compares measured runs with simulated ones; returns what `strut compare --json` prints, and
    writes the comparison to the folder `output`."""
    return call("compare", campaign, output=output, **options)


def diagnose(campaign: Path, output: Path, **options: Any) -> dict[str, Any]:
    """Finds what a model lacks; returns what `strut diagnose --json` prints, and writes the diagnosis
    to the folder `output`."""
    return call("diagnose", campaign, output=output, **options)
