"""Files of sweeps and runs as the tools of other people open them."""

import re
import shutil
import subprocess

import numpy as np
import pytest

import strut
from conftest import CAR, MANEUVER, ROOT, run_program

xarray = pytest.importorskip("xarray")
pytest.importorskip("netCDF4")

HISTORY = 'history = { rate = 50, channels = ["pitch_rate", "body_position_z"] }\n'


@pytest.fixture
def merged(make_request, tmp_path):
    """A sweep of 16 cases of which four fail, and its merged file."""
    request = make_request(HISTORY)
    text = request.read_text()
    request.write_text(text.replace("rear_damping = { from = 1800, to = 1980, step = 60 }",
                                    "rear_stiffness = { from = 2000, to = 35000, count = 4 }"))
    sweep = strut.Sweep(tmp_path / "cars")
    sweep.plan(request)
    sweep.run()
    sweep.merge(tmp_path / "dataset.h5")
    return sweep.read(), tmp_path / "dataset.h5"


def test_xarray_opens_a_merged_file(merged):
    cases, path = merged
    with xarray.open_dataset(path) as data:
        data.load()
    order = np.argsort(data["case_id"].values)
    assert data["snapshot"].dims == ("case_id", "channel")
    assert list(data["parameter"].values) == ["front_stiffness", "rear_stiffness"]
    for name in ("body_acceleration_z", "pitch_rate"):
        assert np.array_equal(data["snapshot"].sel(channel=name, case_id=cases.case),
                              cases.snapshot[name], equal_nan=True)
    assert list(data["reason"].sel(case_id=cases.case).values) == cases.reason
    assert 0 < sum(reason != "" for reason in cases.reason) < 16
    assert data["event_time"].attrs["units"] == "s"
    with xarray.open_dataset(path, group="history") as data:
        data.load()
    assert data["pitch_rate"].dims == ("case_id", "time")
    assert np.allclose(data["time"], np.arange(151) / 50) and data["time"].attrs["units"] == "s"
    assert np.array_equal(data["pitch_rate"].values[order], cases.history["pitch_rate"],
                          equal_nan=True)


def test_xarray_opens_a_run(tmp_path):
    path = tmp_path / "run.h5"
    run_program("simulate", CAR, MANEUVER, "-o", path, "--rate", 100)
    with xarray.open_dataset(path, group="history") as run:
        assert run["pitch_rate"].dims == ("time",)
        assert run["time"].values[-1] == pytest.approx(3.0)


def test_octave_reads_a_merged_file(merged, tmp_path):
    if shutil.which("octave-cli") is None:
        pytest.skip("no octave-cli")
    cases, path = merged
    document = (ROOT / "docs/data_format.md").read_text()
    lines = re.search(r"```octave\n(.*?)```", document, re.DOTALL).group(1)
    script = tmp_path / "read.m"
    script.write_text(lines + 'printf("%d %d %d %d %s\\n", size(x), size(y), names{2});\n'
                      'id = ncread("dataset.h5", "case_id");\n'
                      'printf("%d %.17g %.17g\\n", [double(id)'
                      " x(:, 2) y(:, 1)]');\n")
    printed = subprocess.run(["octave-cli", "--norc", script], cwd=tmp_path, check=True, text=True,
                             capture_output=True).stdout.splitlines()
    assert printed[0] == "16 2 16 2 pitch_rate"
    rows = np.array([line.split() for line in printed[1:]], float)
    rows = rows[np.argsort(rows[:, 0])]
    assert np.array_equal(rows[:, 1], cases.snapshot["pitch_rate"], equal_nan=True)
    assert np.array_equal(rows[:, 2], cases.parameters["front_stiffness"])
