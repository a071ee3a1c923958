"""Calls of the program `strut`, for verbs that take minutes and whose results are JSON."""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
from collections.abc import Sequence
from typing import Any, Union

import numpy as np

from ._errors import EnvironmentError, InputError

Path = Union[str, "os.PathLike[str]"]

_INPUT, _ENVIRONMENT = 2, 3


def find_program() -> str:
    """Path of the program: $STRUT_PROGRAM, that of the same build or installation, or that of PATH."""
    named = os.environ.get("STRUT_PROGRAM")
    if named:
        if not os.access(named, os.X_OK) or os.path.isdir(named):
            raise EnvironmentError(f"STRUT_PROGRAM = {named}: is no program")
        return named
    package = pathlib.Path(__file__).resolve().parent
    candidates = []
    if (package.parents[1] / "CMakeCache.txt").is_file():  # BUILD/python/strut
        candidates.append(package.parents[1] / "strut")
    # PREFIX/lib/python3/dist-packages/strut, and others below a lib
    candidates += [folder.parent / "bin/strut" for folder in package.parents if folder.name == "lib"]
    for candidate in candidates:
        if candidate.is_file() and os.access(candidate, os.X_OK):
            return str(candidate)
    found = shutil.which("strut")
    if found is None:
        raise EnvironmentError("the program strut is not found; set STRUT_PROGRAM to its path")
    return found


def call(command: str, *operands: Path, **options: Any) -> dict[str, Any]:
    """Runs a command with --json and returns its result, with the keys of that JSON.

    Options are those of the program, with _ in place of -: True is a switch, None is left out, a tuple or
    list of numbers is joined by commas, any other list repeats the option, a dictionary repeats it as
    name=value.
    Raises InputError and EnvironmentError with the program's message. A negative result (exit code 1)
    is a result.
    """
    words = [find_program(), command, *(_format_path(o) for o in operands), "--json", "--quiet"]
    for name, value in options.items():
        flag = "--" + name.rstrip("_").replace("_", "-")
        if isinstance(value, (bool, np.bool_)) or value is None:
            words += [flag] if value else []
            continue
        if isinstance(value, dict):
            value = [f"{key}={_format(v)}" for key, v in value.items()]
        if isinstance(value, (np.ndarray, range)):
            value = list(value)
        is_list = isinstance(value, (list, tuple)) and not _is_numeric(value)
        for item in value if is_list else [value]:
            words += [flag, _format(item)]
    process = subprocess.Popen(
        words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        encoding="utf-8", errors="surrogateescape")
    try:
        out, messages = process.communicate()
    except BaseException:  # Ctrl-C, in whatever thread: the program must not outlive its caller
        process.terminate()
        process.communicate()
        raise
    text = "\n".join(line.removeprefix("strut: ") for line in messages.splitlines())
    if process.returncode == _INPUT:
        raise InputError(text)
    if process.returncode == _ENVIRONMENT:
        raise EnvironmentError(text)
    if process.returncode not in (0, 1):
        raise RuntimeError(f"strut {command} ended with exit code {process.returncode}: {text}")
    if not out.strip():
        raise RuntimeError(f"strut {command} printed no result: {text}")
    result: dict[str, Any] = json.loads(out)
    return result


def _format_path(path: Path) -> str:
    """A path that is no option, whatever it begins with."""
    text = os.fspath(path)
    return os.path.join(".", text) if text.startswith("-") else text


def _is_numeric(values: Sequence[object]) -> bool:
    return bool(values) and all(isinstance(v, (int, float, np.number)) for v in values)


def _format(value: Any) -> str:
    if isinstance(value, (list, tuple)):
        return ",".join(map(_format, value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if hasattr(value, "__fspath__"):
        return _format_path(value)
    return str(value)
