"""PX4's arm authorization: another system on the link is asked before the motors start.

COM_ARM_AUTH_REQ turns it on.  An `arm` that passes all other checks sends
MAV_CMD_ARM_AUTHORIZATION_REQUEST to the system COM_ARM_AUTH_ID, and what the authorizer answers by
COMMAND_ACK decides: method 0 keeps the `arm` waiting for it, method 1 refuses the first `arm` and
takes one that follows within the time granted.  After PX4's ArmAuthorization.cpp; that it is asked
last, that the time-out runs by the station's clock, and that COMMAND_ACK.progress is what PX4 calls
`result_param1`, are from memory.  As there, the ack may come from any system.
"""

from __future__ import annotations

from enum import Enum, IntEnum
from typing import Final

from vehicle_sim.autopilot.interface import CommandSent, Result, StatusText, VehicleEvent
from vehicle_sim.autopilot.parameters.parameters import Parameters

ARM_AUTHORIZATION_REQUEST: Final = 3001
_S_NS: Final = 1_000_000_000
_CRITICAL, _INFO = 2, 6  # MAV_SEVERITY


class Denied(IntEnum):
    """MAV_ARM_AUTH_DENIED_REASON."""

    GENERIC = 0
    NONE = 1
    INVALID_WAYPOINT = 2
    TIMEOUT = 3
    AIRSPACE_IN_USE = 4
    BAD_WEATHER = 5


_WHY: Final = {
    Denied.TIMEOUT: "Arm auth: Denied by timeout in authorizer",
    Denied.AIRSPACE_IN_USE: "Arm auth: Denied because airspace is in use",
    Denied.BAD_WEATHER: "Arm auth: Denied because of bad weather",
}
"""PX4's texts; of NONE it says nothing, since the authorizer tells the station itself."""


class Permission(Enum):
    """What an `arm` gets."""

    GRANTED = "granted"
    WAIT = "wait"
    REFUSED = "refused"


class ArmAuthorization:
    """Times are wall time.  `events` are for everybody who listens."""

    __slots__ = ("_granted_until_ns", "_parameters", "_waiting_until_ns", "events")

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters
        self.restart()

    def restart(self) -> None:
        """Power-up: nothing is asked, nothing granted."""
        self.events: list[VehicleEvent] = []
        self._waiting_until_ns: int | None = None
        self._granted_until_ns: int | None = None

    @property
    def waiting(self) -> bool:
        return self._waiting_until_ns is not None

    def ask(self, wall_ns: int) -> Permission:
        """An `arm` that nothing else speaks against."""
        get = self._parameters.get
        if get("COM_ARM_AUTH_REQ") == 0:
            return Permission.GRANTED
        if self._granted_until_ns is not None and wall_ns <= self._granted_until_ns:
            return Permission.GRANTED
        method = int(get("COM_ARM_AUTH_MET"))
        if not self.waiting:
            self._granted_until_ns = None
            self._waiting_until_ns = wall_ns + round(get("COM_ARM_AUTH_TO") * _S_NS)
            authorizer = int(get("COM_ARM_AUTH_ID"))
            self.events.append(CommandSent(ARM_AUTHORIZATION_REQUEST, 0.0, authorizer))
            if method == 1:
                self.events.append(StatusText(_INFO, "Arm auth: Requesting authorization..."))
        return Permission.WAIT if method == 0 else Permission.REFUSED

    def answered(self, result: int, param1: int, param2: int, wall_ns: int) -> Permission:
        """COMMAND_ACK of the authorizer: `param2` is the seconds granted, or the waypoint that is
        wrong; `param1` is the reason of a denial."""
        if not self.waiting or result == Result.IN_PROGRESS:
            return Permission.WAIT
        self._waiting_until_ns = None
        if result == Result.ACCEPTED:
            self._granted_until_ns = wall_ns + param2 * _S_NS
            text = f"Arm auth: Authorized for the next {param2} seconds"
            self.events.append(StatusText(_INFO, text))
            return Permission.GRANTED
        if result == Result.TEMPORARILY_REJECTED:
            self.events.append(StatusText(_CRITICAL, "Arm auth: Temporarily rejected"))
        elif param1 == Denied.INVALID_WAYPOINT:
            text = f"Arm auth: Denied, waypoint {param2} have a invalid value"
            self.events.append(StatusText(_CRITICAL, text))
        elif param1 != Denied.NONE:
            known = param1 in tuple(Denied)
            text = _WHY.get(Denied(param1), "") if known else ""
            self.events.append(StatusText(_CRITICAL, text or "Arm auth: Denied"))
        return Permission.REFUSED

    def timed_out(self, wall_ns: int) -> bool:
        """Whether the answer has just become too late."""
        if self._waiting_until_ns is None or wall_ns <= self._waiting_until_ns:
            return False
        self._waiting_until_ns = None
        self.events.append(StatusText(_CRITICAL, "Arm auth: No response"))
        return True
