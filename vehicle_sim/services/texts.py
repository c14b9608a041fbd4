"""STATUSTEXT as each autopilot words the end of it."""

from __future__ import annotations

from typing import Final

from vehicle_sim.services.profile import Profile
from vehicle_sim.wire import messages as m

_BARE: Final = ("[cal] ", "Preflight Fail: ", "motion, ", "ERROR: ")
"""What PX4 sends without its events interface: the recorded texts that have no TAB."""


def worded(profile: Profile, text: str) -> str:
    """PX4 ends with a TAB each text that it also sends as an EVENT, for clients to tell."""
    return f"{text}\t" if profile.name == "px4" and not text.startswith(_BARE) else text


def status_text(profile: Profile, severity: int, text: str) -> m.Statustext:
    """A text that fits into one message."""
    return m.Statustext(severity, worded(profile, text).encode("ascii"), 0, 0)
