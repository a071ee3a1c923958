"""Rigs: quarter cars, dampers on testing machines, driven masses."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from typing import SupportsFloat

import numpy.typing as npt

from . import _core
from ._car import Channel, Parameter, Run, list_names, make_array, make_number, make_settings
from ._program import Path


def load_rig(path: Path) -> Rig:
    """Reads a rig file (TOML) and returns its Rig.

    Raises InputError for a file that is no rig or holds a value out of range.
    """
    return Rig(path)


class Rig:
    """A model smaller than a car, driven by inputs over time."""

    __slots__ = ("_core", "_absolute_path")

    def __init__(self, path: Path) -> None:
        self._core = _core.Rig(os.fspath(path))
        self._absolute_path = os.path.abspath(os.fspath(path))

    def __repr__(self) -> str:
        return f"strut.load_rig({str(self._core.path)!r})"

    def __fspath__(self) -> str:
        return str(self._core.path)

    def __reduce__(self) -> tuple[Callable[[Path], Rig], tuple[str]]:
        return load_rig, (self._absolute_path,)

    @property
    def parameters(self) -> dict[str, Parameter]:
        """Every parameter by name."""
        return {p[0]: Parameter(*p[:4], (p[4], p[5]), p[6]) for p in self._core.list_parameters()}

    @property
    def channels(self) -> dict[str, Channel]:
        """Every channel of a run by name."""
        return {name: Channel(name, unit, text) for name, unit, text in self._core.list_channels()}

    @property
    def inputs(self) -> dict[str, Channel]:
        """What drives the rig, by name."""
        return {name: Channel(name, unit, text) for name, unit, text in self._core.list_inputs()}

    def simulate(
        self, maneuver: Path | Mapping[str, tuple[npt.ArrayLike, npt.ArrayLike]], *,
        channels: str | Iterable[str] | None = None, rate: SupportsFloat = 1000.0,
        duration: SupportsFloat | None = None, integrator: str | None = None, step: float | None = None,
        events: bool = True, **parameters: SupportsFloat
    ) -> Run:
        """Drives the rig, as `strut simulate` does; same bits.

        Args:
            maneuver: maneuver file of a rig (TOML), or arrays: {"road_position": (times [s], values [SI])},
                interpolated by cubic splines and constant before the first and after the last time.
            channels: names of the channels to record (default: all).
            rate: samples per second [Hz].
            duration: simulated time [s]; default: the maneuver's, or that of the longest input.
            integrator, step, events: as in Car.simulate.
            **parameters: values by name, e.g. stiffness=860 (SI).

        Returns:
            Run. It has no snapshot and no event.

        Raises:
            InputError: unknown name, value out of range, an input that is missing or not a function of time.
        """
        known = self.channels
        names = list_names(channels, known)
        inputs = []
        if isinstance(maneuver, Mapping):
            for name, pair in maneuver.items():
                times, values = (make_array(name, part, 1, " for times and one for values") for part in pair)
                inputs.append((name, times, values))
        integration = _core.Integration(integrator=integrator, step=step, events=events)
        settings = make_settings(parameters)
        run = self._core.simulate(
            None if isinstance(maneuver, Mapping) else os.fspath(maneuver), inputs,
            None if duration is None else make_number("duration", duration), settings,
            make_number("rate", rate), names, integration)
        return Run(run, names, [], dict(settings), known)
