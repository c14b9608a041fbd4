"""Who is in control of a station and of its vehicle, in words."""

from __future__ import annotations

from gcs import ipc
from gcs.gate.states import State

YOU = "you"
NOBODY = "nobody"
PILOT = "the pilot"


def operator_words(operator: ipc.OperatorInfo | None, me: int, *, short: bool = False) -> str:
    """The operator in control of the station, for the one with the number `me`.

    `you`, `nobody`, `operator 2 (gcs attach, pid 4711)`; short: `operator 2`.
    """
    if operator is None:
        return NOBODY
    if operator.client == me:
        return YOU
    number = f"operator {operator.client}"
    return number if short else f"{number} ({operator.name})"


def control_words(seen: ipc.Snapshot, me: int, *, short: bool = False) -> str:
    """The same, and that the pilot flies: a vehicle in the air that is not under our control is
    in a mode that its pilot, or another ground station, has chosen."""
    operator = operator_words(seen.in_control, me, short=short)
    if seen.state != State.EXTERNAL.name:
        return operator
    return PILOT if short else f"{PILOT} or another station; of this station: {operator}"


def as_typed_now(command: str, seen: ipc.Snapshot | None, me: int) -> str:
    """A command that is hinted at, so that it is not refused while somebody else is in control."""
    other = seen is not None and seen.in_control is not None and seen.in_control.client != me
    return f"{command} --take" if other and "gcs param get" not in command else command


def change_words(before: ipc.OperatorInfo | None, now: ipc.OperatorInfo | None, me: int) -> str:
    """What a screen says when control of the station has passed to another operator; empty if it
    has not.  Going from nobody to this operator is no news to it: it asked for something."""
    was, is_ = before.client if before else 0, now.client if now else 0
    if was == is_ or (was == 0 and is_ == me):
        return ""
    who = operator_words(now, me)
    if was == me:
        return (
            f"CONTROL WENT TO {who}: you look on, and may abort, hold, land, return home; "
            "o takes it back"
        )
    return "you are in control of the station" if is_ == me else f"{who} is in control now"
