#!/usr/bin/env python3
"""Makes the recordings of worn_damper.toml: make_worn_damper.py STRUT, the program.

A damper of 1000 N s/m that has lost a quarter of its rate and is 30 % harder in rebound and softer in compression, on a
crank; a load cell with noise of 4 N and an offset of 11 N, a displacement sensor with noise of 0.01 mm.
"""
import csv
import pathlib
import random
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
RUNS = {"worn_damper_1": (0.02, 0.8, 1), "worn_damper_2": (0.03, 1.3, 2)}  # amplitude [m], frequency [Hz], seed

for name, (amplitude, frequency, seed) in RUNS.items():
    with tempfile.TemporaryDirectory() as folder:
        maneuver, run = pathlib.Path(folder, "crank.toml"), pathlib.Path(folder, "run.csv")
        maneuver.write_text(f'duration = 4.0\n[input.displacement]\nshape = "sine"\namplitude = {amplitude}\n'
                            f"frequency = {frequency}\n")
        subprocess.run([sys.argv[1], "simulate", HERE.parent / "rigs/damper_dyno.toml", maneuver, "--rate", "250", "-o", run,
                        "--set", "damping=750", "--set", "damper_asymmetry=0.3"], check=True)
        draw = random.Random(seed)
        rows = csv.DictReader(line for line in open(run) if not line.startswith("#"))
        with open(HERE / f"{name}.csv", "w", newline="") as file:
            out = csv.writer(file)
            out.writerow(["t_s", "disp_mm", "force_N"])
            for row in rows:
                out.writerow([row["time"], f"{1e3 * float(row['displacement']) + draw.gauss(0, 0.01):.3f}",
                              f"{float(row['force']) + 11 + draw.gauss(0, 4):.1f}"])
