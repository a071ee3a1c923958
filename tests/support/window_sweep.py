"""A small sweep with histories of the body's accelerometer and gyroscope, for networks over windows."""

from run_commands import run

CHANNELS = ("imu_acceleration_z", "imu_rate_y")
RATE = 250  # Hz

SWEEP = """
vehicle = "{examples}/vehicles/paper_sedan.toml"
maneuver = "{examples}/maneuvers/bump_20mps.toml"
[grid]
front_stiffness = {{ from = 40000, to = 35500 }}
{axes}speed = {{ from = 19.5, to = 20.5 }}
[sample]
method = "sobol"
strata = 1
count = {count}
[integrate]
step = 2e-3
closure = "table"
[record]
history = {{ rate = {rate}, channels = ["imu_acceleration_z", "imu_rate_y"] }}
"""


def run_window_sweep(strut, examples, folder, count, axes=""):
    """Plans and runs the sweep in folder/sweep. `axes`: lines of [grid] beside those of the text."""
    (folder / "sweep.toml").write_text(
        SWEEP.format(examples=examples, count=count, axes=axes, rate=RATE))
    run(strut, "plan", folder / "sweep.toml", "-o", folder / "sweep")
    run(strut, "run", folder / "sweep")
