"""The permit to send one frame that moves the vehicle.  Only the gate issues permits.

The session encodes such a frame from a `Permit` and from nothing else, so a position that was
not verified cannot be sent (invariant 1).  `Permit` cannot be constructed without the private
seal, and a test asserts that only `gcs/gate/machine/gate.py` calls `issue`.
"""

from __future__ import annotations

from dataclasses import dataclass

from gcs.frames import Vec3

_SEAL = object()


@dataclass(frozen=True, slots=True, init=False)
class Permit:
    """Permits one frame with this verified position (local NED, metres) and yaw (radians).

    `pos_ned` is None for a command; `yaw_rad` None leaves the heading to the autopilot.
    """

    pos_ned: Vec3 | None
    yaw_rad: float | None
    issued_ns: int
    reason: str

    def __init__(
        self,
        seal: object,
        pos_ned: Vec3 | None,
        yaw_rad: float | None,
        issued_ns: int,
        reason: str,
    ) -> None:
        if seal is not _SEAL:
            raise PermissionError("a permit is issued by the gate only")
        object.__setattr__(self, "pos_ned", pos_ned)
        object.__setattr__(self, "yaw_rad", yaw_rad)
        object.__setattr__(self, "issued_ns", issued_ns)
        object.__setattr__(self, "reason", reason)


def issue(pos_ned: Vec3 | None, yaw_rad: float | None, now_ns: int, reason: str) -> Permit:
    """Issue a permit.  To be called by `gcs.gate.machine.gate` only."""
    return Permit(_SEAL, pos_ned, yaw_rad, now_ns, reason)
