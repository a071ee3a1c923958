#!/usr/bin/env python3
"""Fits the best static law to a damper's recordings: the reference that a diagnosis has to beat. Shares no
code with strut.

    F = b + c v + F_c g(v) + c_+ max(v - v_+, 0) - c_- max(-v - v_-, 0) + k d

b: gas force and the sensor's offset (one a run); c: viscous; F_c: Coulomb, a step (g = sgn v) or one spread
over a speed (g = tanh(v / v_s)); c_+, c_-: change of the slope beyond a knee of either direction; k: gas
spring. Linear least squares for every choice of the knees and of v_s on a grid. v: derivative of the local
cubic through the displacement.

usage: static_law.py SIGN HALF_WIDTH_S HELD_OUT.csv FIT.csv...
"""
import itertools
import sys

import numpy as np

KNEES = np.array([0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.55, 0.7, 0.9])  # of the highest speed
SPREADS = (0.0, 0.002, 0.005, 0.01, 0.02, 0.04)  # m/s; 0: a step
LAWS = {"viscous": (), "+ Coulomb": ("coulomb",), "+ knees": ("coulomb", "knees"),
        "+ gas": ("coulomb", "knees", "gas")}


def read_columns(path):
    with open(path, encoding="utf-8") as file:
        names = file.readline().strip().split(",")
    return dict(zip(names, np.loadtxt(path, delimiter=",", skiprows=1, unpack=True)))


def calc_speed(step, position, half_width):
    """Slope in the middle of the least-squares cubic over +- half_width [s]."""
    count = max(2, round(half_width / step))
    times = step * np.arange(-count, count + 1)
    weights = np.linalg.pinv(np.vander(times, 4, increasing=True))[1]
    return np.convolve(np.pad(position, count, mode="edge"), weights[::-1], "valid")


def read_run(path, sign, half_width):
    """Displacement from its mean [m], speed [m/s], force [N]."""
    table = read_columns(path)
    time, position = table["t_s"], 1e-3 * table["disp_mm"]
    step = (time[-1] - time[0]) / (len(time) - 1)
    return position - position.mean(), calc_speed(step, position, half_width), sign * table["force_N"]


def make_columns(run, terms, knees, spread):
    d, v, _ = run
    columns = [v]
    if "coulomb" in terms:
        columns.append(np.tanh(v / spread) if spread > 0 else np.sign(v))
    if "knees" in terms:
        columns += [np.maximum(v - knees[0], 0), -np.maximum(-v - knees[1], 0)]
    if "gas" in terms:
        columns.append(d)
    return np.stack(columns, axis=1)


def fit_law(runs, terms):
    """(coefficients, knees, spread) of the least squares; every run has an offset of its own."""
    top = max(np.abs(v).max() for _, v, _ in runs)
    knees = list(itertools.product(top * KNEES, repeat=2)) if "knees" in terms else [(0.0, 0.0)]
    best = (np.inf,)
    for pair, spread in itertools.product(knees, SPREADS if "coulomb" in terms else (0.0,)):
        blocks = [(make_columns(run, terms, pair, spread), run[2]) for run in runs]
        matrix = np.concatenate([a - a.mean(axis=0) for a, _ in blocks])
        force = np.concatenate([f - f.mean() for _, f in blocks])
        gram, moment = matrix.T @ matrix, matrix.T @ force
        coefficients = np.linalg.lstsq(gram, moment, rcond=1e-12)[0]
        error = force @ force - moment @ coefficients
        if error < best[0]:
            best = (error, coefficients, pair, spread)
    return best[1:]


def calc_error(run, law, terms):
    """Standard deviation of the residual over that of the force."""
    coefficients, knees, spread = law
    residual = run[2] - make_columns(run, terms, knees, spread) @ coefficients
    return residual.std() / run[2].std()


def fit_coulomb(runs):
    """(viscous N s/m, Coulomb N) of F = b + c v + F_c sgn v."""
    matrix = np.concatenate([np.stack([v, np.sign(v)], 1) - [v.mean(), np.sign(v).mean()] for _, v, _ in runs])
    force = np.concatenate([f - f.mean() for _, _, f in runs])
    return np.linalg.lstsq(matrix, force, rcond=None)[0]


def fit_asymmetry(runs):
    """(c_rebound - c_compression) / (c_rebound + c_compression) of F = b + k d + slope in either direction."""
    matrix = np.concatenate([np.stack([np.ones_like(v), d, np.maximum(v, 0), np.minimum(v, 0)], 1)
                             for d, v, _ in runs])
    force = np.concatenate([f for _, _, f in runs])
    _, _, compression, rebound = np.linalg.lstsq(matrix, force, rcond=None)[0]
    return (rebound - compression) / (rebound + compression)


def fit_laws(fit, held_out):
    """Error on the held-out run by name of the law; each law includes those before it."""
    return {name: calc_error(held_out, fit_law(fit, terms), terms) for name, terms in LAWS.items()}


if __name__ == "__main__":
    sign, half_width = float(sys.argv[1]), float(sys.argv[2])
    held_out, *fit = [read_run(path, sign, half_width) for path in sys.argv[3:]]
    for name, error in fit_laws(fit, held_out).items():
        print(f"{name:10} {100 * error:6.2f} %")
    print("viscous, Coulomb: {:.0f} N s/m, {:.0f} N".format(*fit_coulomb(fit)))
    print(f"asymmetry: {fit_asymmetry(fit):.3f}")
