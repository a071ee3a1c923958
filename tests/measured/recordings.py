"""What each recording is diagnosed with, what is known of it from elsewhere, and the limits of its figures
(docs/measured.md). Files: name in the campaign, name of the recording; the last one is held out.

causes: each a tuple of names of which one must be claimed. plausible: what may be claimed with more than 0.8
beside them, since an independent look at the recording confirms it or shows that it cannot be told from the truth. errors: of the extended model on the held-out
run, in % of the channel's standard deviation. sizes: what a claimed parameter must lie between. lost_motion: what
play and both flanks of the friction must lie between [m].
"""


def make_mr_damper(current, sizes, errors, ratio):
    names = ("10mm1Hz", "5mm3Hz", "25mm0x5Hz")
    return {
        "folder": "mr_damper", "campaign": "mr_damper.toml",
        "files": {f"{name}0A.csv": f"{name}{current}.csv" for name in names},
        "sign": 1, "half_width": 0.02, "of_static_law": ratio,
        "causes": [("strut_friction",)],
        "errors": {"force": errors}, "sizes": sizes,
    }


def make_friction_damper(tension, sizes, errors, ratio, **play):
    return {
        "folder": "friction_damper", "campaign": "friction_damper.toml",
        "files": {f"dataset-1_{hz}Hz20lbtension.csv": f"dataset-1_{hz}Hz{tension}lbtension.csv"
                  for hz in ("0.5", "1")},
        "sign": 1, "half_width": 0.02, "of_static_law": ratio,
        "causes": [("strut_friction",)], "errors": {"force": errors}, "sizes": sizes, **play,
    }


def make_quarter_car(fit, held_out, causes, errors, plausible=()):
    return {
        "folder": "quanser_quarter_car", "campaign": "quarter_car.toml",
        "files": {"chirp_A1.csv": fit, "chirp_A2.csv": held_out},
        "causes": causes, "plausible": list(plausible),
        "errors": dict(zip(("sprung_position", "unsprung_position"), errors)), "sizes": {},
    }


RECORDINGS = {
    "damper_dyno": {
        "folder": "damper_dyno", "campaign": "damper_dyno.toml",
        "files": {"trial_1.csv": "t1_3_3_18_18_s5_n100_50psi.csv",
                  "trial_2.csv": "t2_3_3_18_18_s5_n100_50psi.csv"},
        "sign": -1, "half_width": 0.03, "of_static_law": 0.9,
        "causes": [("damper_asymmetry",)],
        "plausible": [("damper_blow_off",), ("damper_hysteresis", "top_mount_compliance", "sensor_lowpass")],
        "errors": {"force": 4.0},
        "sizes": {("damper_asymmetry", "asymmetry"): (0.26, 0.318)},
        "known": {("damper_asymmetry", "asymmetry"): 0.289},
    },
    "mr_damper_0A": make_mr_damper("0A", {("strut_friction", "force"): (110, 150)}, 11.5, 0.87),
    "mr_damper_0.5A": make_mr_damper("0x5A", {("strut_friction", "force"): (600, 740)}, 10.2, 0.82),
    "friction_damper_20lb": make_friction_damper(
        20, {("strut_friction", "force"): (3700, 4500)}, 30.0, 0.6,
        causes=[("strut_friction",), ("joint_play",)], lost_motion=(0.004, 0.007),
        known={("strut_friction", "force"): 4100.0}),
    "friction_damper_70lb": make_friction_damper(
        70, {("strut_friction", "force"): (8800, 12000)}, 25.0, 0.6),
    "quarter_car_steps": make_quarter_car(
        "step_Q1_10.csv", "step_Q3_10.csv", [("strut_friction",)], (2.0, 2.3), [("road_gain",)]),
    "quarter_car_chirps": make_quarter_car("chirp_A1.csv", "chirp_A2.csv", [], (8.9, 9.5)),
    "quarter_car_chirps_B": make_quarter_car("chirp_A1.csv", "chirp_B1.csv", [], (11.7, 11.0)),
}
