#!/usr/bin/env python3
"""Diagnoses a measured recording with its campaign of examples/campaigns, compares with what is known of it
from elsewhere and with the best static law (static_law.py), and fails where a figure of docs/measured.md is
no longer reached.

usage: check_recording.py STRUT SOURCE_FOLDER RECORDING

The recordings are not part of the sources: they lie in ../shared/measured beside them, or where the environment
variable STRUT_MEASURED says. Exit code 77: they, or numpy, are not there.
"""
import json
import os
import pathlib
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("skipped: no numpy (Debian: python3-numpy)")
    sys.exit(77)

import static_law
from recordings import RECORDINGS

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_commands import check, run

strut, sources = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
recording = RECORDINGS[sys.argv[3]]
measured = pathlib.Path(os.environ.get("STRUT_MEASURED", sources.parent / "shared/measured"))
data = measured / recording["folder"]


def place_campaign(folder):
    """The campaign beside links to the files that it names."""
    text = (sources / "examples/campaigns" / recording["campaign"]).read_text(encoding="utf-8")
    for name, file in recording["files"].items():
        check(f'"{name}"' in text, f"{recording['campaign']} names {name}")
        text = text.replace(f'"{name}"', f'"{file}"')
        (folder / file).symlink_to(data / file)
    text = text.replace("../rigs", str(sources / "examples/rigs"))
    campaign = folder / recording["campaign"]
    campaign.write_text(text, encoding="utf-8")
    return campaign


def find_held_out(verdict):
    (held_out,) = (r for r in verdict["runs"] if r["use"] == "hold_out")
    return held_out


def check_errors(verdict):
    held_out = find_held_out(verdict)
    for channel, limit in recording["errors"].items():
        errors = {model: 100 * held_out[model][channel]["nrmse"] for model in
                  ("nominal", "calibrated", "extended") if model in held_out}
        print(f"{channel}: " + ", ".join(f"{m} {e:.2f} %" for m, e in errors.items()))
        check(errors.get("extended", np.inf) <= limit, f"{channel} at most {limit} % with the extended model")


def check_static_law(verdict):
    """The extended model against the best static law, on the held-out run."""
    sign, half_width, limit = (recording[k] for k in ("sign", "half_width", "of_static_law"))
    *fit, held_out = (static_law.read_run(data / f, sign, half_width) for f in recording["files"].values())
    laws = static_law.fit_laws(fit, held_out)
    print("static laws: " + ", ".join(f"{name} {100 * e:.2f} %" for name, e in laws.items()))
    ratio = find_held_out(verdict)["extended"]["force"]["nrmse"] / min(laws.values())
    print(f"{ratio:.2f} of the best static law's error")
    check(ratio <= limit, f"at most {limit} of the best static law's error")
    print("viscous and Coulomb by least squares: {:.0f} N s/m, {:.0f} N".format(*static_law.fit_coulomb(fit)))
    print(f"asymmetry by least squares: {static_law.fit_asymmetry(fit):.3f}")


def check_causes(verdict):
    """The known causes are claimed or in a group, first; none else has more than 0.8."""
    claimed = [c["effect"] for c in verdict["causes"]]
    print(f"{verdict['verdict']}: " + "; ".join(
        f"{c['effect']} {c['place']} ({c['probability']:.2f}): " + ", ".join(
            f"{name} {p['value']:.4g} [{p['ci95'][0]:.4g}, {p['ci95'][1]:.4g}]"
            for name, p in c["parameters"].items()) for c in verdict["causes"]))
    named = claimed + [c["effect"] for c in verdict["group"]]
    for effects in recording["causes"]:
        check(any(e in named for e in effects), f"one of {effects} is named")
    known = {e for effects in recording["causes"] + recording.get("plausible", []) for e in effects}
    wrong = [c["effect"] for c in verdict["causes"] if c["probability"] > 0.8 and c["effect"] not in known]
    print(f"wrong with more than 0.8: {wrong}")
    check(not wrong, f"nothing wrong with more than 0.8: {wrong}")


def check_sizes(verdict):
    for (effect, parameter), (low, high) in recording["sizes"].items():
        found = [c["parameters"][parameter]["value"] for c in verdict["causes"] if c["effect"] == effect]
        check(found and low <= found[0] <= high, f"{effect} {parameter} between {low} and {high}: {found}")


def check_intervals(verdict):
    """Sizes that are known from elsewhere lie in the stated intervals."""
    for (effect, parameter), known in recording.get("known", {}).items():
        found = [c["parameters"][parameter]["ci95"] for c in verdict["causes"] if c["effect"] == effect]
        check(found and found[0][0] <= known <= found[0][1],
              f"{effect} {parameter} holds {known}: {found}")


def check_lost_motion(verdict):
    low, high = recording["lost_motion"]
    found = {c["effect"]: c["parameters"] for c in verdict["causes"]}
    lost = found["joint_play"]["play"]["value"] + 2 * found["strut_friction"]["stroke"]["value"]
    print(f"play and both flanks: {1e3 * lost:.2f} mm")
    check(low <= lost <= high, f"play and both flanks between {low} and {high} m")


if not all((data / file).is_file() for file in recording["files"].values()):
    print(f"skipped: no recordings in {data} (set STRUT_MEASURED)")
    sys.exit(77)
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    run(strut, "diagnose", place_campaign(folder), "-o", folder / "diagnosis")
    verdict = json.loads((folder / "diagnosis/verdict.json").read_text(encoding="utf-8"))
check_causes(verdict)
if "of_static_law" in recording:
    check_static_law(verdict)
check_errors(verdict)
check_sizes(verdict)
check_intervals(verdict)
if "lost_motion" in recording:
    check_lost_motion(verdict)
