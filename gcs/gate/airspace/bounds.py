"""What every question is judged by: the fence as it is placed, home, and the policy's figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from gcs.frames import Vec3
from gcs.gate.airspace import limits
from gcs.gate.airspace.clearance import NO_MARGINS, Margins
from gcs.gate.airspace.fence_check import FenceCheck
from gcs.gate.airspace.zones import Zone
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal

LOCAL_ORIGIN: Final[Vec3] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Bounds:
    """One fence, home and autopilot.  Positions are local NED, in metres.

    `zones` is the whole fence in the local frame.  Where it is empty and the fence is on, the fence
    is not known yet: everything that moves is refused, and `unplaced` says why.
    """

    policy: Policy
    zones: tuple[Zone, ...]
    autopilot: str
    home_ned: Vec3 | None
    origin_known: bool
    fence_on: bool = True
    unplaced: Refusal | None = None

    @property
    def judge(self) -> FenceCheck:
        """Judges by the zones; by none where the fence is off."""
        zones = self.zones if self.fence_on else ()
        return FenceCheck(zones, self.policy, self.policy.braking_of(self.autopilot))

    @property
    def position_error(self) -> Margins:
        """By how much a reported position may be wrong."""
        b = self.policy.braking_of(self.autopilot)
        return Margins(b.position_error_h_m, b.position_error_v_m)

    def unusable(self, **values: Sequence[float]) -> Refusal | None:
        """NON_FINITE where a number is not finite, NO_ORIGIN where the fence is not known."""
        refusal = limits.not_finite({"home": self.home_ned or (), **values})
        if refusal is None and self.fence_on and not self.zones:
            return self.unplaced or Refusal(Code.NO_ORIGIN, "the fence is not known yet")
        return refusal

    def beyond_limits(
        self,
        subject: str,
        pos_ned: Vec3,
        *,
        allow: Margins = NO_MARGINS,
        floor_applies: bool = True,
    ) -> Refusal | None:
        """The policy's limits, counted from the local origin until home is known."""
        home_ned = self.home_ned or LOCAL_ORIGIN
        return limits.beyond_limits(
            self.policy, home_ned, subject, pos_ned, allow=allow, floor_applies=floor_applies
        )
