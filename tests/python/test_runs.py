"""Cars and their runs, against the program and against differences."""

import csv
import math
import pickle

import numpy as np
import pytest

import strut
from conftest import CAR, ROOT, run_program


def read_columns(path):
    with open(path, newline="") as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    return {name: i for i, name in enumerate(rows[0])}, rows[1:]


def test_a_car_lists_its_parameters_and_channels(car):
    stiffness = car.parameters["front_stiffness"]
    assert stiffness.unit == "N/m"
    assert stiffness.range[0] < stiffness.default < stiffness.range[1]
    assert not stiffness.is_maneuver and car.parameters["speed"].is_maneuver
    assert car.channels["body_acceleration_z"].unit == "m/s^2"
    assert list(car.channels)[0] == "time"


def test_a_run_has_the_bits_of_the_program(car, maneuver, tmp_path):
    output = tmp_path / "run.h5"
    run_program("simulate", CAR, maneuver, "--set", "front_stiffness=38000", "-o", output)
    h5py = pytest.importorskip("h5py")
    run = car.simulate(maneuver, front_stiffness=38000)
    assert run.status == "done" and math.isnan(run.failure_time) and run.reason == ""
    with h5py.File(output) as file:
        for channel in file["history"]:
            assert np.array_equal(run[channel], file["history"][channel]), channel
    assert np.array_equal(run.time, run["time"])


@pytest.mark.parametrize("options", [
    {"integrator": "abm4", "closure": "table", "coarse_step": 5e-3},
    {"integrator": "cvode"},
    {"spin": "explicit", "step": 5e-4, "events": False},
])
def test_settings_reach_the_integrator(car, maneuver, options):
    plain = car.simulate(maneuver, duration=0.7)
    other = car.simulate(maneuver, duration=0.7, **options)
    size = np.abs(plain["body_acceleration_z"]).max()
    difference = np.abs(plain["body_acceleration_z"] - other["body_acceleration_z"]).max()
    assert 0.0 < difference < 0.2 * size


def test_histories_are_views(car, maneuver):
    run = car.simulate(maneuver, channels=["pitch_rate", "body_acceleration_z"], rate=500)
    first, second = run["pitch_rate"], run["pitch_rate"]
    assert np.shares_memory(first, second)
    assert not first.flags.owndata and not first.flags.writeable
    assert len(first) == len(run.time) == 1501 and len(run) == 2 and run.time[1] == pytest.approx(2e-3)
    assert list(run.keys()) == ["pitch_rate", "body_acceleration_z"]
    whole = car.simulate(maneuver, rate=500)
    assert np.array_equal(first, whole["pitch_rate"])
    kept = run["pitch_rate"]
    value = kept[100]
    del run, first, second
    assert kept[100] == value  # the view keeps the run alive


def test_a_snapshot_is_where_the_rear_wheels_cross(car, maneuver):
    run = car.simulate(maneuver)
    assert run.event_time == pytest.approx(0.632, abs=0.01)
    near = np.interp(run.event_time, run.time, run["pitch_angle"])
    assert run.snapshot["pitch_angle"] == pytest.approx(near, rel=1e-3)


def test_a_run_is_a_mapping(car, maneuver):
    run = car.simulate(maneuver, channels=["pitch_rate", "pitch_angle"], duration=0.1)
    assert "pitch_rate" in run and "roll_rate" not in run and 0 not in run
    assert list(run) == ["pitch_rate", "pitch_angle"] and run.get("roll_rate") is None
    assert set(dict(run)) == set(run) and len(list(run.items())) == 2


def test_a_whole_run_goes_through_a_table(car, maneuver, tmp_path):
    pandas = pytest.importorskip("pandas")
    frame = car.simulate(maneuver, duration=0.8).to_dataframe()
    assert "time" not in frame.columns and "time" in frame.reset_index().columns
    frame.to_csv(tmp_path / "run.csv")
    result = strut.identify(car, tmp_path / "run.csv", maneuver=maneuver)
    assert abs(result["parameters"]["front_stiffness"]["value"] - 40000) < 50
    assert list(pandas.read_csv(tmp_path / "run.csv").columns)[0] == "time"


def test_frames_know_their_units(car, maneuver):
    run = car.simulate(maneuver, channels=["pitch_rate"], rate=100)
    pytest.importorskip("pandas")
    frame = run.to_dataframe()
    assert frame.index.name == "time" and frame.attrs["units"] == {"pitch_rate": "rad/s"}
    assert np.array_equal(frame["pitch_rate"].to_numpy(), run["pitch_rate"])
    pytest.importorskip("xarray")
    assert car.simulate(maneuver, duration=0.1).to_xarray()["pitch_rate"].dims == ("time",)
    dataset = run.to_xarray()
    assert dataset["pitch_rate"].attrs["units"] == "rad/s"
    assert dataset["time"].attrs["units"] == "s"


def test_derivatives_are_those_of_the_run(car, maneuver):
    names = ["front_stiffness", "rear_damping", "mass", "tire_stiffness", "bump_height"]
    run = car.simulate(maneuver, duration=0.8, derivatives=names)
    for name in names:
        step = 1e-4 * car.parameters[name].default
        if name == "bump_height":
            step = 1e-4 * 0.05
        base = step * 1e4
        above, below = (car.simulate(maneuver, duration=0.8, closure="table",
                                     **{name: base + sign * step}) for sign in (1, -1))
        channel = "body_position_z"
        difference = (above[channel] - below[channel]) / (2 * step)
        slope = run.derivative(channel, name)
        assert np.abs(slope - difference).max() < 1e-4 * np.abs(difference).max(), name
        at = (above.snapshot[channel] - below.snapshot[channel]) / (2 * step)
        assert run.snapshot_derivative(name)[channel] == pytest.approx(at, rel=1e-3), name


def test_many_derivatives_share_lanes(car, maneuver):
    names = [name for name, p in car.parameters.items()
             if p.default > 0 and not p.is_maneuver and "stiffness" in name or "damping" in name]
    names = [name for name in names if not any(side in name for side in ("left", "right"))]
    names = ["mass", "pitch_inertia", *names[:8], "speed"]
    assert len(names) > 8
    together = car.simulate(maneuver, duration=0.7, derivatives=names, channels="pitch_rate")
    for name in (names[0], names[5], names[-1]):
        alone = car.simulate(maneuver, duration=0.7, derivatives=name, channels="pitch_rate")
        # The trim's derivatives round with those beside them.
        slope = alone.derivative("pitch_rate", name)
        assert np.abs(together.derivative("pitch_rate", name) - slope).max() <= \
            1e-12 * np.abs(slope).max()
        assert together.event_time_derivative(name) == pytest.approx(
            alone.event_time_derivative(name), rel=1e-12)


@pytest.mark.parametrize("settings, name", [
    ({"front_left_stiffness": 39000}, "front_stiffness"),  # of two corners that differ
    ({}, "front_left_stiffness"),  # one side of a symmetric car
    ({}, "front_strut_friction_force"),  # an effect that is off
    ({}, "pitch_rate_sensor_gain"),
])
def test_some_parameters_have_no_derivative(car, maneuver, settings, name):
    with pytest.raises(strut.InputError, match=name):
        car.simulate(maneuver, derivatives=[name], **settings)


def test_derivatives_at_the_end_of_a_range(car, maneuver):
    name = "front_drive_share"
    high = car.parameters[name].range[1]
    run = car.simulate(maneuver, duration=0.7, derivatives=name, **{name: high})
    step = 1e-4
    below, base = (car.simulate(maneuver, duration=0.7, closure="table", **{name: high - s})
                   for s in (step, 0.0))
    difference = (base["pitch_rate"] - below["pitch_rate"]) / step
    assert np.abs(run.derivative("pitch_rate", name) - difference).max() < \
        1e-2 * np.abs(difference).max()


def test_a_file_name_may_be_no_text(car):
    with pytest.raises(strut.InputError):
        car.simulate(b"no\xff.toml")


def test_a_car_out_of_its_travel_has_a_status(car, maneuver):
    run = car.simulate(maneuver, bump_height=0.2, speed=30)
    assert run.status in strut.STATUSES and run.status != "done"
    assert 0.0 < run.failure_time < 3.0 and run.reason
    assert np.isnan(run["body_position_z"][-1])


@pytest.mark.parametrize("call, key, text", [
    (lambda car, m: car.simulate(m, front_stifness=38000), "front_stifness", "front_stiffness"),
    (lambda car, m: car.simulate(m, front_stiffness=-1), "front_stiffness", "must"),
    (lambda car, m: car.simulate(m, front_stiffness=float("nan")), "front_stiffness", "must"),
    (lambda car, m: car.simulate(m, front_stiffness="soft"), None, "soft"),
    (lambda car, m: car.simulate(m, channels=["pitch_rat"]), "channel", "pitch_rate"),
    (lambda car, m: car.simulate(m, rate=0), "rate", "[1, 1000000]"),
    (lambda car, m: car.simulate(m, step=1.0), "step", "0.02"),
    (lambda car, m: car.simulate(m, integrator="euler"), "integrator", "rk4"),
    (lambda car, m: car.simulate(m, derivatives=["tire_radius"]), "derivatives", "smoothly"),
    (lambda car, m: car.simulate(m)["no"], "channel", "unknown"),
    (lambda car, m: car.simulate(CAR), None, "paper_sedan"),
    (lambda car, m: car.simulate(ROOT / "none.toml"), None, "none.toml"),
    (lambda car, m: strut.load(m), None, "bump_20mps"),
    (lambda car, m: strut.load(ROOT / "README.md"), None, "README"),
])
def test_errors_name_what_is_wrong(car, maneuver, call, key, text):
    with pytest.raises(strut.InputError, match=".") as caught:
        call(car, maneuver)
    assert text in str(caught.value)
    assert isinstance(caught.value, ValueError)
    if key:
        assert caught.value.key == key


def test_an_error_is_taken_apart():
    error = strut.InputError(
        "car.toml: front.spring.stiffness = -3 N/m: must lie in [1000, 200000] N/m")
    assert (error.file, error.key, error.value) == ("car.toml", "front.spring.stiffness", "-3 N/m")
    assert error.allowed == "[1000, 200000] N/m"


def test_a_car_goes_to_other_processes(car, maneuver):
    again = pickle.loads(pickle.dumps(car))
    first, second = (c.simulate(maneuver, rate=50, front_stiffness=38000) for c in (car, again))
    assert np.array_equal(first["pitch_rate"], second["pitch_rate"])
    assert first.parameters == {"front_stiffness": 38000.0}


def test_a_maneuver_is_no_car(maneuver):
    with pytest.raises(strut.InputError, match="a maneuver of a car; must be a vehicle or rig"):
        strut.load(maneuver)


def test_runs_go_to_other_processes(car, maneuver):
    run = car.simulate(maneuver, rate=50, channels=["pitch_rate"], derivatives=["front_stiffness"])
    again = pickle.loads(pickle.dumps(run))
    assert again != run and list(again) == list(run) and again.status == "done"
    assert np.array_equal(again["pitch_rate"], run["pitch_rate"])
    assert np.array_equal(again.derivative("pitch_rate", "front_stiffness"),
                          run.derivative("pitch_rate", "front_stiffness"))
    assert again.event_time == run.event_time and again.snapshot == run.snapshot
    assert again.to_dataframe().equals(run.to_dataframe())


def test_a_pickled_car_is_found_from_another_folder(maneuver, tmp_path, monkeypatch):
    monkeypatch.chdir(CAR.parent)
    text = pickle.dumps(strut.load(CAR.name))
    monkeypatch.chdir(tmp_path)
    assert pickle.loads(text).simulate(maneuver, rate=50).status == "done"


def test_parameters_are_no_attributes(car):
    with pytest.raises(AttributeError):
        car.front_stiffness = 36000
