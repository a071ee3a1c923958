#!/usr/bin/env python3
"""What strut says to a terminal and what to a pipe: colors and a line that changes in place only on a
terminal, and there neither with NO_COLOR (https://no-color.org) nor with TERM=dumb.

usage: talk_on_terminal.py STRUT
"""

import os
import pathlib
import pty
import subprocess
import sys
import tempfile

SOURCES = pathlib.Path(__file__).resolve().parents[2]
CAR = SOURCES / "examples/vehicles/paper_sedan.toml"
BUMP = SOURCES / "examples/maneuvers/bump_20mps.toml"
RED, BOLD, ERASE = b"\033[31m", b"\033[1m", b"\r\033[K"


def check(good, what):
    if not good:
        sys.exit(f"failed: {what}")


def make_environment(variables):
    environment = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "TERM")}
    return environment | variables


def run_on_terminal(words, variables):
    """All that appears on a terminal that is standard output and standard error."""
    ours, theirs = pty.openpty()
    child = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=theirs, stderr=theirs,
                             env=make_environment(variables))
    os.close(theirs)
    said = b""
    while True:
        try:
            part = os.read(ours, 4096)
        except OSError:  # Linux: the last of the other side is closed
            break
        if not part:
            break
        said += part
    child.wait()
    os.close(ours)
    return said


def run_in_pipe(words, variables):
    done = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, env=make_environment(variables), check=False)
    return done.stdout


def main():
    strut = sys.argv[1]
    terminal = {"TERM": "xterm"}
    with tempfile.TemporaryDirectory() as folder:
        def simulate(*options):
            return [strut, "simulate", CAR, BUMP, "--force", "-o", f"{folder}/run.csv", *options]

        wrong, done = simulate("--step", "7"), simulate()
        check(RED + b"strut:" in run_on_terminal(wrong, terminal), "an error is red")
        said = run_on_terminal(done, terminal)
        check(BOLD + b"next:" in said, "what is next is bold")
        check(RED not in said, "what is no error is not red")
        check(BOLD + b"Usage:" in run_on_terminal([strut, "plan", "--help"], terminal),
              "the help's headings are bold")
        for words in (wrong, done, [strut, "plan", "--help"]):
            plain = run_in_pipe(words, terminal)
            check(plain and b"\033" not in plain, f"no escape in a pipe: {plain}")
            for variables in (terminal | {"NO_COLOR": "1"}, {"TERM": "dumb"}, {}):
                said = run_on_terminal(words, variables)
                check(said and b"\033[3" not in said and b"\033[1m" not in said,
                      f"no color with {variables}: {said}")
        check(RED in run_on_terminal(wrong, terminal | {"NO_COLOR": ""}),
              "an empty NO_COLOR asks for nothing")

        # 60 s of driving take a second or two: the line appears, is erased, and ends erased.
        long = simulate("--rate", "1", "--set", "duration=60")
        said = run_on_terminal(long, terminal)
        check(said.count(ERASE + b"simulating 1 min 0 s, ") > 1, f"a line in place: {said}")
        check(said.rfind(ERASE) < said.rfind(b"next:"), "it is erased before the last words")
        check(b"simulating" not in said[said.rfind(ERASE):], "nothing of it stays")
        for said in (run_on_terminal(long, {"TERM": "dumb"}),
                     run_on_terminal(long + ["--quiet"], terminal), run_in_pipe(long, terminal)):
            check(ERASE not in said, f"no line in place: {said}")
        check(ERASE in run_on_terminal(long, terminal | {"NO_COLOR": "1"}),
              "NO_COLOR is about colors alone")
    print("passed")


if __name__ == "__main__":
    main()
