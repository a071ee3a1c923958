"""The notebooks run from top to bottom, without Jupyter: their code cells one after the other."""

import json
import os

import pytest

from conftest import ROOT


def run_notebook(path):
    names = {"__name__": "notebook"}
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        assert not cell.get("outputs"), "notebooks are kept without outputs"
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), path.name, "exec"), names)
    return names


@pytest.fixture(autouse=True)
def stand_beside_the_examples(tmp_path, monkeypatch):
    matplotlib = pytest.importorskip("matplotlib")
    pytest.importorskip("pandas")
    matplotlib.use("Agg")
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)


def test_a_sweep_leads_to_an_identified_car():
    names = run_notebook(ROOT / "examples/python/sweep_to_identified_car.ipynb")
    for i, name in enumerate(names["network"].targets):
        assert abs(names["values"][0, i] - names["truth"][name]) < 5.0, name
    assert os.path.isdir("notebook_cars")


def test_a_recording_leads_to_a_fitted_car():
    names = run_notebook(ROOT / "examples/python/your_own_recording.ipynb")
    result = names["result"]
    assert result["adequate"] and result["converged"]
    truth = {"front_stiffness": 37000, "front_damping": 1850, "rear_stiffness": 32500,
             "rear_damping": 1900}
    for name, value in truth.items():
        low, high = result["parameters"][name]["ci95"]
        assert low - (high - low) < value < high + (high - low), name
