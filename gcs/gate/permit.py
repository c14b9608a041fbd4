"""The permit to send one frame that moves the vehicle.  Only the gate issues permits.

The session encodes such a frame from a `Permit` and from nothing else, so a setpoint that was
not verified cannot be sent (invariant 1).  `Permit` cannot be constructed without the private
seal, and a test asserts that only `gcs/gate/machine/gate.py` calls `issue`.
"""

from __future__ import annotations

from dataclasses import dataclass

from gcs.frames import Vec3
from gcs.gate.attitude import Attitude

_SEAL = object()


@dataclass(frozen=True, slots=True, init=False)
class Permit:
    """Permits one frame with this verified setpoint, and nothing else.

    Local NED: `pos_ned` in metres, `v_ned` in metres per second, `a_ned` in metres per second
    squared, and all three None for a command and for an attitude.  Velocity, acceleration, yaw
    rate and attitude are of a client's stream only.  `yaw_rad` and `yaw_rate_rad_s` None leave the
    heading to the autopilot.
    """

    pos_ned: Vec3 | None
    yaw_rad: float | None
    issued_ns: int
    reason: str
    v_ned: Vec3 | None
    a_ned: Vec3 | None
    yaw_rate_rad_s: float | None
    attitude: Attitude | None

    def __init__(
        self,
        seal: object,
        pos_ned: Vec3 | None,
        yaw_rad: float | None,
        issued_ns: int,
        reason: str,
        v_ned: Vec3 | None = None,
        a_ned: Vec3 | None = None,
        yaw_rate_rad_s: float | None = None,
        attitude: Attitude | None = None,
    ) -> None:
        if seal is not _SEAL:
            raise PermissionError("a permit is issued by the gate only")
        object.__setattr__(self, "pos_ned", pos_ned)
        object.__setattr__(self, "yaw_rad", yaw_rad)
        object.__setattr__(self, "issued_ns", issued_ns)
        object.__setattr__(self, "reason", reason)
        object.__setattr__(self, "v_ned", v_ned)
        object.__setattr__(self, "a_ned", a_ned)
        object.__setattr__(self, "yaw_rate_rad_s", yaw_rate_rad_s)
        object.__setattr__(self, "attitude", attitude)


def issue(
    pos_ned: Vec3 | None,
    yaw_rad: float | None,
    now_ns: int,
    reason: str,
    *,
    v_ned: Vec3 | None = None,
    a_ned: Vec3 | None = None,
    yaw_rate_rad_s: float | None = None,
    attitude: Attitude | None = None,
) -> Permit:
    """Issue a permit.  To be called by `gcs.gate.machine.gate` only."""
    return Permit(_SEAL, pos_ned, yaw_rad, now_ns, reason, v_ned, a_ned, yaw_rate_rad_s, attitude)
