#!/usr/bin/env python3
"""Makes the pictures of the README: make_pictures.py BUILD, where BUILD/strut and BUILD/python are.

crossing.gif: a new and a worn car over the paper's bump. diagnosis.png: `strut diagnose` of
examples/campaigns/worn_damper.toml. Needs python3-matplotlib.
"""
import csv
import math
import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
from matplotlib import animation, pyplot
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLES = HERE.parent.parent / "examples"
INK, NEW, WORN = "#1b1f24", "#0072b2", "#d55e00"
BUMP = {"bump_height": 0.06, "bump_length": 0.6}
ENLARGED = 3  # motion and bump, to be seen
WORN_CAR = {"front_damping": 300, "rear_damping": 300}

# A sedan's outline: x as a fraction of the wheelbase from the rear axle, z from the ground [m].
OUTLINE = np.array([(-0.33, 0.35), (-0.36, 0.62), (-0.33, 0.92), (-0.1, 0.98), (0.12, 1.38), (0.3, 1.46), (0.52, 1.44),
                    (0.78, 1.02), (1.12, 0.9), (1.28, 0.72), (1.29, 0.35), (-0.33, 0.35)])


class Drawing:
    """A car from the side: the body from its height and pitch, wheels at their heights."""

    def __init__(self, axes, run, car, color, style):
        read = lambda name: car.parameters[name].default
        self.front, self.rear, self.height = read("centroid_to_front"), -read("centroid_to_rear"), read("centroid_height")
        self.radius = read("tire_radius")
        self.run = run
        self.body, = axes.plot([], [], style, color=color, lw=1.6, zorder=3)
        self.wheels = [axes.plot([], [], style, color=color, lw=2.2, zorder=3)[0] for _ in range(2)]

    def draw(self, i, road):
        run = self.run
        enlarge = lambda name: run[name][0] + ENLARGED * (run[name][i] - run[name][0])
        x, z, pitch = run["forward_position"][i], enlarge("body_position_z"), enlarge("pitch_angle")
        points = np.column_stack([self.rear + OUTLINE[:, 0] * (self.front - self.rear), OUTLINE[:, 1] - self.height])
        self.body.set_data(x + points[:, 0] * math.cos(pitch) + points[:, 1] * math.sin(pitch),
                           z - points[:, 0] * math.sin(pitch) + points[:, 1] * math.cos(pitch))
        angle = np.linspace(0, 2 * np.pi, 90)
        for wheel, center, corner in zip(self.wheels, (self.front, self.rear), ("front_right", "rear_right")):
            at = x + center + self.radius * np.cos(angle)
            height = enlarge(corner + "_wheel_position_z") + self.radius * np.sin(angle)
            wheel.set_data(at, np.maximum(height, road(at)))


def draw_crossing(strut, target):
    car = strut.load(EXAMPLES / "vehicles/paper_sedan.toml")
    maneuver = EXAMPLES / "maneuvers/bump_20mps.toml"
    new, worn = car.simulate(maneuver, **BUMP), car.simulate(maneuver, **BUMP, **WORN_CAR)
    assert new.status == worn.status == "done"
    center = car.parameters["centroid_to_front"].default + 10.0

    def road(x):
        height, half = BUMP["bump_height"], 0.5 * BUMP["bump_length"]
        radius = (half**2 + height**2) / (2 * height)
        arc = np.sqrt(np.maximum(radius**2 - (x - center) ** 2, 0)) - radius + height
        return ENLARGED * np.where(np.abs(x - center) < half, arc, 0.0)

    figure, (view, curve) = pyplot.subplots(2, 1, figsize=(7.2, 3.7), height_ratios=(2.2, 1), constrained_layout=True)
    drawings = [Drawing(view, worn, car, WORN, "--"), Drawing(view, new, car, NEW, "-")]
    ground, = view.plot([], [], color="#57606a", lw=1.5)
    view.set_aspect("equal"), view.set_ylim(-0.1, 1.8), view.set_axis_off()
    view.text(0.01, 0.92, f"motion x {ENLARGED}", transform=view.transAxes, fontsize=8, color="#57606a")
    frames = np.flatnonzero((new.time > 0.35) & (new.time < 2.2))[::34]
    for run, color, style, label in ((new, NEW, "-", "new"), (worn, WORN, "--", "worn dampers")):
        curve.plot(run.time, 1e3 * (run["body_position_z"] - run["body_position_z"][0]), style, color=color, label=label)
    mark = curve.axvline(0, color=INK, lw=0.8)
    curve.set_xlim(0.35, 2.2), curve.set_xlabel("time [s]"), curve.set_ylabel("body height [mm]")
    curve.legend(loc="upper right", frameon=False, fontsize=8)
    for side in ("top", "right"):
        curve.spines[side].set_visible(False)

    def show(i):
        x = new["forward_position"][i]
        view.set_xlim(x - 3.4, x + 3.4)
        at = np.linspace(x - 3.4, x + 3.4, 800)
        ground.set_data(at, road(at))
        for drawing in drawings:
            drawing.draw(i, road)
        mark.set_xdata([new.time[i]] * 2)

    animation.FuncAnimation(figure, show, frames).save(target, animation.PillowWriter(fps=16), dpi=88)
    pyplot.close(figure)


def read_panels(path):
    """The series of a chart's CSV by panel and name."""
    panels = {}
    for row in csv.DictReader(open(path)):
        x, y = panels.setdefault(row["panel"], {}).setdefault(row["series"], ([], []))
        x.append(float(row["x"])), y.append(float(row["y"]))
    return panels


def draw_diagnosis(build, target):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([build / "strut", "diagnose", EXAMPLES / "campaigns/worn_damper.toml", "-o", f"{folder}/d"],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        law = read_panels(f"{folder}/d/figures/force_law.csv")
        gain = read_panels(f"{folder}/d/figures/gain.csv")
    panel = next(series for name, series in law.items() if "velocity" in name)
    figure, (force, bars) = pyplot.subplots(1, 2, figsize=(7.2, 2.9), width_ratios=(2.2, 1), constrained_layout=True)
    colors = {"measured": INK, "calibrated": "#e69f00", "extended": NEW}
    labels = {"measured": "measured", "calibrated": "best model without the effect", "extended": "with damper_asymmetry"}
    for name in ("measured", "calibrated", "extended"):
        force.plot(*panel[name], ".", ms=2 if name == "measured" else 3, color=colors[name], label=labels[name],
                   zorder=1 if name == "measured" else 2)
    force.set_xlabel("damper velocity [m/s]"), force.set_ylabel("force [N]")
    force.legend(frameon=False, fontsize=8, markerscale=4)
    (series,) = gain.values()
    names = ["calibrated", "extended", "noise"]
    bars.bar(["without", "with", "noise"], [series[name][1][0] for name in names],
             color=[colors["calibrated"], colors["extended"], "#cc79a7"])
    bars.set_ylabel("error on the held-out run [%]")
    for axes in (force, bars):
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
    figure.savefig(target, dpi=110)
    pyplot.close(figure)


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    sys.path.insert(0, str(build / "python"))
    import strut
    draw_crossing(strut, HERE / "crossing.gif")
    draw_diagnosis(build, HERE / "diagnosis.png")


if __name__ == "__main__":
    main()
