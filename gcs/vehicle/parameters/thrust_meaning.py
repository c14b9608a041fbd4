"""What a thrust beside an attitude means to a vehicle, by its own parameters.

PX4 1.14: the collective thrust, 0 to 1 (`mavlink_receiver.cpp`, fill_thrust); it hovers at
MPC_THR_HOVER.  ArduCopter 4.5 to 4.7 in GUIDED: a climb rate, up to WP_SPD_UP above 0.5 and up to
WP_SPD_DN below, unless GUID_OPTIONS has bit 3 (`GCS_Mavlink.cpp`,
handle_message_set_attitude_target).  Both from memory, but for the parameters' names and values.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

from gcs.gate.attitude import ClimbRate, HoverThrust, ThrustMeaning, UnknownThrust
from gcs.gate.inputs import StreamSeen
from gcs.protocol.autopilot import Autopilot
from gcs.protocol.parameter_names import names_of

HOVER: Final = "MPC_THR_HOVER"
OPTIONS: Final = "GUID_OPTIONS"
UP: Final = "WP_SPD_UP"
DOWN: Final = "WP_SPD_DN"
NAMES_OF_THRUST: Final[Mapping[str, tuple[str, ...]]] = {
    "px4": (HOVER,),
    "ardupilot": (OPTIONS, UP, DOWN),
}
"""By autopilot, the newest names of what is read for it."""
THRUST_AS_THRUST: Final = 8
"""GUID_OPTIONS, bit 3."""


def thrust_meaning(autopilot: Autopilot, parameters: Mapping[str, float]) -> ThrustMeaning:
    """`parameters` are those that the vehicle has told, under its own names."""
    told: dict[str, float] = {}
    for newest in NAMES_OF_THRUST.get(autopilot.name, ()):
        for name in names_of(newest):
            if name.name in parameters:
                told[newest] = parameters[name.name] * name.scale
        if newest not in told:
            return UnknownThrust(f"the vehicle has not told its {newest} yet")
    if HOVER in told:
        return HoverThrust(told[HOVER])
    if OPTIONS not in told:
        return UnknownThrust(f"what a thrust means to {autopilot.name} is not known here")
    if int(told[OPTIONS]) & THRUST_AS_THRUST:
        return UnknownThrust(
            f"{OPTIONS} has bit 3, so a thrust is a share of full thrust, and the share that this "
            "vehicle hovers at is not verified here; clear that bit"
        )
    return ClimbRate(abs(told[UP]), abs(told[DOWN]))


def with_thrust_meaning(
    given: StreamSeen, autopilot: Autopilot, parameters: Mapping[str, float]
) -> StreamSeen:
    """A sample with an attitude, and what its thrust means to this vehicle; others as they are."""
    if given.attitude is None:
        return given
    means = thrust_meaning(autopilot, parameters)
    return replace(given, attitude=replace(given.attitude, means=means))
