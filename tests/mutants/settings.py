"""Alterations of settings files: one number, switch or severity of a TOML file at a time."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from tests.mutants.mutant import Kind, Mutant
from tests.mutants.source import other_constant

_SECTION: Final = re.compile(r"\[+([\w.]+)\]+\s*$")
_PAIR: Final = re.compile(r"(\w+) = (-?\d+\.\d+|-?\d+|true|false|\"\w+\")(?=\s|$)")
_SCALES: Final = {"severities": ("nominal", "caution", "hold", "return", "land", "terminate")}
"""Sections whose values are words of one scale: each becomes the next."""


def settings_mutants(path: Path, root: Path) -> list[Mutant]:
    """Every alteration of one file."""
    file = path.relative_to(root).as_posix()
    met: Counter[str] = Counter()
    mutants = []
    lines = path.read_text(encoding="utf-8").splitlines()
    for number, (line, section, name, before, after) in enumerate(_alterations(lines)):
        key = f"{file} {section}: {name} = {before} -> {after}"
        met[key] += 1
        mutants.append(
            Mutant(
                key if met[key] == 1 else f"{key} #{met[key]}",
                file,
                line + 1,
                Kind.SETTING,
                before,
                after,
                number,
                module="",
                names=(name,),
            )
        )
    return mutants


def altered_settings(path: Path, number: int) -> str:
    """The text of the file with its alteration of that number."""
    lines = path.read_text(encoding="utf-8").splitlines()
    line, _, name, before, after = list(_alterations(lines))[number]
    lines[line] = lines[line].replace(f"{name} = {before}", f"{name} = {after}", 1)
    return "\n".join(lines) + "\n"


def _alterations(lines: list[str]) -> Iterator[tuple[int, str, str, str, str]]:
    """Line index, section, key, value and other value."""
    section = "top"
    for i, line in enumerate(lines):
        if header := _SECTION.match(line):
            section = header[1]
        elif (pair := _PAIR.match(line)) and (other := _other(section, pair[2])):
            yield i, section, pair[1], pair[2], other


def _other(section: str, value: str) -> str:
    """ "" for a word that stands for itself."""
    if value.startswith('"'):
        scale = _SCALES.get(section, ())
        return f'"{scale[(scale.index(value[1:-1]) + 1) % len(scale)]}"' if scale else ""
    if value in ("true", "false"):
        return "false" if value == "true" else "true"
    number = float(value) if "." in value else int(value)
    return str(other_constant(number))
