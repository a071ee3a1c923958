"""Errors of the package: the texts of the program, taken apart."""

from __future__ import annotations

import re

# "car.toml: front.spring.stiffness = -3 N/m: must lie in [1000, 200000] N/m"
_PARTS = re.compile(
    r"^(?:(?P<file>[^:=]+\.\w+)(?::\d+)?: )?(?:case \d+: )?"
    r"(?:(?P<key>[\w.,\[\]-]+)(?: = (?P<value>[^:]+))?: )?(?P<reason>.*)$",
    re.DOTALL,
)
# "unknown parameter 'front_stifness'; did you mean ..."
_UNKNOWN = re.compile(r"unknown \w+ '(?P<key>[^']+)'")
_ALLOWED = re.compile(r"(?:allowed: |must (?:lie|be) (?:in )?)(?P<allowed>.+)$", re.DOTALL)


class Error(Exception):
    """Base of all errors of this package."""


class InputError(Error, ValueError):
    """Invalid input: a file, a name, a value.

    Attributes, each a text or None where the message does not name it:
        file: the file at fault
        key: the key or parameter in it
        value: the value given, with its unit
        allowed: what is allowed instead
    """

    file: str | None
    key: str | None
    value: str | None
    allowed: str | None

    def __init__(self, text: str) -> None:
        super().__init__(text)
        parts = _PARTS.match(text)
        assert parts is not None
        self.file = parts["file"]
        unknown = _UNKNOWN.search(text)
        self.key = unknown["key"] if unknown else parts["key"]
        self.value = parts["value"]
        allowed = _ALLOWED.search(parts["reason"])
        self.allowed = allowed["allowed"] if allowed else None


class EnvironmentError(Error, OSError):  # noqa: A001: the name of the program's own
    """A failure of the system: disk full, folder not writable, file unreadable.

    Nothing that was complete before is lost.
    """

    def __init__(self, text: str) -> None:
        super().__init__(text)
