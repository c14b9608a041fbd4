"""STATUSTEXT as each autopilot words the end of it."""

from __future__ import annotations

import re
from typing import Final

from vehicle_sim.autopilot.interface import StatusText
from vehicle_sim.services.profile import Profile
from vehicle_sim.wire import messages as m

STATUSTEXT_CHARS: Final = 50
_BARE: Final = ("[cal] ", "Preflight Fail: ", "motion, ", "ERROR: ")
"""What PX4 sends without its events interface: the recorded texts that have no TAB."""
_TABBED: Final = (
    "Preflight Fail: low battery",
    "Preflight Fail: No connection to the ground control station",
)


_FAILSAFE: Final = re.compile(r"Failsafe activated.*?(?: in (\d+) seconds)?")
"""Which failsafe acts, and how, PX4 1.14 says in its EVENT alone."""


def worded(profile: Profile, text: str) -> str:
    """PX4 ends with a TAB each text that it also sends as an EVENT, for clients to tell."""
    if not profile.events:
        return text
    failsafe = _FAILSAFE.fullmatch(text)
    if failsafe is not None:
        delay_s = failsafe[1]
        text = "Failsafe activated"
        text += f", entering Hold for {delay_s} seconds" if delay_s is not None else ""
    return text if text.startswith(_BARE) and text not in _TABBED else f"{text}\t"


def in_chunks(profile: Profile, event: StatusText, time_ns: int) -> list[m.Statustext]:
    """A text of any length: longer ones go out in chunks that share an id."""
    raw = worded(profile, event.text).encode("ascii", "replace")
    chunks = [raw[at : at + STATUSTEXT_CHARS] for at in range(0, len(raw), STATUSTEXT_CHARS)]
    text_id = time_ns // 1_000_000 % 0xFFFF + 1 if len(chunks) > 1 else 0
    return [
        m.Statustext(event.severity, chunk, text_id, number) for number, chunk in enumerate(chunks)
    ]


def status_text(profile: Profile, severity: int, text: str) -> m.Statustext:
    """A text that fits into one message."""
    return m.Statustext(severity, worded(profile, text).encode("ascii"), 0, 0)
