"""In what our vehicle is known to differ from the real ones: one file an autopilot.

The files are written by `python -m tests.scenarios --write`.  A test fails where a difference
comes that is not listed, and where a listed one is gone: then the list is written anew.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Final

from vehicle_sim.autopilot.modes import Personality

FOLDER: Final = Path(__file__).parent / "known_differences"


def write(personality: Personality, found: dict[str, list[str]]) -> None:
    FOLDER.mkdir(exist_ok=True)
    text = json.dumps({name: lines for name, lines in found.items() if lines}, indent=1)
    (FOLDER / f"{personality}.json").write_text(text + "\n", encoding="utf-8")


@cache
def known(personality: Personality) -> dict[str, list[str]]:
    told: dict[str, list[str]] = json.loads((FOLDER / f"{personality}.json").read_text("utf-8"))
    return told
