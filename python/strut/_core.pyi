"""The compiled module; what users call is the package strut."""

import os
from typing import Any, Callable, Optional, Sequence

import numpy as np
import numpy.typing as npt

version: str
commit: str

class Integration:
    def __init__(
        self,
        *,
        integrator: Optional[str] = None,
        closure: Optional[str] = None,
        spin: Optional[str] = None,
        step: Optional[float] = None,
        coarse_step: Optional[float] = None,
        events: bool = True,
    ) -> None: ...

class Car:
    path: os.PathLike[str]
    def __init__(self, path: str) -> None: ...
    def list_parameters(
        self, maneuver: Optional[str] = None
    ) -> list[tuple[str, str, str, float, float, float, bool]]: ...
    def simulate(
        self,
        maneuver: str,
        settings: Sequence[tuple[str, float]],
        rate: float,
        channels: Sequence[str],
        derivatives: Sequence[str],
        integration: Integration,
    ) -> Run: ...
    def simulate_many(
        self,
        maneuver: str,
        settings: Sequence[tuple[str, float]],
        parameters: Sequence[str],
        values: npt.NDArray[np.float64],
        channels: Sequence[str],
        snapshot: bool,
        rate: Optional[float],
        offset: float,
        threads: int,
        integration: Integration,
    ) -> dict[str, Any]: ...

class Rig:
    path: os.PathLike[str]
    def __init__(self, path: str) -> None: ...
    def list_parameters(self) -> list[tuple[str, str, str, float, float, float, bool]]: ...
    def list_channels(self) -> list[tuple[str, str, str]]: ...
    def list_inputs(self) -> list[tuple[str, str, str]]: ...
    def simulate(
        self,
        maneuver: Optional[str],
        inputs: Sequence[tuple[str, npt.NDArray[np.float64], npt.NDArray[np.float64]]],
        duration: Optional[float],
        settings: Sequence[tuple[str, float]],
        rate: float,
        channels: Sequence[str],
        integration: Integration,
    ) -> Run: ...

class Run:
    interval: float
    sample_count: int
    status: int
    failure_time: float
    def view(self, column: int, direction: int = -1) -> npt.NDArray[np.float64]: ...
    def event_time(self, direction: int = -1) -> float: ...
    def snapshot(self, channel: int, direction: int = -1) -> float: ...

class Network:
    inputs: list[tuple[str, str, float, float]]
    targets: list[tuple[str, str, float, float, float]]
    is_window: bool
    def __init__(self, path: str) -> None: ...
    def predict(self, inputs: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]: ...

def list_channels() -> list[tuple[str, str, str]]: ...
def list_statuses() -> list[tuple[str, str]]: ...
def run_sweep(
    folder: str,
    threads: int,
    retry_failed: bool,
    watch: Optional[Callable[[int, int, int], None]],
) -> dict[str, Any]: ...
def read_dataset(paths: Sequence[str], partial: bool, histories: bool) -> dict[str, Any]: ...
