"""strut: worn suspensions, simulated in lanes, identified from how the car moves over a bump.

    import strut
    car = strut.load("examples/vehicles/paper_sedan.toml")
    run = car.simulate("examples/maneuvers/bump_20mps.toml", front_stiffness=38000)
    run["body_acceleration_z"]              # NumPy array, m/s^2

All units are SI, angles in radians.
"""

from __future__ import annotations

from . import _core
from ._car import CHANNELS, PAPER_CHANNELS, STATUSES, Car, Channel, Parameter, Run, Runs, load
from ._car import simulate_many
from ._errors import EnvironmentError, Error, InputError
from ._rig import Rig, load_rig
from ._network import Network, compare, diagnose, evaluate, identify, train
from ._sweep import Dataset, Sweep, read_dataset

__commit__: str = _core.commit
__version__: str = _core.version

__all__ = [
    "CHANNELS", "Car", "Channel", "Dataset", "EnvironmentError", "Error", "InputError", "Network",
    "PAPER_CHANNELS", "Parameter", "Rig", "Run", "Runs", "STATUSES", "Sweep", "compare", "diagnose",
    "evaluate", "identify", "load", "load_rig", "read_dataset", "simulate_many", "train",
]
