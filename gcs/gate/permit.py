"""The paper that a moving frame must carry, and that only the gate can write.

The session encodes a motion frame from a `Permit` and from nothing else, so a goal that was
never verified has no way onto the wire (invariant 1).  The seal makes an accidental permit
impossible and a deliberate one visible in review: `issue` is called in `gcs/gate/machine/gate.py`
only, which a test holds.
"""

from __future__ import annotations

from dataclasses import dataclass

from gcs.frames import Vec3

_SEAL = object()


@dataclass(frozen=True, slots=True, init=False)
class Permit:
    """Leave for one frame: the verified position (None for a command without one) and yaw."""

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
    """For `gcs.gate.machine.gate` alone: leave to transmit this, now, because of `reason`."""
    return Permit(_SEAL, pos_ned, yaw_rad, now_ns, reason)
