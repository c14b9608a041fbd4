"""Writes parameters as MAVProxy, Mission Planner and QGroundControl read them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import PurePath
from typing import Final

from gcs.parameter_files.model import Entry
from gcs.parameter_files.reader import KINDS

FORMATS: Final = ("mavproxy", "mission-planner", "qgc")
SUFFIXES: Final[Mapping[str, str]] = {
    ".parm": "mavproxy",
    ".param": "mission-planner",
    ".params": "qgc",
}
"""What each of the three programs calls its own."""
_NUMBERS: Final = {kind: number for number, kind in KINDS.items()}


def format_of(path: str) -> str:
    """By its suffix; empty where that names none."""
    return SUFFIXES.get(PurePath(path).suffix.lower(), "")


def write(form: str, entries: Iterable[Entry], sysid: int, compid: int = 1) -> str:
    """All of the file, in the order of names."""
    ordered = sorted(entries, key=lambda each: each.name)
    return _WRITERS[form](ordered, sysid, compid)


def _mavproxy(entries: list[Entry], _sysid: int, _compid: int) -> str:
    return "".join(f"{each.name:<16} {each.text}\n" for each in entries)


def _mission_planner(entries: list[Entry], _sysid: int, _compid: int) -> str:
    return "".join(f"{each.name},{each.text}\n" for each in entries)


def _qgc(entries: list[Entry], sysid: int, compid: int) -> str:
    head = f"# Onboard parameters for Vehicle {sysid}\n#\n"
    head += "# Vehicle-Id Component-Id Name Value Type\n"
    return head + "".join(
        f"{sysid}\t{compid}\t{each.name}\t{each.text}\t{_NUMBERS.get(each.kind, 9)}\n"
        for each in entries
    )


_WRITERS: Final[Mapping[str, Callable[[list[Entry], int, int], str]]] = {
    "mavproxy": _mavproxy,
    "mission-planner": _mission_planner,
    "qgc": _qgc,
}
