#!/usr/bin/env python3
"""Installs a build, moves what was installed elsewhere, builds the projects of examples/api against it
alone, and compares what they answer with the installed program.

usage: check_consumer.py BUILD_FOLDER
"""

import json
import os
import pathlib
import re
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_commands import check, run

# Nothing but the prefix named may lead to the libraries.
ENVIRONMENT = {name: value for name, value in os.environ.items()
               if not re.match("CMAKE_|STRUT_|DESTDIR|CXXFLAGS|CPATH|.*INCLUDE_PATH", name)}


def read_cache(build):
    lines = (build / "CMakeCache.txt").read_text().splitlines()
    return dict(re.match(r"([^:]+):[^=]*=(.*)", line).groups() for line in lines
                if re.match(r"[A-Za-z]\w*:", line))


def install(build, folder):
    """An installation that was moved after it was made."""
    run("cmake", "--install", build, "--prefix", folder / "made", env=ENVIRONMENT)
    return (folder / "made").rename(folder / "moved")


def write_every_header(prefix, project):
    """All installed headers, each twice, forwards and backwards: they are guarded, and complete."""
    root = prefix / "include/strut"
    headers = sorted(path.relative_to(root).as_posix() for path in root.rglob("*.h"))
    check(len(headers) > 100, "headers are missing")
    for name, order in (("every_header", headers), ("every_header_back", headers[::-1])):
        (project / f"{name}.cc").write_text("".join(f'#include "{h}"\n' for h in order * 2))
    with open(project / "CMakeLists.txt", "a", encoding="utf-8") as file:
        file.write("\nadd_library(every_header OBJECT every_header.cc every_header_back.cc)\n"
                   "target_link_libraries(every_header PRIVATE strut::model strut::io strut::sweep\n"
                   "  strut::train strut::diagnose)\n")


def configure(project, build, prefix, cache, *settings):
    launcher = [f"-DCMAKE_CXX_COMPILER_LAUNCHER={cache['STRUT_CCACHE']}"
                for _ in [0] if cache.get("STRUT_CCACHE", "").startswith("/")]
    run("cmake", "-S", project, "-B", build, "-G", cache["CMAKE_GENERATOR"],
        f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_COMPILER={cache['CMAKE_CXX_COMPILER']}",
        "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", *launcher, *settings, env=ENVIRONMENT)


def check_interface(build, source):
    """What reaches a user's compiler is the installed folder and what must hold there, no more."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        command = entry["command"]
        check(str(source) not in command, f"the sources are named: {command}")
        check("-std=gnu++20" in command or "-std=c++20" in command, f"not C++20: {command}")
        check(not re.search(r" -(W|fsanitize|m|fno-|fopenmp|O)", command), f"flags leak: {command}")
        for word in ("EIGEN_DONT_PARALLELIZE", "EIGEN_MALLOC_ALREADY_ALIGNED="):
            # The other programs include no header with Eigen.
            if re.search("identify|every_header", command):
                check(f" -D{word}" in command, f"not told how to use Eigen: {command}")


def check_other_alignment(project, folder, prefix, cache):
    """A program whose Eigen would align otherwise does not compile."""
    configure(project, folder / "avx", prefix, cache, "-DCMAKE_CXX_FLAGS=-mavx2")
    out = run("cmake", "--build", folder / "avx", "--target", "identify", codes=(1, 2))
    check("Eigen's alignment is not that of the installed strut" in out, out)


def read_lines(text):
    """First number of each line that has one, by the words before it."""
    found = (re.match(r"(.*?) (-?[0-9][^ ]*|-?inf|-?nan)( |$)", line) for line in text.splitlines())
    return {match[1]: float(match[2]) for match in found if match}


def check_simulation(build, strut, car, folder):
    told = json.loads(run(strut, "simulate", *car, "--set", "front_left_stiffness=38000", "--json",
                          "-o", folder / "one.csv"))
    own = read_lines(run(build / "simulate_one_run", *car))
    check(own["event_time"] == told["event_time"],
          f"event_time: {own['event_time']}, strut simulate: {told['event_time']}")
    check(len(told["snapshot"]) == 5, "the program's snapshot")
    for name, value in told["snapshot"].items():
        check(own[name] == value, f"{name}: {own[name]}, strut simulate: {value}")


def check_sweep(build, strut, request, sweep):
    table = run(build / "plan_and_run_a_sweep", request, sweep).splitlines()
    check(table[0].startswith("case_id,front_stiffness,rear_damping,body_position_z"), table[0])
    rows = [[float(cell) for cell in line.split(",")] for line in table[1:]]
    check(sorted(row[0] for row in rows) == list(range(20)), "20 cases, each once")
    check({row[1] for row in rows} == {40e3, 39e3, 38e3, 37e3, 36e3}, "levels")
    check(len({tuple(row[3:]) for row in rows}) == 20, "20 different cars move in 20 ways")
    verdict = json.loads(run(strut, "verify", sweep, "--sample", "3", "--json"))
    check(verdict["ok"] and verdict["cases"] == 20, f"strut verify: {verdict}")


def check_identification(build, strut, car, sweep, folder):
    model, drive = folder / "model.h5", folder / "drive.h5"
    run(strut, "train", sweep, "-o", model, "--hidden", "3", "--epochs", "50")
    run(strut, "simulate", *car, "-o", drive, "--rate", "200", "--set", "front_stiffness=38200",
        "--set", "rear_damping=1904")
    network = json.loads(run(strut, "identify", model, drive, "--json"))["parameters"]
    fit = json.loads(run(strut, "identify", car[0], drive, "--maneuver", car[1], "--json"))
    own = read_lines(run(build / "identify", model, *car, drive))
    for way, parameters in (("network", network), ("fit", fit["parameters"])):
        check(parameters, f"{way}: no parameters")
        for name, told in parameters.items():
            value = own[f"{way} {name}"]
            check(value == told["value"], f"{way}: {name} = {value}, strut identify: {told}")
    check(abs(own["fit front_stiffness"] - 38200) < 10, f"the fit found another car: {own}")


def check_own_examples(strut):
    """Without files the benchmark takes the examples installed with it."""
    out = run(strut, "bench", "--quick")
    check("sweep of 512 cases (paper_fast.toml)" in out, out)


def main():
    build, source = pathlib.Path(sys.argv[1]), pathlib.Path(__file__).resolve().parents[2]
    cache = read_cache(build)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name).resolve()
        prefix = install(build, folder)
        examples, strut = prefix / "share/strut/examples", prefix / "bin/strut"
        os.chdir(folder)  # outside of the sources: nothing of examples/ lies above
        project = folder / "project"
        project.mkdir()
        for path in (examples / "api").iterdir():
            (project / path.name).write_bytes(path.read_bytes())
        write_every_header(prefix, project)
        configure(project, folder / "plain", prefix, cache)
        check_interface(folder / "plain", source)
        run("cmake", "--build", folder / "plain")
        if os.uname().machine == "x86_64":
            check_other_alignment(project, folder, prefix, cache)

        car = (examples / "vehicles/paper_sedan.toml", examples / "maneuvers/bump_20mps.toml")
        sweep = folder / "sweep"
        check_simulation(folder / "plain", strut, car, folder)
        check_sweep(folder / "plain", strut, examples / "api/small_sweep.toml", sweep)
        check_identification(folder / "plain", strut, car, sweep, folder)
        check_own_examples(strut)


main()
