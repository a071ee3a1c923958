"""Cars and their runs."""

from __future__ import annotations

import dataclasses
import difflib
import os
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn, SupportsFloat

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import InputError
from ._program import Path

if TYPE_CHECKING:
    import pandas
    import xarray


@dataclasses.dataclass(frozen=True)
class Parameter:
    """A number of a car or of its maneuver that is set by name."""

    name: str
    unit: str  # SI; "1" if none
    description: str
    default: float  # the value in the file
    range: tuple[float, float]  # (low, high), the values allowed
    is_maneuver: bool  # belongs to the maneuver


@dataclasses.dataclass(frozen=True)
class Channel:
    """A quantity that a run records."""

    name: str
    unit: str  # SI; "1" if none
    description: str


# The inputs of the paper's network.
PAPER_CHANNELS: tuple[str, ...] = ("body_position_z", "body_velocity_z", "body_acceleration_z",
                                   "pitch_angle", "pitch_rate")

CHANNELS: dict[str, Channel] = {name: Channel(name, unit, text) for name, unit, text in _core.list_channels()}
STATUSES: list[str] = [name for name, _ in _core.list_statuses()]
_REASONS = dict(_core.list_statuses())
_INDEX = {name: i for i, name in enumerate(CHANNELS)}


def list_names(channels: str | Iterable[str] | None, known: Mapping[str, Channel]) -> list[str]:
    """The channels asked for, all if None. Raises InputError for an unknown one."""
    names = list(known) if channels is None else [channels] if isinstance(
        channels, str) else list(channels)
    for name in names:
        if name not in known:
            _refuse("channel", name, known)
    return names


def _describe_unknown(what: str, name: object, known: Collection[str]) -> str:
    near = difflib.get_close_matches(str(name), known, 1)
    hint = f"; did you mean {near[0]}?" if near else ""
    return f"{what} = {name}: unknown{hint}; allowed: {', '.join(known) or 'none'}"


def _refuse(what: str, name: object, known: Collection[str]) -> NoReturn:
    raise InputError(_describe_unknown(what, name, known))


class _UnknownChannel(InputError, KeyError):
    """As a mapping expects it, so that run.get() works."""

    __str__ = InputError.__str__


def make_array(
    name: str, values: npt.ArrayLike, dimensions: int, hint: str = ""
) -> npt.NDArray[np.float64]:
    """Numbers as array of doubles of their own; InputError where they are none."""
    array: npt.NDArray[Any] | None
    try:
        array = np.asarray(values)
        if array.dtype.kind in "biufO":
            array = array.astype(float)
    except (TypeError, ValueError, OverflowError):
        array = None
    if array is None or array.dtype.kind != "f" or array.ndim != dimensions:
        raise InputError(f"{name}: must be an array of numbers in {dimensions} dimension(s){hint}")
    return array


def make_number(name: str, value: SupportsFloat) -> float:
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} = {value!r}: must be a number") from None


def count_threads(threads: int | None) -> int:
    """The number given, or one for each processor. Raises InputError."""
    if threads is None:
        return len(os.sched_getaffinity(0))
    number = make_number("threads", threads)
    if not 1 <= number <= 1024 or number != int(number):
        raise InputError(f"threads = {threads}: must be a whole number in [1, 1024]")
    return int(number)


def make_settings(settings: Mapping[str, SupportsFloat]) -> list[tuple[str, float]]:
    """Numbers by name; everything that float() takes, but no arrays."""
    return [(name, make_number(name, value)) for name, value in settings.items()]


def load(path: Path) -> Car:
    """Reads a vehicle file (TOML) and returns its Car.

    Raises InputError for a file that is no vehicle or holds a value out of range.
    """
    return Car(path)


class Car:
    """A car, read from a vehicle file."""

    # A misspelled attribute is refused: parameters are given to simulate().
    __slots__ = ("_core", "_absolute_path")

    def __init__(self, path: Path) -> None:
        self._core = _core.Car(os.fspath(path))
        self._absolute_path = os.path.abspath(os.fspath(path))

    def __repr__(self) -> str:
        return f"strut.load({str(self._core.path)!r})"

    def __fspath__(self) -> str:
        return str(self._core.path)

    def __reduce__(self) -> tuple[Callable[[Path], Car], tuple[str]]:
        return load, (self._absolute_path,)

    @property
    def parameters(self) -> dict[str, Parameter]:
        """Every parameter by name, those of a maneuver with their general defaults."""
        return {p[0]: Parameter(*p[:4], (p[4], p[5]), p[6]) for p in self._core.list_parameters()}

    @property
    def channels(self) -> dict[str, Channel]:
        """Every channel of a run by name."""
        return dict(CHANNELS)

    def simulate(
        self, maneuver: Path, *, channels: str | Iterable[str] | None = None,
        rate: SupportsFloat = 1000.0, derivatives: str | Iterable[str] = (),
        integrator: str | None = None, step: float | None = None, coarse_step: float | None = None,
        closure: str | None = None, spin: str | None = None, events: bool = True,
        **parameters: SupportsFloat
    ) -> Run:
        """Drives the car through a maneuver, as `strut simulate` does; same bits.

        Args:
            maneuver: maneuver file (TOML).
            channels: names of the channels to record (default: all).
            rate: samples per second [Hz].
            derivatives: names of parameters; the run is then differentiated by them, with tables as
                closure (Run.derivative).
            integrator: "rk4" (default), "abm4" or "cvode" (tolerance 1e-12).
            step, coarse_step: steps on the bump and away from it [s].
            closure: "newton" (default) or "table".
            spin: "exponential" (default) or "explicit".
            events: whether steps end at contact events.
            **parameters: values by name, e.g. front_stiffness=38000 (SI).

        Returns:
            Run. A run that fails has a status, and NaN after its failure.

        Raises:
            InputError: unknown name, value out of range, a car that cannot stand or roll.
        """
        names = list_names(channels, CHANNELS)
        derivatives = [derivatives] if isinstance(derivatives, str) else list(derivatives)
        if derivatives and closure is None:
            closure = "table"
        integration = _core.Integration(
            integrator=integrator, step=step, coarse_step=coarse_step, closure=closure, spin=spin,
            events=events)
        settings = make_settings(parameters)
        run = self._core.simulate(
            os.fspath(maneuver), settings, make_number("rate", rate), names, derivatives, integration)
        return Run(run, names, derivatives, dict(settings))


class Run(Mapping[str, npt.NDArray[np.float64]]):
    """One run, its histories by channel: run["body_acceleration_z"] is a view, without a copy.

    Runs are equal only to themselves.
    """

    __eq__ = object.__eq__
    __hash__ = object.__hash__

    def __reduce__(self) -> tuple[Any, ...]:
        stored = _StoredRun(self._core, len(self._columns), len(self._directions))
        return Run, (stored, list(self._columns), list(self._directions), self.parameters, self.channels)

    def __init__(
        self, core: _core.Run | _StoredRun, channels: Sequence[str], derivatives: Sequence[str],
        parameters: dict[str, float], known: Mapping[str, Channel] = CHANNELS
    ) -> None:
        self._core = core
        self.channels = dict(known)  # of the model, by name: units
        self.parameters = parameters  # as given, by name
        self._columns = {name: i for i, name in enumerate(channels)}
        self._directions = {name: i for i, name in enumerate(derivatives)}

    def __repr__(self) -> str:
        count = self._core.sample_count
        return f"<strut.Run: {self.status}, {count} samples of {len(self._columns)} channels>"

    def __len__(self) -> int:
        return len(self._columns)

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __contains__(self, channel: object) -> bool:
        return channel in self._columns

    def __getitem__(self, channel: str) -> npt.NDArray[np.float64]:
        if channel not in self._columns:
            raise _UnknownChannel(_describe_unknown("channel", channel, self._columns))
        return self._core.view(self._columns[channel])

    def derivative(self, channel: str, parameter: str) -> npt.NDArray[np.float64]:
        """d(channel)/d(parameter) at every sample, per unit of the parameter; a view."""
        if channel not in self._columns:
            _refuse("channel", channel, self._columns)
        return self._core.view(self._columns[channel], self._get_direction(parameter))

    @property
    def time(self) -> npt.NDArray[np.float64]:
        """Times of the samples [s]."""
        return self._core.interval * np.arange(self._core.sample_count)

    @property
    def status(self) -> str:
        """"done", or why the run failed."""
        return STATUSES[self._core.status]

    @property
    def reason(self) -> str:
        """What the status means; "" if the run is done."""
        return _REASONS[self.status]

    @property
    def failure_time(self) -> float:
        """When the run failed [s]; NaN if it is done."""
        return float("nan") if self.status == "done" else self._core.failure_time

    @property
    def event_time(self) -> float:
        """When the rear wheels are on the bump [s]; NaN if they never are."""
        return self._core.event_time()

    @property
    def snapshot(self) -> dict[str, float]:
        """Every channel of a car at that time, by name; NaN where there is none."""
        return {name: self._core.snapshot(i) for name, i in _INDEX.items()}

    def snapshot_derivative(self, parameter: str) -> dict[str, float]:
        """Derivative of the snapshot, whose time moves with the parameter, too."""
        direction = self._get_direction(parameter)
        return {name: self._core.snapshot(i, direction) for name, i in _INDEX.items()}

    def event_time_derivative(self, parameter: str) -> float:
        """Derivative of event_time, s per unit of the parameter."""
        return self._core.event_time(self._get_direction(parameter))

    def to_dataframe(self) -> pandas.DataFrame:
        """pandas.DataFrame of all recorded channels, with time [s] as index."""
        import pandas

        names = [name for name in self._columns if name != "time"]
        frame = pandas.DataFrame({name: self[name] for name in names},
                                 index=pandas.Index(self.time, name="time"))
        frame.attrs["units"] = {name: self.channels[name].unit for name in names}
        return frame

    def to_xarray(self) -> xarray.Dataset:
        """xarray.Dataset of all recorded channels over time, with units."""
        import xarray

        return xarray.Dataset(
            {name: ("time", self[name], describe_column(self.channels[name])) for name in self._columns
             if name != "time"},
            coords={"time": ("time", self.time, {"units": "s"})},
            attrs={"status": self.status, **self.parameters})

    def _get_direction(self, parameter: str) -> int:
        if parameter not in self._directions:
            _refuse("derivative", parameter, self._directions)
        return self._directions[parameter]


class _StoredRun:
    """The numbers of a finished run, in place of _core.Run in another process."""

    def __init__(self, run: _core.Run | _StoredRun, columns: int, directions: int) -> None:
        self.interval: float = run.interval
        self.sample_count: int = run.sample_count
        self.status: int = run.status
        self.failure_time: float = run.failure_time
        along = range(-1, directions)
        self._views = {(c, d): run.view(c, d) for c in range(columns) for d in along}
        self._events = {d: run.event_time(d) for d in along}
        self._snapshots = {(c, d): run.snapshot(c, d) for c in range(len(CHANNELS)) for d in along}

    def view(self, column: int, direction: int = -1) -> npt.NDArray[np.float64]:
        return self._views[column, direction]

    def event_time(self, direction: int = -1) -> float:
        return self._events[direction]

    def snapshot(self, channel: int, direction: int = -1) -> float:
        return self._snapshots[channel, direction]


def describe_column(column: Channel) -> dict[str, str]:
    return {"units": column.unit, "long_name": column.description}


def simulate_many(
    car: Car | Path, maneuver: Path, parameters: Mapping[str, npt.ArrayLike], *,
    channels: str | Iterable[str] | None = None, snapshot: bool = True,
    rate: SupportsFloat | None = None, offset: SupportsFloat = 0.0, threads: int | None = None,
    integrator: str | None = None, step: float | None = None, coarse_step: float | None = None,
    closure: str | None = None, spin: str | None = None, events: bool = True,
    **common: SupportsFloat
) -> Runs:
    """Simulates a car for many values of parameters, in lanes and threads; the lock of Python is free.

    Args:
        car: Car of load(), or a vehicle file.
        maneuver: maneuver file (TOML).
        parameters: arrays of equal length by parameter name, an element for each case.
        channels: names of the channels to keep (default: the five of the paper's network).
        snapshot: whether to keep the channels when the rear wheels are on the bump.
        rate: samples per second of histories [Hz]; None: no histories, and runs end with the snapshot.
        offset: distance of the snapshot behind the bump's center [m].
        threads: default: one for each processor.
        integrator, step, coarse_step, closure, spin, events: as in Car.simulate. Defaults: tables; rk4 at
            1 ms for histories; for snapshots alone abm4 at 1 ms with 10 ms away from the bump (4 ms
            below 10 m/s). Measured at 3, 4 and 20 m/s: within 5e-4 of a channel's range in the run.
        **common: parameters that all cases share.

    Returns:
        Runs, in the order of the arrays.

    Raises:
        InputError: unknown names, values out of range, before anything is simulated. Cases that fail
            have a status instead; unlike a sweep, this does not try them again with a smaller step.
    """
    hint = "; one number for all is a keyword"
    arrays = {name: make_array(name, values, 1, hint) for name, values in parameters.items()}
    if not arrays:
        raise InputError("parameters: must name at least one parameter")
    count = None
    for name, values in arrays.items():
        if count is None:
            count = len(values)
        if len(values) != count:
            raise InputError(f"{name}: has {len(values)} values, others {count}")
    for name in arrays:
        if name in common:
            raise InputError(f"{name}: given twice, as array and as number")
    if not snapshot and rate is None:
        raise InputError("rate: must be given where snapshot is False, or nothing is recorded")
    rate = None if rate is None else make_number("rate", rate)
    offset = make_number("offset", offset)
    if not np.isfinite(offset):
        raise InputError(f"offset = {offset} m: must be finite")
    threads = count_threads(threads)
    car = car if isinstance(car, Car) else load(car)
    names = list_names(PAPER_CHANNELS if channels is None else channels, CHANNELS)
    integration = _core.Integration(
        integrator=integrator, step=step, coarse_step=coarse_step, closure=closure, spin=spin,
        events=events)
    values = np.column_stack(list(arrays.values()))
    results = car._core.simulate_many(
        os.fspath(maneuver), make_settings(common), list(arrays), values, names, bool(snapshot),
        rate, offset, threads, integration)
    return Runs(results, arrays, names, 0.0 if rate is None else 1.0 / rate)


class Runs:
    """Many runs: arrays with a row for each case, in the order of the parameters.

    Attributes:
        parameters: dictionary of arrays, as given.
        status: array of numbers, STATUSES names them; 0 is done.
        reason: list of texts, "" where a case is done.
        event_time, failure_time: arrays [s]; NaN where there is none.
    """

    def __init__(
        self, results: dict[str, Any], parameters: dict[str, npt.NDArray[np.float64]],
        channels: Sequence[str], interval: float
    ) -> None:
        self.parameters = parameters
        self.status: npt.NDArray[np.int32] = results["status"]
        self.reason: list[str] = results["reason"]
        self.event_time: npt.NDArray[np.float64] = results["event_time"]
        self.failure_time: npt.NDArray[np.float64] = results["failure_time"]
        self._channels = {name: i for i, name in enumerate(channels)}
        self._snapshot: npt.NDArray[np.float64] | None = results.get("snapshot")
        self._history: npt.NDArray[np.float64] | None = results.get("history")
        self._interval = interval

    def __repr__(self) -> str:
        done = int(np.count_nonzero(self.status == 0))
        return f"<strut.Runs: {len(self)} cases, {done} done>"

    def __len__(self) -> int:
        return len(self.status)

    @property
    def snapshot(self) -> dict[str, npt.NDArray[np.float64]]:
        """Arrays by channel, (cases,)."""
        return self._get(self._snapshot, "snapshot=True")

    @property
    def history(self) -> dict[str, npt.NDArray[np.float64]]:
        """Arrays by channel, (cases, samples); NaN behind the end of a case."""
        return self._get(self._history, "rate=...")

    @property
    def time(self) -> npt.NDArray[np.float64]:
        """Times of the samples of histories [s]."""
        return self._interval * np.arange(0 if self._history is None else self._history.shape[2])

    def to_dataframe(self) -> pandas.DataFrame:
        """pandas.DataFrame: a row for each case with parameters, snapshot, event_time, status and reason."""
        import pandas

        columns: dict[str, Any] = dict(self.parameters)
        if self._snapshot is not None:
            columns.update(self.snapshot)
        columns["event_time"] = self.event_time
        columns["status"] = [STATUSES[s] for s in self.status]
        columns["reason"] = self.reason
        return pandas.DataFrame(columns, index=pandas.RangeIndex(len(self), name="case"))

    def to_xarray(self) -> xarray.Dataset:
        """xarray.Dataset over cases, and over time where there are histories (snapshot_NAME, NAME)."""
        import xarray

        data: dict[str, Any] = {"status": ("case", self.status),
                                "event_time": ("case", self.event_time, {"units": "s"})}
        for name, i in self._channels.items():
            about = describe_column(CHANNELS[name])
            if self._snapshot is not None:
                data["snapshot_" + name] = ("case", self._snapshot[i], about)
            if self._history is not None and name != "time":
                data[name] = (("case", "time"), self._history[i], about)
        coords: dict[str, Any] = {name: ("case", values) for name, values in self.parameters.items()}
        if self._history is not None:
            coords["time"] = ("time", self.time, {"units": "s"})
        return xarray.Dataset(data, coords=coords)

    def _get(self, array: npt.NDArray[np.float64] | None, how: str) -> dict[str, npt.NDArray[np.float64]]:
        if array is None:
            raise InputError(f"not recorded; allowed with {how}")
        return {name: array[i] for name, i in self._channels.items()}
