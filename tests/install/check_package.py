#!/usr/bin/env python3
"""Makes the Debian package of a build, unpacks it elsewhere, reads its control file, and lets the
program in it plan, simulate and verify a sweep of the examples in it.

usage: check_package.py BUILD_FOLDER VERSION

Exit code 77: no Debian tools are there.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_commands import check, run


def read_control(package):
    """Fields of the control file, continuation lines joined."""
    text = run("dpkg-deb", "-f", package)
    return dict(re.match(r"([\w-]+): *(.*)", field, re.S).groups()
                for field in re.split(r"\n(?! )", text.strip()))


def check_control(control, version):
    check(control["Package"] == "strut" and control["Version"] == version, control)
    check(control["Architecture"] == run("dpkg", "--print-architecture").strip(), control)
    check(re.fullmatch(r"[^<]+ <[^@ ]+@[^> ]+>", control["Maintainer"]), control["Maintainer"])
    check(control["Section"] == "science" and control["Priority"] == "optional", control)
    depends = control["Depends"]
    for name in ("libc6", "libstdc++6", "libgomp1", "libhdf5-", "libsundials-cvode", "libssl3",
                 "zlib1g", "libboost-program-options"):
        check(re.search(rf"(^|, ){re.escape(name)}[^,]*", depends), f"{name} not in {depends}")
    # The first line is the summary: short, no sentence.
    summary, *text = control["Description"].splitlines()
    check(len(summary) < 80 and not summary.endswith(".") and len(text) > 3, control["Description"])


def check_files(package, root, build):
    for name in ("bin/strut", "share/man/man1/strut.1", "share/bash-completion/completions/strut",
                 "share/zsh/site-functions/_strut", "share/fish/vendor_completions.d/strut.fish",
                 "share/doc/strut/LICENSE", "share/doc/strut/examples/vehicles/paper_sedan.toml",
                 "share/doc/strut/copyright", "share/doc/strut/README.md",
                 "share/doc/strut/docs/theory.md", "share/strut/examples/sweeps/paper.toml",
                 "share/strut/examples/api/identify.cc", "include/strut/sweep/run.h",
                 "lib/libstrut_kernel.a", "lib/cmake/strut/strutConfig.cmake"):
        check((root / "usr" / name).is_file(), f"usr/{name} is not in the package")
    check(sorted(path.name for path in root.iterdir()) == ["usr"], "files beside usr")
    check("License: MIT" in (root / "usr/share/doc/strut/copyright").read_text(), "license")
    for path in (root / "usr/lib/cmake/strut").iterdir():
        check(str(build) not in path.read_text(), f"{path.name} names the build folder")
    check("not stripped" not in run("file", root / "usr/bin/strut"), "the program is not stripped")
    for line in run("dpkg-deb", "-c", package).splitlines():
        check(re.match(r"([d-]rw[x-]r-[x-]r-[x-]|lrwxrwxrwx) root/root ", line), f"owner or mode: {line}")


def check_program(root, folder, version):
    strut, examples = root / "usr/bin/strut", root / "usr/share/strut/examples"
    check(run(strut, "--version").startswith(f"strut {version} "), "--version")
    sweep = folder / "sweep"
    run(strut, "plan", examples / "api/small_sweep.toml", "-o", sweep)
    run(strut, "run", sweep)
    verdict = json.loads(run(strut, "verify", sweep, "--sample", "5", "--json"))
    check(verdict["ok"] and verdict["cases"] == 20 and verdict["missing"] == 0, verdict)


def check_python(package, root, version):
    """The package of Python beside that of the program, both unpacked."""
    control = read_control(package)
    check(control["Package"] == "python3-strut" and control["Version"] == version, control)
    check(f"strut (= {version})" in control["Depends"] and "python3-numpy" in control["Depends"],
          control["Depends"])
    run("dpkg-deb", "-x", package, root)
    check("not stripped" not in run("file", next(root.glob("usr/lib/python3/dist-packages/strut/_core*"))),
          "the module is not stripped")
    script = (
        "import strut, sys; examples = sys.argv[1]\n"
        "car = strut.load(examples + '/vehicles/paper_sedan.toml')\n"
        "print(car.simulate(examples + '/maneuvers/bump_20mps.toml').status)\n"
        "print(strut.Sweep(sys.argv[2]).status()['done'])\n")
    environment = {key: value for key, value in os.environ.items() if key != "STRUT_PROGRAM"}
    environment["PYTHONPATH"] = str(root / "usr/lib/python3/dist-packages")
    said = subprocess.run(
        ["/usr/bin/python3", "-c", script, root / "usr/share/strut/examples", root.parent / "sweep"],
        env=environment, capture_output=True, text=True, check=False)
    check(said.stdout.split() == ["done", "20"], said.stdout + said.stderr)


def main():
    build, version = pathlib.Path(sys.argv[1]), sys.argv[2]
    for tool in ("dpkg-deb", "dpkg-shlibdeps", "file"):
        if shutil.which(tool) is None:
            print(f"skipped: no {tool} (Debian: dpkg, dpkg-dev, file)")
            sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name).resolve()
        run("cpack", "--config", build / "CPackConfig.cmake", "-G", "DEB", "-B", folder)
        architecture = run("dpkg", "--print-architecture").strip()
        package = folder / f"strut_{version}_{architecture}.deb"
        check(package.is_file(), f"{package.name} was not made: {os.listdir(folder)}")
        check_control(read_control(package), version)
        root = folder / "root"
        run("dpkg-deb", "-x", package, root)
        check_files(package, root, build)
        check_program(root, folder, version)
        python = folder / f"python3-strut_{version}_{architecture}.deb"
        if (build / "python/strut").is_dir():
            check_python(python, root, version)


main()
