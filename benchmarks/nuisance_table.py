#!/usr/bin/env python3
"""What identified wear moves by where the car is not as it is taken to be (docs/wear.md).

    nuisance_table.py STRUT [FOLDER]

Trains the networks of docs/identify.md and docs/window.md in FOLDER (default: a temporary one),
simulates a new and a worn car that each carry one error, identifies them as if it were absent, and
prints a table for docs/limits.md: the largest error of the two stiffnesses and of the two dampings,
in points of per cent of new. Records have no noise: what is left is the error of the model.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

EXAMPLES = pathlib.Path(__file__).resolve().parent.parent / "examples"
VEHICLE = EXAMPLES / "vehicles/paper_sedan.toml"
MANEUVER = EXAMPLES / "maneuvers/bump_20mps.toml"
NEW = {"front_stiffness": 40000.0, "front_damping": 1980.0,
       "rear_stiffness": 35000.0, "rear_damping": 1980.0}
WORN = {"front_stiffness": 38000.0, "front_damping": 1880.0,
        "rear_stiffness": 33500.0, "rear_damping": 1850.0}
# Name, the car's own values, and the prior with which a fit frees it: (parameter, mean, sigma).
ERRORS = [
    ("none", {}, None),
    ("a passenger, 75 kg", {"body_payload_mass": 75.0}, ("body_payload_mass", 0.0, 75.0)),
    ("tire pressure, -0.3 bar", {"tire_stiffness": 0.9}, ("tire_stiffness", None, 0.1)),
    ("speed, +1 km/h", {"speed": 20.0 + 1.0 / 3.6}, ("speed", 20.0, 0.3)),
    ("bump, +5 mm", {"bump_height": 0.055}, ("bump_height", 0.05, 0.005)),
]


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, pathlib.Path(folder)

    def run(self, *words, allowed=(0,)):
        words = [str(w) for w in (self.path, *words)]
        result = subprocess.run(words, capture_output=True, text=True, cwd=self.folder)
        if result.returncode not in allowed:
            sys.exit(f"{' '.join(words)}: exit code {result.returncode}\n{result.stderr}")
        return result.stdout

    def train(self, sweep, model, *options):
        if not (self.folder / model).exists():
            self.run("plan", EXAMPLES / "sweeps" / sweep, "-o", model + ".sweep")
            self.run("run", model + ".sweep")
            self.run("train", model + ".sweep", "-o", model, *options)

    def read_tire_stiffness(self):
        rows = json.loads(self.run("list", "parameters", "--json"))
        return next(row["default"] for row in rows if row["name"] == "tire_stiffness")


def simulate(program, name, car, error):
    settings = [word for key, value in {**car, **error}.items()
                for word in ("--set", f"{key}={value:.9g}")]
    for file, rate in ((name + ".h5", []), (name + ".csv", ["--rate", "500"])):
        program.run("simulate", VEHICLE, MANEUVER, *settings, "--step", "0.0005", *rate, "-o",
                    file, "--force")
    return name + ".h5", name + ".csv"


def read_errors(text, car):
    """Errors of the identified wear, in points of per cent of new."""
    parameters = json.loads(text)["parameters"]
    found = {name: parameters[name]["value"] for name in car}
    return {name: None if found[name] is None else 100.0 * (car[name] - found[name]) / NEW[name]
            for name in car}


def identify(program, method, files, car, prior):
    snapshot, history = files
    words = {"network": ["network.h5", snapshot, "--extrapolate"],
             "window": ["window.h5", history, "--extrapolate"],
             "fit": [VEHICLE, history, "--maneuver", MANEUVER, "--window", "0.3:2.5"]}
    freed = method == "fit, freed"
    command = list(words["fit" if freed else method])
    if freed:
        command += ["--nuisance", "{}={:.9g},{:.9g}".format(*prior)]
    elif method == "fit":
        command += ["--prior", "speed=20,1e-4"]  # as known as the rest
    return read_errors(program.run("identify", *command, "--json", allowed=(0, 1)), car)


def format_largest(errors):
    """Largest error of stiffness / of damping."""
    def largest(end):
        values = [error for name, error in errors.items() if name.endswith(end)]
        return "-" if None in values else f"{max(map(abs, values)):.2g}"
    return f"{largest('stiffness')} / {largest('damping')}"


def main():
    path = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as temporary:
        program = Program(path, pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) > 2
                          else temporary)
        program.train("stratified_2000.toml", "network.h5")
        program.train("window_2000.toml", "window.h5", "--window", "0.3:2.5",
                      "--targets", ",".join(NEW))
        tire = program.read_tire_stiffness()
        methods = ["network", "window", "fit", "fit, freed"]
        print("| not as stated | " + " | ".join(methods) + " | " +
              " | ".join(f"change, {m}" for m in methods[:3]) + " |")
        print("|---" * (1 + len(methods) + 3) + "|")
        for name, error, prior in ERRORS:
            scale = lambda key, value: value * tire if key == "tire_stiffness" else value
            error = {key: scale(key, value) for key, value in error.items()}
            if prior and prior[0] == "tire_stiffness":
                prior = (prior[0], tire, prior[2] * tire)
            new = simulate(program, "new", NEW, error)
            worn = simulate(program, "worn", WORN, error)
            cells, changes = [], []
            for method in methods:
                if method == "fit, freed" and prior is None:
                    cells.append("")
                    continue
                now = identify(program, method, worn, WORN, prior)
                cells.append(format_largest(now))
                if method == "fit, freed":
                    continue
                before = identify(program, method, new, NEW, prior)
                unknown = None in (*now.values(), *before.values())
                changes.append("-" if unknown else
                               format_largest({key: now[key] - before[key] for key in now}))
            print(f"| {name} | " + " | ".join(cells + changes) + " |", flush=True)


if __name__ == "__main__":
    main()
