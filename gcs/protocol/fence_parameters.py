"""Which parameters make a vehicle keep a fence by itself, and what each must be: by autopilot.

Its circle and its ceiling are parameters, its other zones are uploaded (MISSION_TYPE_FENCE).  What
it does once setpoints are silent belongs to it: a vehicle that flies on for longer than the station
counted on is outside before its fence acts.

Meanings of values: parameter references of PX4 1.14 and ArduCopter 4.7.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

from gcs.protocol.lock_parameters import COPTER_FENCE_ON, HEIGHT_AND_CIRCLE, Wanted, bits_of

Breach: TypeAlias = Literal["hold", "return", "land", "terminate"]

GF_ACTION: Final[Mapping[Breach, float]] = {"hold": 2, "return": 3, "terminate": 4, "land": 5}
COPTER_ACTION: Final[Mapping[Breach, float]] = {"hold": 4, "return": 1, "land": 2, "terminate": 2}
"""FENCE_ACTION: brake, or land; return, or land; land.  ArduCopter terminates for no fence."""
ZONES: Final = 0b100
"""Of FENCE_TYPE: what is uploaded counts."""
ONE_IS_ENOUGH: Final = 0b10
"""Of FENCE_OPTIONS: to be in one of several zones to stay in will do."""
HOLDS_NO_PLACE: Final = frozenset({0, 1, 2})
"""COM_OBL_RC_ACT: position mode, which without sticks descends where it drifts to (recorded, PX4
1.14.3); altitude and manual mode."""
HOLD: Final = 5.0
"""COM_OBL_RC_ACT."""


TAKEN_OFF: Final[Mapping[str, tuple[str, ...]]] = {
    "px4": ("GF_MAX_HOR_DIST 0", "GF_MAX_VER_DIST 0"),
    "ardupilot": ("FENCE_ENABLE 0",),
}
"""What takes circle and ceiling off: no clearing of an uploaded fence does."""


@dataclass(frozen=True, slots=True)
class KeptFence:
    """A cylinder about home, in metres; whether there are uploaded zones beside it; what a breach
    leads to; and for how long setpoints may be silent before the vehicle stops."""

    reach_m: float
    ceiling_up_m: float
    zones: bool
    breach: Breach
    silent_s: float


def kept_by(autopilot: str, fence: KeptFence) -> tuple[Wanted, ...]:
    """In the order in which they are set: what switches something on comes last."""
    if autopilot == "px4":
        return (
            Wanted("GF_MAX_HOR_DIST", _is(fence.reach_m)),
            Wanted("GF_MAX_VER_DIST", _is(fence.ceiling_up_m)),
            Wanted("COM_OF_LOSS_T", _at_most(fence.silent_s)),
            Wanted("COM_OBL_RC_ACT", lambda is_now: HOLD if is_now in HOLDS_NO_PLACE else is_now),
            Wanted("GF_ACTION", _is(GF_ACTION[fence.breach])),
        )
    kinds = HEIGHT_AND_CIRCLE | (ZONES if fence.zones else 0)
    return (
        Wanted("FENCE_RADIUS", _is(fence.reach_m)),
        Wanted("FENCE_ALT_MAX", _is(fence.ceiling_up_m)),
        Wanted("FENCE_TYPE", lambda is_now: float(bits_of(is_now) | kinds)),
        Wanted("FENCE_OPTIONS", lambda is_now: float(bits_of(is_now) & ~ONE_IS_ENOUGH)),
        Wanted("GUID_TIMEOUT", _at_most(fence.silent_s)),
        Wanted("FENCE_ACTION", _is(COPTER_ACTION[fence.breach])),
        Wanted("FENCE_ENABLE", _is(COPTER_FENCE_ON)),
    )


def _is(value: float) -> Callable[[float], float]:
    return lambda _: float(value)


def _at_most(most: float) -> Callable[[float], float]:
    """A time that is there and no longer stays."""
    return lambda is_now: is_now if 0.0 < is_now <= most else most
