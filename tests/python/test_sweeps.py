"""Sweeps and networks from Python."""

import json
import os
import subprocess

import numpy as np
import pytest

import strut
from conftest import run_program

HISTORY = 'history = { rate = 100, channels = ["pitch_rate", "body_position_z"] }\n'


def test_a_sweep_is_planned_run_and_read(make_request, tmp_path):
    sweep = strut.Sweep(tmp_path / "cars")
    plan = sweep.plan(make_request(HISTORY))
    assert plan["cases"] == 16 and plan["shards"] == 4
    assert sweep.status()["done"] == 0
    seen = []
    counts = sweep.run(progress=seen.append)
    assert counts["cases"] == counts["written"] == 16 and counts["failed"] == 0
    assert seen[-1] == {"cases": 16, "done": 16, "failed": 0}
    assert sweep.status()["done"] == 16
    assert sweep.verify(sample=3)["ok"]
    assert sweep.run()["present"] == 16
    frame = sweep.to_dataframe()
    assert list(frame.index) == list(range(16))
    assert frame["front_stiffness"].nunique() == 4 and frame.attrs["units"]["pitch_rate"] == "rad/s"
    dataset = sweep.to_xarray()
    assert dataset["pitch_rate"].dims == ("case", "time")
    assert dataset["pitch_rate"].attrs["units"] == "rad/s"
    assert dataset["snapshot_pitch_rate"].dims == ("case",)
    assert dataset["time"].values[1] == pytest.approx(0.01)
    merged = tmp_path / "merged.h5"
    sweep.merge(merged)
    again = strut.read_dataset(merged)
    whole = sweep.read()
    assert np.array_equal(again.case, whole.case)
    assert np.array_equal(again.history["pitch_rate"], whole.history["pitch_rate"])


def test_an_interrupted_sweep_goes_on(make_request, tmp_path):
    request = make_request()
    text = request.read_text().replace("1500", "20").replace("step = 60", "step = 5")
    request.write_text(text.replace("cases = 4", "cases = 64"))
    sweep = strut.Sweep(tmp_path / "cars")
    cases = sweep.plan(request)["cases"]

    class Stop(Exception):
        pass

    def interrupt(_):
        raise Stop

    with pytest.raises(Stop):
        sweep.run(progress=interrupt, threads=1)
    assert sweep.status()["done"] < cases
    sweep.run()
    assert sweep.status()["done"] == cases and sweep.verify()["ok"]


def test_errors_of_sweeps(make_request, tmp_path):
    with pytest.raises(strut.InputError) as caught:
        strut.Sweep(tmp_path / "none").run()
    assert "none" in str(caught.value)
    with pytest.raises(strut.InputError):
        strut.Sweep(tmp_path / "none").status()
    with pytest.raises(strut.InputError):
        strut.read_dataset(tmp_path / "none")
    sweep = strut.Sweep(tmp_path / "cars")
    with pytest.raises(strut.InputError) as caught:
        sweep.plan(tmp_path / "absent.toml")
    assert "absent.toml" in str(caught.value)
    sweep.plan(make_request())
    with pytest.raises(strut.InputError):
        sweep.read()  # nothing has run
    with pytest.raises(strut.InputError):
        sweep.run(threads=0)


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    folder = tmp_path_factory.mktemp("network")
    from conftest import CAR, MANEUVER, SWEEP

    text = SWEEP.format(car=CAR, maneuver=MANEUVER, history="").replace("1500", "300").replace(
        "step = 60", "step = 20")
    (folder / "sweep.toml").write_text(text)
    sweep = strut.Sweep(folder / "cars")
    sweep.plan(folder / "sweep.toml")
    sweep.run()
    model = folder / "model.h5"
    result = strut.train(sweep, model, inputs="body_acceleration_z,pitch_rate", hidden=[6, 4],
                         epochs=60, allow_few=True)
    return sweep, model, result


def test_a_network_predicts_as_the_program_does(trained, tmp_path):
    sweep, model, result = trained
    assert result["epochs"]
    network = strut.Network.load(model)
    assert network.inputs == ["body_acceleration_z", "pitch_rate"]
    assert network.targets == ["front_stiffness", "rear_damping"]
    data = sweep.read()
    values, half = network.predict(data.snapshot)
    assert values.shape == (len(data), 2) and half.shape == (2,)
    row = 37
    measured = tmp_path / "measured.csv"
    measured.write_text("body_acceleration_z,pitch_rate\n" + ",".join(
        repr(float(data.snapshot[name][row])) for name in network.inputs) + "\n")
    said = strut.identify(model, measured)
    text = json.dumps(said)
    for value in values[row]:
        assert f"{value:.9g}"[:9] in text, (value, text)
    matrix = np.column_stack([data.snapshot[name] for name in network.inputs])
    assert np.array_equal(network.predict(matrix)[0], values, equal_nan=True)


def test_a_network_takes_a_snapshot_of_a_run(trained, car, maneuver):
    network = strut.Network.load(trained[1])
    snapshot = car.simulate(maneuver, front_stiffness=37000, rear_damping=1900).snapshot
    values, half = network.predict(snapshot)
    assert values.shape == (1, 2)
    assert np.array_equal(network.predict([snapshot[name] for name in network.inputs])[0], values)


def test_a_network_says_nothing_outside_of_its_range(trained):
    network = strut.Network.load(trained[1])
    assert np.isnan(network.predict([[1e3, 1.0]])[0]).all()
    assert np.isfinite(network.predict([[1e3, 1.0]], extrapolate=True)[0]).all()
    with pytest.raises(strut.InputError):
        network.predict([[1.0, 2.0, 3.0]])
    with pytest.raises(strut.InputError) as caught:
        network.predict({"pitch_rate": [1.0]})
    assert "body_acceleration_z" in str(caught.value)
    with pytest.raises(strut.InputError):
        strut.Network.load(__file__)


def test_the_program_is_found_by_environment(monkeypatch, tmp_path):
    monkeypatch.setenv("STRUT_PROGRAM", str(tmp_path / "absent"))
    with pytest.raises(OSError):
        strut.Sweep(tmp_path).status()
