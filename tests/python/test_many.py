"""Many runs, against sweeps and single runs, interrupted, and again and again."""

import os
import signal
import subprocess
import sys
import textwrap
import time

import numpy as np
import pytest

import strut
from conftest import CAR, MANEUVER

STIFFNESS = np.linspace(35500, 40000, 37)


def test_many_runs_have_the_bits_of_a_sweep(car, maneuver, make_request, tmp_path):
    sweep = strut.Sweep(tmp_path / "cars")
    sweep.plan(make_request())
    sweep.run(threads=1)
    data = sweep.read()
    channels = ["body_acceleration_z", "pitch_rate"]
    runs = strut.simulate_many(car, maneuver, data.parameters, channels=channels)
    assert len(runs) == 16 and not runs.status.any()
    for name in channels:
        assert np.array_equal(runs.snapshot[name], data.snapshot[name])
    assert np.array_equal(runs.event_time, data.event_time)


def test_results_do_not_depend_on_threads_or_neighbors(car, maneuver):
    values = {"front_stiffness": np.resize(STIFFNESS, 300)}
    one = strut.simulate_many(car, maneuver, values, threads=1)
    two = strut.simulate_many(car, maneuver, values, threads=2)
    alone = strut.simulate_many(car, maneuver, {"front_stiffness": STIFFNESS[5:6]})
    for name in strut.PAPER_CHANNELS:
        assert np.array_equal(one.snapshot[name], two.snapshot[name])
        assert one.snapshot[name][5] == alone.snapshot[name][0]


def test_histories_of_many_are_those_of_one(car, maneuver):
    runs = strut.simulate_many(car, maneuver, {"front_stiffness": STIFFNESS[:3]}, rate=200,
                               channels="pitch_rate", integrator="rk4", step=1e-3, closure="newton")
    assert runs.history["pitch_rate"].shape == (3, 601)
    single = car.simulate(maneuver, rate=200, front_stiffness=STIFFNESS[1])
    assert np.allclose(runs.history["pitch_rate"][1], single["pitch_rate"], rtol=0, atol=1e-9)
    dataset = runs.to_xarray()
    assert dataset["pitch_rate"].dims == ("case", "time")


def test_failed_cases_stand_beside_others(car, maneuver):
    runs = strut.simulate_many(car, maneuver, {"bump_height": [0.05, 0.3, 0.05], "speed": [20, 30, 20]})
    assert list(runs.status == 0) == [True, False, True]
    assert runs.reason[1] and not runs.reason[0]
    assert np.isnan(runs.snapshot["pitch_rate"][1])
    frame = runs.to_dataframe()
    assert frame["status"][0] == "done" and frame["status"][1] != "done"


@pytest.mark.parametrize("arguments, text", [
    ({"parameters": {}}, "at least one"),
    ({"parameters": {"front_stiffness": [[1.0]]}}, "1 dimension"),
    ({"parameters": {"front_stiffness": [38000.0], "speed": [20.0, 21.0]}}, "2 values, others 1"),
    ({"parameters": {"front_stifness": [38000.0]}}, "front_stiffness"),
    ({"parameters": {"front_stiffness": [38000.0, np.nan]}}, "case 1"),
    ({"parameters": {"front_stiffness": [38000.0]}, "snapshot": False}, "rate"),
    ({"parameters": {"front_stiffness": [38000.0]}, "threads": 0}, "threads"),
    ({"parameters": {"front_stiffness": [38000.0]}, "front_stiffness": 1.0}, "twice"),
    ({"parameters": {"front_stiffness": [4e4], "front_left_stiffness": [4e4]}}, "same quantity"),
    ({"parameters": {"front_stiffness": [4e4], "rear_damping": 1900}}, "keyword"),
    ({"parameters": {"front_stiffness": [4e4]}, "rate": "fast"}, "fast"),
])
def test_errors_name_what_is_wrong(car, maneuver, arguments, text):
    with pytest.raises(strut.InputError) as caught:
        strut.simulate_many(car, maneuver, **arguments)
    assert text in str(caught.value)


@pytest.mark.parametrize("arguments", [
    {"parameters": {"front_stiffness": ["soft"]}},
    {"parameters": {"front_stiffness": [38000 + 1j]}},
    {"parameters": {"front_stiffness": [[38000], [38000, 1]]}},
    {"parameters": {"front_stiffness": None}},
    {"parameters": {"front_stiffness": [38000]}, "offset": float("nan")},
    {"parameters": {"duration": [1e9, 1.0]}, "rate": 1000},
    {"parameters": {"duration": [3000.0]}, "rate": 1e6},
    {"parameters": {"front_stiffness": np.full(100000, 38000)}, "rate": 1e5},
])
def test_careless_arguments_are_refused(car, maneuver, arguments):
    with pytest.raises(strut.InputError), np.testing.suppress_warnings():
        strut.simulate_many(car, maneuver, **arguments)


def test_a_value_out_of_range_is_refused_before_anything_runs(car, maneuver):
    values = np.full(3000000, 38000.0)
    values[-1] = -1.0
    before = time.monotonic()
    with pytest.raises(strut.InputError, match="case 2999999"):
        strut.simulate_many(car, maneuver, {"front_stiffness": values})
    assert time.monotonic() - before < 20.0  # running them takes minutes


def test_arrays_of_effects_and_sensors(car, maneuver):
    gains = strut.simulate_many(car, maneuver, {"pitch_rate_sensor_gain": [0.0, 0.5]}, rate=200,
                                channels=["pitch_rate"])
    ratio = gains.history["pitch_rate"][1, 50:] / gains.history["pitch_rate"][0, 50:]
    assert np.allclose(ratio, 1.5)
    friction = {"front_strut_friction_force": [0.0, 400.0], "rear_strut_friction_force": [0.0, 400.0]}
    runs = strut.simulate_many(car, maneuver, friction)
    exact = strut.simulate_many(car, maneuver, friction, integrator="cvode")
    for name in strut.PAPER_CHANNELS:
        size = np.abs(exact.snapshot[name]).max()
        assert np.abs(runs.snapshot[name] - exact.snapshot[name]).max() < 5e-3 * size, name


def test_a_car_that_never_arrives_has_no_event(car, maneuver):
    runs = strut.simulate_many(car, maneuver, {"duration": [0.1, 3.0]})
    assert [strut.STATUSES[s] for s in runs.status] == ["no_event", "done"]


def test_no_cases_are_no_error(car, maneuver):
    assert len(strut.simulate_many(car, maneuver, {"front_stiffness": []})) == 0


def start_python(code):
    environment = dict(os.environ, PYTHONUNBUFFERED="1")
    # Whatever started the tests may ignore SIGINT.
    code = ("import signal, strut, numpy as np\n"
            "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
            f"CAR, MANEUVER = {str(CAR)!r}, {str(MANEUVER)!r}\n") + textwrap.dedent(code)
    return subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, env=environment)


def test_control_c_ends_a_long_call():
    process = start_python("""
        print("started")
        car = strut.load(CAR)
        strut.simulate_many(car, MANEUVER, {"front_stiffness": np.full(3000000, 38000.0)})
    """)
    try:
        assert process.stdout.readline() == "started\n"
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        _, messages = process.communicate(timeout=60)  # the whole call takes minutes
        assert "KeyboardInterrupt" in messages
    finally:
        process.kill()


@pytest.mark.parametrize("call", [
    "strut.simulate_many(car, MANEUVER, {'front_stiffness': np.full(3000000, 38000.0)})",
    "car.simulate(MANEUVER, duration=60, integrator='cvode')",
])
def test_a_program_may_end_while_a_thread_simulates(call):
    process = start_python(f"""
        import threading, time
        car = strut.load(CAR)
        threading.Thread(target=lambda: {call}, daemon=True).start()
        time.sleep(0.5)
        print("end")
    """)
    try:
        out, messages = process.communicate(timeout=60)
        assert out == "end\n" and process.returncode == 0, messages
    finally:
        process.kill()


@pytest.mark.parametrize("speed", [3.0, 20.0])
def test_defaults_hold_for_slow_cars_too(car, maneuver, speed):
    common = {"speed": speed, "bump_distance": 0.05 + 0.1 * speed}
    values = {"front_stiffness": STIFFNESS[:3]}
    exact = strut.simulate_many(car, maneuver, values, rate=500, integrator="abm4", step=2.5e-4,
                                closure="newton", **common)
    histories = strut.simulate_many(car, maneuver, values, rate=500, **common)
    snapshots = strut.simulate_many(car, maneuver, values, **common)
    assert not (exact.status.any() or histories.status.any() or snapshots.status.any())
    for name in strut.PAPER_CHANNELS:
        size = np.ptp(exact.history[name])
        assert np.abs(histories.history[name] - exact.history[name]).max() < 1e-3 * size, name
        assert np.abs(snapshots.snapshot[name] - exact.snapshot[name]).max() < 5e-4 * size, name


def test_other_threads_run_meanwhile():
    process = start_python("""
        import threading
        import time
        car, times, over = strut.load(CAR), [], False
        def tick():
            while not over:
                times.append(time.monotonic())
                time.sleep(1e-3)
        thread = threading.Thread(target=tick)
        thread.start()
        before = time.monotonic()
        strut.simulate_many(car, MANEUVER, {"front_stiffness": np.full(12000, 38000.0)}, threads=1)
        after, over = time.monotonic(), True
        thread.join()
        inside = np.array([before] + [t for t in times if before < t < after] + [after])
        print(np.diff(inside).max() / (after - before))
    """)
    out, messages = process.communicate(timeout=60)
    assert float(out) < 0.5, messages  # the longest time without a tick; 1 without the lock


def test_the_package_is_imported_quickly():
    times = []
    for _ in range(5):
        before = time.monotonic()
        subprocess.run([sys.executable, "-c", "import numpy"], check=True)
        between = time.monotonic()
        subprocess.run([sys.executable, "-c", "import strut"], check=True)
        times.append((time.monotonic() - between) - (between - before))
    assert min(times) < 0.3


def measure_memory():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_calls_leak_nothing(car, maneuver):
    def call(count):
        for _ in range(count):  # a run holds 1.4 MB
            run = car.simulate(maneuver, closure="table", integrator="abm4", coarse_step=10e-3)
            run["pitch_rate"].sum()
            runs = strut.simulate_many(car, maneuver, {"front_stiffness": STIFFNESS[:8]}, rate=1000)
            runs.history["pitch_rate"].sum()
            strut.load(CAR)

    call(5)
    before = measure_memory()
    call(40)
    assert measure_memory() - before < 10e6


def test_forked_processes_simulate_and_end():
    process = start_python("""
        import os
        car = strut.load(CAR)
        strut.simulate_many(car, MANEUVER, {"front_stiffness": np.full(16, 38000.0)})
        child = os.fork()
        if child == 0:
            import threading, time
            many = {"front_stiffness": np.full(3000000, 38000.0)}
            threading.Thread(target=lambda: strut.simulate_many(car, MANEUVER, many), daemon=True).start()
            time.sleep(0.3)
            raise SystemExit(0)
        print(os.waitpid(child, 0)[1])
    """)
    try:
        out, messages = process.communicate(timeout=60)
        assert out == "0\n" and process.returncode == 0, messages
    finally:
        process.kill()


def test_nothing_begins_once_the_program_ends():
    process = start_python("""
        import atexit
        car = strut.load(CAR)
        atexit._run_exitfuncs()  # as the handlers that were registered before this package's
        try:
            car.simulate(MANEUVER)
        except RuntimeError as error:
            print(error)
    """)
    try:
        out, messages = process.communicate(timeout=60)
        assert out == "the program is ending\n" and process.returncode == 0, messages
    finally:
        process.kill()
