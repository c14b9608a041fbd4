"""The station as a client of a vehicle's own operator control, where the vehicle announces it.

A vehicle that has the protocol says once a second which ground station is in control
(CONTROL_STATUS, development.xml), and refuses the commands of all others (NOT_IN_CONTROL).  So the
station asks for control before it commands; it lets others take over, as its own operators do among
themselves, and gives control up when it leaves.  Pure.
"""

from __future__ import annotations

from typing import Final

from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd
from gcs.wire.messages import CommandLong, ControlStatus

TAKEOVER_ALLOWED: Final = 2
"""Of GCS_CONTROL_STATUS_FLAGS."""
AGAIN_NS: Final = 3_000_000_000
"""How long a request is given before another one: the least that who has it is asked for."""

_RELEASE, _REQUEST, _OTHERS_MAY_TAKE_OVER, _ASK_S = 0.0, 1.0, 1.0, 3.0


class VehicleControl:
    """One vehicle, as far as it says who is in control; `own` is the station."""

    def __init__(self, own: Address) -> None:
        self._own = own
        self._told: tuple[int, bool] | None = None
        """Who is in control (0: nobody), whether others may take over; None: it does not say."""
        self._asked_ns: int | None = None

    @property
    def another(self) -> bool:
        """Whether another station is in control."""
        return self._told is not None and self._told[0] not in (0, self._own.sysid)

    def heard(self, status: ControlStatus) -> str:
        """In words, where it is news; else empty."""
        owner, may_take = status.gcs_main, bool(status.flags & TAKEOVER_ALLOWED)
        if (owner, may_take) == self._told:
            return ""
        self._told = owner, may_take
        if owner == 0:
            return "no station is in control of the vehicle"
        if owner == self._own.sysid:
            return "the vehicle obeys this station"
        how = "lets others take over" if may_take else "has to give it up first"
        return f"station {owner} is in control of the vehicle, and {how}"

    def before_command(self, vehicle: Address, now_ns: int) -> CommandLong | None:
        """What is to be sent before a command; None where it obeys this station, or anybody."""
        if self._told is None or self._told[0] == self._own.sysid:
            return None
        if self._asked_ns is not None and now_ns - self._asked_ns < AGAIN_NS:
            return None
        self._asked_ns = now_ns
        return self._command(vehicle, _REQUEST)

    def release(self, vehicle: Address) -> CommandLong | None:
        """What is to be sent at the end; None where this station is not in control."""
        if self._told is None or self._told[0] != self._own.sysid:
            return None
        return self._command(vehicle, _RELEASE)

    def _command(self, vehicle: Address, wish: float) -> CommandLong:
        return CommandLong(
            param1=wish,
            param2=_OTHERS_MAY_TAKE_OVER,
            param3=_ASK_S,
            param4=0.0,
            param5=0.0,
            param6=0.0,
            param7=0.0,
            command=Cmd.REQUEST_OPERATOR_CONTROL,
            target_system=vehicle.sysid,
            target_component=vehicle.compid,
            confirmation=0,
        )
