#!/usr/bin/env python3
"""Runs what a document shows, and compares what it prints with what the document says it prints.

  run_snippets.py STRUT SOURCES DOCUMENT.md [--only-check] [--fill] [--keep DIR]

STRUT is the built program, SOURCES the root of the sources. The blocks run in order, in one new folder
that looks like the root of a clone after the build.

  sh       runs under `bash -eu`. Commands of strut and their options must exist, run or not.
  text     right behind a sh block: what that printed, standard output and messages together. `...` stands
           for anything within a line, a line `...` for any lines. Elsewhere it needs a mark.
  toml     is parsed;  json  too
  python   runs; c, cpp  are compiled as they stand

Marks are comments on the lines before a block:

  <!-- not run: REASON -->       sh, python, c, cpp: only checked; others: not even that
  <!-- .ci/run: NAME -->         sh: run by .ci/run, so not here
  <!-- exit code: N -->          sh: what the block ends with, where that is not 0
  <!-- file: NAME -->            written to the folder under that name, not run or compiled
  <!-- layout: WHAT -->          text that shows a form or a formula, not an output

  <!-- numbers within a factor of: F -->  text: in lines without `...`, as rounding differs between
                                 processors and a training carries it on
  <!-- needs: slurm -->          sh: where no Slurm answers, not run

--only-check runs nothing: links, paths, commands and options are checked, and what can be parsed is.
--fill refreshes a document: every text block that is empty becomes what was printed (then write `...` for
what depends on the machine). --keep leaves the folder in DIR.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import tomllib

import markdown

SECONDS = 1200  # for one block
MARKS = {"not run", ".ci/run", "exit code", "file", "layout", "numbers within a factor of", "needs"}


def make_clone(folder, strut, sources):
    """Fills folder with a copy of the sources, and build/release/strut."""
    listing = subprocess.run(
        ["git", "-C", sources, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        capture_output=True, text=True, check=False
    )
    if listing.returncode == 0 and listing.stdout:
        for name in filter(None, listing.stdout.split("\0")):
            if (sources / name).is_file():
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(sources / name, folder / name)
    else:
        leave_out = shutil.ignore_patterns("build", ".git", "__pycache__")
        shutil.copytree(sources, folder, ignore=leave_out, dirs_exist_ok=True)
    (folder / "build/release").mkdir(parents=True, exist_ok=True)
    (folder / "build/release/strut").symlink_to(strut)
    if (strut.parent / "python/strut").is_dir():
        (folder / "build/release/python").symlink_to(strut.parent / "python")


NUMBER = re.compile(r"(?<![\w.])-?\d[\d,]*(?:\.\d+)?(?:e[-+]\d+)?(?![\w])")


def are_near(expected, actual, factor):
    a, b = (float(text.replace(",", "")) for text in (expected, actual))
    return a == b or (a * b > 0 and 1 / factor <= a / b <= factor)


def match_line(expected, actual, factor=1.0):
    """Whether an expected line stands for the actual one, numbers within that factor."""
    pattern = ".*".join(re.escape(part) for part in expected.rstrip().split("..."))
    if re.fullmatch(pattern, actual.rstrip()):
        return True
    if factor == 1.0 or "..." in expected:
        return False
    # More digits make fewer blanks.
    words = [" ".join(NUMBER.sub(" # ", line).split()) for line in (expected, actual)]
    numbers = [NUMBER.findall(line) for line in (expected, actual)]
    return words[0] == words[1] and all(are_near(a, b, factor) for a, b in zip(*numbers))


def find_difference(expected, actual, factor=1.0):
    """None where the lines match, else the first expected line (its number from 0) that cannot."""
    # reachable: how many lines of actual the expected lines so far may have taken.
    reachable = {0}
    for number, line in enumerate(expected):
        if line.strip() == "...":
            reachable = set(range(min(reachable), len(actual) + 1))
        else:
            reachable = {
                i + 1
                for i in reachable
                if i < len(actual) and match_line(line, actual[i], factor)
            }
        if not reachable:
            return number
    return None if len(actual) in reachable else len(expected)


def has_slurm():
    return shutil.which("sinfo") and subprocess.run(["sinfo", "-h"], capture_output=True).returncode == 0


class CommandLines:
    """Which commands and options strut has, from its --help."""

    def __init__(self, strut):
        self.strut = strut
        self.options = {}
        text = subprocess.run([strut, "--help"], capture_output=True, text=True, check=True).stdout
        listed = text.split("Commands:")[1].split("\n\n")[0]
        self.commands = set(re.findall(r"^  (\w+) ", listed, re.M))

    def list_options(self, command):
        if command not in self.options:
            text = subprocess.run(
                [self.strut, command, "--help"], capture_output=True, text=True, check=True
            ).stdout
            lines = text.split("Options:")[1].split("\nExamples:")[0]
            self.options[command] = set(re.findall(r"(?<![\w-])--?[a-zA-Z][\w-]*", lines))
        return self.options[command]

    def find_wrong(self, text):
        """What is wrong with the calls of strut in the lines of a shell."""
        text = re.sub(r"\\\n\s*", " ", text)
        wrong = []
        # A call ends at what a shell ends it with; quoted text, comments and redirections are no part.
        text = re.sub(r"(?m)(^|\s)#.*$", "", text)
        text = re.sub(r"'[^'\n]*'|\"[^\"\n]*\"", "QUOTED", text)
        text = re.sub(r"\d?>>?\s*&?[^\s|;&)]+|<\s*[^\s|;&)(]+", "", text)
        calls = r"(?:^|(?<=[\s`(/$]))strut +([a-z]\w*)([^\n|;&)]*)"
        for command, rest in re.findall(calls, text):
            if command == "help" and (not rest.strip() or rest.split()[0].isupper()):
                continue
            if command == "help":
                command, rest = rest.split()[0], ""
            if command not in self.commands:
                wrong.append(f"strut has no command {command}")
                continue
            for option in re.findall(r"(?<=\s)(--?[a-zA-Z][\w-]*)", rest):
                if option not in self.list_options(command):
                    wrong.append(f"strut {command} has no option {option}")
        return wrong


class Document:
    def __init__(self, args):
        self.file = args.document
        self.sources = args.sources
        self.fill = args.fill
        self.only_check = args.only_check
        self.strut = args.strut
        self.calls = CommandLines(args.strut)
        self.text = self.file.read_text(encoding="utf-8")
        self.blocks = markdown.read_blocks(self.text)
        self.wrong = []
        self.left_out = []
        self.filled = []
        self.ran = 0

    def complain(self, block, sentence):
        self.wrong.append(f"{self.file.name}:{block.line}: {sentence}")

    def check_prose(self):
        """Links, paths, and the commands that stand in backticks."""
        for sentence in markdown.find_broken_references(self.file, self.sources):
            self.wrong.append(f"{self.file.name}: {sentence}")
        for code in re.findall(r"`([^`]+)`", markdown.drop_blocks(self.text)):
            for sentence in self.calls.find_wrong(code.replace("\n", " ")):
                self.wrong.append(f"{self.file.name}: {sentence} (`{code}`)")

    def run_all(self, folder):
        self.folder = folder
        before = None
        for block in self.blocks:
            for mark in block.marks.keys() - MARKS:
                self.complain(block, f"there is no mark '{mark}'; known: {', '.join(sorted(MARKS))}")
            if block.marks.get("needs", "slurm") != "slurm":
                self.complain(block, "'needs' knows slurm only")
            if "not run" in block.marks and not block.marks["not run"]:
                self.complain(block, "'not run' needs a reason")
            if block.language == "text":
                self.check_text(block, before)
            else:
                self.check_block(block)
            before = block

    def check_text(self, block, before):
        if "layout" in block.marks or "not run" in block.marks:
            return
        if before is None or before.language != "sh":
            self.complain(block, "text belongs to no sh block before it; mark it '<!-- layout: ... -->'")
        elif before.marks.keys() & {"not run", ".ci/run", "file"}:
            self.complain(block, "the block before it does not run; mark it '<!-- layout: ... -->'")

    def check_block(self, block):
        language = block.language
        reason = block.marks.get("not run")
        if ".ci/run" in block.marks:
            reason = ".ci/run does"
        if self.only_check and language in {"sh", "python", "c", "cpp"} and reason is None:
            reason = "--only-check"
        if block.marks.get("needs") == "slurm" and reason is None and not has_slurm():
            reason = "no Slurm answers"
        if language == "sh":
            for sentence in self.calls.find_wrong(block.text):
                self.complain(block, sentence)
        if reason is not None:
            self.left_out.append(f"{self.file.name}:{block.line}: {reason}")
        if "file" in block.marks:
            path = self.folder / block.marks["file"]
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text, encoding="utf-8")
            if language in {"sh", "csv"}:
                return
        check = getattr(self, "check_" + language, None)
        if check is not None:
            check(block, reason is None)
        elif reason is None:
            self.complain(block, f"nobody here can run a block of '{language}': mark it as not run")

    def run(self, block, command, **options):
        """What the command printed, and its exit code."""
        environment = dict(os.environ)
        # The system's Python comes first: that one has Debian's h5py.
        environment["PATH"] = f"{self.folder}/build/release:/usr/bin:{environment['PATH']}"
        environment["PYTHONPATH"] = f"{self.folder}/build/release/python"
        environment.pop("CDPATH", None)
        result = subprocess.run(
            command, cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=SECONDS, check=False,
            # A shell's background job ignores Ctrl-C, and so would what it starts.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL), **options
        )
        self.ran += 1
        return result.stdout.decode("utf-8", "replace"), result.returncode

    def check_sh(self, block, may_run):
        if not may_run:
            if subprocess.run(["bash", "-n", "-c", block.text], check=False).returncode != 0:
                self.complain(block, "bash does not understand it")
            return
        out, code = self.run(block, ["bash", "-eu", "-o", "pipefail", "-c", block.text])
        if code != int(block.marks.get("exit code", 0)):
            self.complain(block, f"ended with exit code {code} and printed\n{out}")
            return
        following = self.blocks[self.blocks.index(block) + 1 :][:1]
        if not following or following[0].language != "text" or "layout" in following[0].marks:
            return
        if self.fill and not following[0].text:
            following[0].text = out
            self.filled.append(following[0])
            return
        expected = following[0].text.splitlines()
        actual = out.splitlines()
        factor = float(following[0].marks.get("numbers within a factor of", 1))
        at = find_difference(expected, actual, factor)
        if at is not None:
            line = expected[at] if at < len(expected) else "(the end)"
            self.complain(
                following[0], f"no such line where it is expected: {line}\nall that was printed:\n{out}"
            )

    def write_filled(self):
        lines = self.text.splitlines(keepends=True)
        for block in reversed(self.filled):
            lines.insert(block.line, block.text)
        self.file.write_text("".join(lines), encoding="utf-8")

    def check_toml(self, block, may_run):
        try:
            tomllib.loads(block.text)
        except tomllib.TOMLDecodeError as e:
            if may_run:
                self.complain(block, f"not TOML: {e}")

    def check_json(self, block, may_run):
        try:
            json.loads(block.text)
        except json.JSONDecodeError as e:
            if may_run:
                self.complain(block, f"not JSON: {e}")

    def check_python(self, block, may_run):
        try:
            compile(block.text, self.file.name, "exec")
        except SyntaxError as e:
            self.complain(block, f"not Python: {e}")
            return
        if may_run and "file" not in block.marks:
            out, code = self.run(block, ["/usr/bin/python3", "-c", block.text])
            if code != 0:
                self.complain(block, f"ended with exit code {code} and printed\n{out}")

    def check_c(self, block, may_run):
        self.compile(block, ["gcc", "-std=c99", "-x", "c"], may_run)

    def check_cpp(self, block, may_run):
        self.compile(block, ["g++", "-std=c++20", "-x", "c++", "-I", str(self.sources)], may_run)

    def compile(self, block, compiler, may_run):
        if not may_run or "file" in block.marks:
            return
        command = [*compiler, "-Wall", "-Wextra", "-fsyntax-only", "-"]
        result = subprocess.run(
            command, cwd=self.folder, input=block.text, capture_output=True, text=True, check=False
        )
        self.ran += 1
        if result.returncode != 0:
            self.complain(block, f"does not compile:\n{result.stderr}")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("strut", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("sources", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("document", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("--fill", action="store_true")
    parser.add_argument("--only-check", action="store_true")
    parser.add_argument("--keep", type=lambda p: pathlib.Path(p).resolve())
    return parser.parse_args()


def main():
    args = parse_arguments()
    document = Document(args)
    document.check_prose()
    folder = args.keep or pathlib.Path(tempfile.mkdtemp(prefix="strut_docs_"))
    folder.mkdir(exist_ok=True)
    try:
        make_clone(folder, args.strut, args.sources)
        document.run_all(folder)
        if args.fill:
            document.write_filled()
    finally:
        if not args.keep:
            shutil.rmtree(folder, ignore_errors=True)
    print(f"{args.document.name}: {document.ran} of its snippets ran, {len(document.left_out)} did not")
    for line in document.left_out:
        print(f"not run: {line}")
    for line in document.wrong:
        print(line, file=sys.stderr)
    return 1 if document.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
