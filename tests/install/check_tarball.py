#!/usr/bin/env python3
"""Makes the tarball of a build and lets its program simulate, plan, run and verify where nothing is but the
files of Debian's libc6 and the tarball.

usage: check_tarball.py BUILD_FOLDER VERSION

Exit code 77: no chroot (not root), or no dpkg to name the files of libc6.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_commands import check, run


def list_libc_files():
    """The shared objects of libc6, as dpkg lists them."""
    names = run("dpkg", "-L", "libc6").split("\n")
    return [pathlib.Path(name) for name in names
            if re.search(r"\.so(\.|$)", name) and pathlib.Path(name).is_file()]


def make_root(root, tarball):
    for file in list_libc_files():
        target = root / file.resolve().relative_to("/")
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(file.resolve(), target)
    loader = root / "lib64/ld-linux-x86-64.so.2"
    if not loader.exists():
        loader.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2("/lib64/ld-linux-x86-64.so.2", loader)
    for name in ("lib/x86_64-linux-gnu",):  # where the loader looks; a link on Debian
        if not (root / name).exists():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).symlink_to("/usr/" + name)
    (root / "tmp").mkdir()
    (root / "opt").mkdir()
    (root / "proc").mkdir()
    with tarfile.open(tarball) as archive:
        archive.extractall(root / "opt")


def main():
    build, version = pathlib.Path(sys.argv[1]), sys.argv[2]
    if os.geteuid() != 0 or shutil.which("dpkg") is None or os.uname().machine != "x86_64":
        print("skipped: chroot needs root, and dpkg the files of libc6")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name).resolve()
        run("cpack", "--config", build / "CPackConfig.cmake", "-G", "TGZ", "-B", folder)
        tarballs = list(folder.glob("*.tar.gz"))
        check(len(tarballs) == 1 and version in tarballs[0].name, os.listdir(folder))
        root = folder / "root"
        root.mkdir()
        make_root(root, tarballs[0])
        (home,) = [path for path in (root / "opt").iterdir()]
        home = pathlib.Path("/") / home.relative_to(root)

        # Without /proc the loader takes the program's folder, $ORIGIN, from here.
        environment = {"HOME": "/tmp", "LD_ORIGIN_PATH": str(home / "bin")}

        def strut(*words):
            done = subprocess.run([shutil.which("chroot") or "/usr/sbin/chroot", root, home / "bin/strut", *words], text=True,
                                  capture_output=True, check=False, env=environment)
            check(done.returncode == 0, f"strut {words}: {done.stdout}{done.stderr}")
            return done.stdout

        check(strut("--version").startswith(f"strut {version} "), "--version")
        examples = home / "share/strut/examples"
        strut("simulate", examples / "vehicles/paper_sedan.toml", examples / "maneuvers/bump_20mps.toml",
              "-o", "/tmp/run.h5")
        strut("plan", examples / "api/small_sweep.toml", "-o", "/tmp/sweep")
        strut("run", "/tmp/sweep", "--threads", "1")
        check('"ok": true' in strut("verify", "/tmp/sweep", "--json"), "verify")
        size = tarballs[0].stat().st_size
        print(f"{tarballs[0].name}: {size / 1e6:.1f} MB, "
              f"{len(list((root / 'opt').glob('*/lib/strut/*')))} shared libraries")


main()
