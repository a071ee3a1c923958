"""Rigs and their runs, against the program and against the equation of motion."""

import math
import pickle

import numpy as np
import pytest

import strut
from conftest import ROOT, run_program

RIG = ROOT / "examples/rigs/quarter_car.toml"
CHIRP = ROOT / "examples/rigs/maneuvers/chirp.toml"


@pytest.fixture(scope="module")
def rig():
    return strut.load_rig(RIG)


def test_a_rig_lists_what_it_has(rig):
    assert rig.parameters["stiffness"].unit == "N/m"
    assert rig.channels["sprung_position"].unit == "m"
    assert list(rig.inputs)[0] == "road_position"
    assert pickle.loads(pickle.dumps(rig)).parameters == rig.parameters


def test_a_run_has_the_bits_of_the_program(rig, tmp_path):
    output = tmp_path / "run.h5"
    run_program("simulate", RIG, CHIRP, "--set", "damping=6.8", "--set", "damper_asymmetry=0.3", "--rate", "500",
                "-o", output)
    h5py = pytest.importorskip("h5py")
    run = rig.simulate(CHIRP, rate=500, damping=6.8, damper_asymmetry=0.3)
    assert run.status == "done" and math.isnan(run.event_time)
    with h5py.File(output) as file:
        for channel in file["history"]:
            assert np.array_equal(run[channel], file["history"][channel]), channel


def test_arrays_drive_a_rig(rig):
    times = np.linspace(0.0, 2.0, 401)
    run = rig.simulate({"road_position": (times, 0.002 * np.sin(8 * times))}, channels=["road_position"], rate=200)
    assert np.allclose(run["road_position"], 0.002 * np.sin(8 * run.time), atol=1e-9)
    assert run.time[-1] == pytest.approx(2.0)
    longer = rig.simulate({"road_position": (times, 0.0 * times)}, duration=3.0)
    assert longer.time[-1] == pytest.approx(3.0)
    assert np.abs(longer["sprung_position"] - longer["sprung_position"][0]).max() < 1e-12


def test_a_run_obeys_its_equation_of_motion(rig):
    times = np.linspace(0.0, 3.0, 1501)
    run = rig.simulate({"road_position": (times, 0.003 * np.sin(9 * times))}, step=2e-4)
    p = {name: rig.parameters[name].default for name in ("sprung_mass", "stiffness", "damping")}
    deflection = run["unsprung_position"] - run["sprung_position"]
    rate = run["unsprung_velocity"] - run["sprung_velocity"]
    force = p["stiffness"] * deflection + p["damping"] * rate
    assert np.allclose(p["sprung_mass"] * run["sprung_acceleration"], force, atol=1e-9)


def test_runs_of_rigs_have_units_and_survive_pickling(rig):
    run = rig.simulate(CHIRP, channels=["time", "sprung_position"], duration=1.0)
    again = pickle.loads(pickle.dumps(run))
    assert np.array_equal(again["sprung_position"], run["sprung_position"])
    pytest.importorskip("pandas")
    assert again.to_dataframe().attrs["units"] == {"sprung_position": "m"}


@pytest.mark.parametrize("change, told", [
    ({"maneuver": {"road": ([0, 1], [0, 0])}}, "road"),
    ({"maneuver": {}}, "duration"),
    ({"maneuver": {"road_position": ([0, 1, 1], [0, 0, 0])}}, "road_position"),
    ({"maneuver": {"road_position": ([0, 1], [0, math.nan])}}, "road_position"),
    ({"maneuver": {"road_position": ([0, 1], [[0], [1]])}}, "dimension"),
    ({"channels": "pitch_angle"}, "pitch_angle"),
    ({"stifness": 1.0}, "stiffness"),
    ({"damping": -1e9}, "damping"),
    ({"integrator": "cvode"}, "cvode"),
    ({"rate": 0.0}, "rate"),
    ({"duration": -1.0}, "duration"),
    ({"duration": math.nan}, "duration"),
])
def test_mistakes_are_named(rig, change, told):
    arguments = {"maneuver": CHIRP, **change}
    with pytest.raises(strut.InputError, match=told):
        rig.simulate(arguments.pop("maneuver"), **arguments)


def test_a_rig_needs_its_input():
    with pytest.raises(strut.InputError, match="displacement"):
        strut.load_rig(ROOT / "examples/rigs/damper_dyno.toml").simulate({}, duration=1.0)


def test_a_vehicle_is_no_rig():
    with pytest.raises(strut.InputError, match="must be a rig"):
        strut.load_rig(ROOT / "examples/vehicles/paper_sedan.toml")
