"""Files and folders of the tests."""

import os
import pathlib
import subprocess

import pytest

import strut

ROOT = pathlib.Path(__file__).resolve().parents[2]
CAR = ROOT / "examples/vehicles/paper_sedan.toml"
MANEUVER = ROOT / "examples/maneuvers/bump_20mps.toml"

SWEEP = """
vehicle = "{car}"
maneuver = "{maneuver}"

[grid]
front_stiffness = {{ from = 35500, to = 40000, step = 1500 }}
rear_damping = {{ from = 1800, to = 1980, step = 60 }}

[sample]
method = "grid"

[integrate]
method = "abm4"
step = 1e-3
coarse_step = 10e-3
closure = "table"

[record]
snapshot = {{ when = "rear_wheels_on_bump", offset = 0.0, channels = ["body_acceleration_z", "pitch_rate"] }}
{history}
[shards]
cases = 4
"""


@pytest.fixture(scope="session")
def car():
    return strut.load(CAR)


@pytest.fixture
def maneuver():
    return MANEUVER


@pytest.fixture
def make_request(tmp_path):
    """Writes the file of a sweep of 16 cases and returns its path."""

    def write(history=""):
        path = tmp_path / "sweep.toml"
        path.write_text(SWEEP.format(car=CAR, maneuver=MANEUVER, history=history))
        return path

    return write


def run_program(*words):
    subprocess.run([os.environ["STRUT_PROGRAM"], *map(str, words)], check=True, capture_output=True)
