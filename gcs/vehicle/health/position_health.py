"""How far the vehicle's position can be trusted: what its GPS and its estimator say of it.

A vehicle without GPS goes on to tell positions, by dead reckoning, and they are fresh and wrong:
a PX4 for 5 s and an ArduCopter for 8 s until their own failsafes act (recorded).  So a lost fix and
an estimator in trouble are conditions, and the policy says how bad they are.

Both count from when they were good for the first time, or while the vehicle is armed: a vehicle
that starts up is not in trouble, and one that never had a GPS may fly indoors.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from gcs.gate.condition import Condition
from gcs.session.work import GateInput, condition
from gcs.wire.ids import EkfFlag, EstimatorFlag, GpsFix, Sensor
from gcs.wire.messages import EkfStatusReport, EstimatorStatus, GpsRawInt, SysStatus

FIX_WORDS: Final = {
    GpsFix.FIX_TYPE_NO_GPS: "no GPS",
    GpsFix.FIX_TYPE_NO_FIX: "no fix",
    GpsFix.FIX_TYPE_2D_FIX: "2D fix",
    GpsFix.FIX_TYPE_3D_FIX: "3D fix",
    GpsFix.FIX_TYPE_DGPS: "DGPS fix",
    GpsFix.FIX_TYPE_RTK_FLOAT: "RTK float",
    GpsFix.FIX_TYPE_RTK_FIXED: "RTK fix",
    GpsFix.FIX_TYPE_STATIC: "static fix",
    GpsFix.FIX_TYPE_PPP: "PPP fix",
}
UNKNOWN_SATELLITES: Final = 255

GPS_SILENT_NS: Final = 3_000_000_000
"""A receiver that is gone is no longer reported at all (PX4, from memory); two a second are asked
for."""
WORST_RATIO: Final = 1.0
"""Of an innovation to what it may be: at 1 the estimator begins to reject a measurement (PX4's
ESTIMATOR_STATUS); ArduPilot's failsafe acts at 0.8 of its own measure (FS_EKF_THRESH)."""
WORST_ACCURACY_M: Final = 5.0
"""Horizontal; PX4's COM_POS_FS_EPH, at which its own position failsafe acts."""
REPORTS_THAT_COUNT: Final = 2
"""Trouble in one report alone may be a spike."""


@dataclass(slots=True)
class Gps:
    """The receiver; None is not known."""

    fix_type: int | None = None
    satellites: int | None = None
    accuracy_m: float | None = None
    seen_ns: int = 0
    awaited_ns: int = 0
    """Since when it is missed: the positions of the vehicle come all the time."""
    had_fix: bool = False
    fitted: bool = False
    """SYS_STATUS says that there is one, and that it is used."""

    @property
    def fixed(self) -> bool:
        return self.fix_type is not None and self.fix_type >= GpsFix.FIX_TYPE_3D_FIX

    @property
    def words(self) -> str:
        """ "3D fix, 10 satellites"; empty where nothing is known."""
        if self.fix_type is None:
            return ""
        fix = FIX_WORDS.get(GpsFix(self.fix_type)) if self.fix_type in _FIXES else None
        seen = "" if self.satellites is None else f", {self.satellites} satellites"
        return (fix or f"fix {self.fix_type}") + seen


_FIXES: Final = frozenset(int(fix) for fix in GpsFix)


@dataclass(slots=True)
class Estimator:
    """What flies the vehicle believes of its own position."""

    troubles: tuple[str, ...] = ()
    seen_ns: int = 0
    had_good: bool = False
    bad_in_a_row: int = 0
    accuracy_m: float | None = None
    """Horizontal, as ESTIMATOR_STATUS tells it."""

    @property
    def words(self) -> str:
        """ "ok", or what is wrong; empty where nothing is known."""
        if not self.seen_ns:
            return ""
        return "; ".join(self.troubles) or "ok"


@dataclass(slots=True)
class PositionHealth:
    """Both, of one vehicle."""

    gps: Gps
    estimator: Estimator

    @property
    def accuracy_h_m(self) -> float | None:
        """Horizontal accuracy in steps of a decimetre, the estimator's where it tells one."""
        accuracy_m = self.estimator.accuracy_m
        if accuracy_m is None:
            accuracy_m = self.gps.accuracy_m
        return None if accuracy_m is None else math.ceil(accuracy_m * 10.0) / 10.0

    def gps_raw(self, message: GpsRawInt, armed: bool, now_ns: int) -> Iterator[GateInput]:
        gps = self.gps
        if not gps.seen_ns:
            gps.had_fix = False  # what SYS_STATUS calls healthy need not be a fix
        gps.fix_type, gps.seen_ns = message.fix_type, now_ns
        satellites = message.satellites_visible
        gps.satellites = None if satellites == UNKNOWN_SATELLITES else satellites
        gps.accuracy_m = message.h_acc / 1e3 if message.h_acc and gps.fixed else None
        gps.had_fix |= gps.fixed
        counts = gps.had_fix or (armed and gps.fitted)
        yield condition(Condition.GPS_LOST, counts and not gps.fixed, gps.words)

    def gps_silent(self, silent_ns: int, now_ns: int, *, positions: bool) -> Iterator[GateInput]:
        """Once a second: the receiver is told of no more, though positions come.  Where none come
        (`positions`) it is the link, or the estimator, that something is wrong with."""
        gps = self.gps
        if not positions:
            gps.awaited_ns = now_ns
        awaited_ns = max(gps.seen_ns, gps.awaited_ns)
        if gps.had_fix and gps.seen_ns and now_ns - awaited_ns > silent_ns:
            yield condition(Condition.GPS_LOST, True, "the vehicle tells nothing of its GPS")

    def system_status(self, message: SysStatus, armed: bool) -> Iterator[GateInput]:
        """The health bits, where the messages that tell more do not come."""
        used = message.onboard_control_sensors_present & message.onboard_control_sensors_enabled
        healthy = message.onboard_control_sensors_health
        gps, estimator = self.gps, self.estimator
        gps.fitted = bool(used & Sensor.SENSOR_GPS)
        if not gps.seen_ns and gps.fitted:
            good = bool(healthy & Sensor.SENSOR_GPS)
            gps.had_fix |= good
            lost = not good and (gps.had_fix or armed)
            yield condition(Condition.GPS_LOST, lost, "the vehicle says that its GPS is unhealthy")
        if not estimator.seen_ns and used & Sensor.AHRS:
            good = bool(healthy & Sensor.AHRS)
            estimator.had_good |= good
            bad = not good and (estimator.had_good or armed)
            text = "the vehicle says that its attitude and position are unhealthy"
            yield condition(Condition.ESTIMATOR_UNRELIABLE, bad, text)

    def estimator_status(
        self, message: EstimatorStatus, armed: bool, now_ns: int
    ) -> Iterator[GateInput]:
        """PX4's."""
        accuracy_m = message.pos_horiz_accuracy
        self.estimator.accuracy_m = accuracy_m if math.isfinite(accuracy_m) else None
        troubles = [
            *_flag_troubles(message.flags),
            *_ratio_troubles(message.vel_ratio, message.pos_horiz_ratio, message.pos_vert_ratio),
        ]
        if message.flags & EstimatorFlag.GPS_GLITCH:
            troubles.append("GPS glitch")
        if message.flags & EstimatorFlag.ACCEL_ERROR:
            troubles.append("bad acceleration")
        if accuracy_m > WORST_ACCURACY_M:
            troubles.append(f"position known to {accuracy_m:.0f} m")
        yield from self._judge(troubles, armed, now_ns)

    def ekf_status(self, message: EkfStatusReport, armed: bool, now_ns: int) -> Iterator[GateInput]:
        """ArduPilot's."""
        troubles = [
            *_flag_troubles(message.flags),
            *_ratio_troubles(
                message.velocity_variance, message.pos_horiz_variance, message.pos_vert_variance
            ),
        ]
        if message.flags & EkfFlag.GPS_GLITCHING:
            troubles.append("GPS glitch")
        if message.flags & EkfFlag.UNINITIALIZED:
            troubles.append("not started")
        yield from self._judge(troubles, armed, now_ns)

    def _judge(self, troubles: list[str], armed: bool, now_ns: int) -> Iterator[GateInput]:
        estimator = self.estimator
        if not estimator.seen_ns:
            # SYS_STATUS calls ArduPilot's attitude healthy 20 s before there is a position.
            estimator.had_good = False
        estimator.troubles, estimator.seen_ns = tuple(troubles), now_ns
        estimator.had_good |= not troubles
        estimator.bad_in_a_row = estimator.bad_in_a_row + 1 if troubles else 0
        bad = estimator.bad_in_a_row >= REPORTS_THAT_COUNT and (estimator.had_good or armed)
        if bad or not troubles:
            yield condition(Condition.ESTIMATOR_UNRELIABLE, bad, "; ".join(troubles))


def _flag_troubles(flags: int) -> Iterator[str]:
    """The bits that both autopilots have, of a vehicle that flies by position."""
    if not flags & EstimatorFlag.ATTITUDE:
        yield "no attitude"
    if not flags & EstimatorFlag.VELOCITY_HORIZ:
        yield "no horizontal velocity"
    if not flags & (EstimatorFlag.POS_HORIZ_REL | EstimatorFlag.POS_HORIZ_ABS):
        yield "no horizontal position"
    if flags & EstimatorFlag.CONST_POS_MODE:
        yield "position is held constant"


def _ratio_troubles(velocity: float, horizontal: float, vertical: float) -> Iterator[str]:
    """Innovation ratios; NaN says that there is none."""
    named = (("velocity", velocity), ("position", horizontal), ("height", vertical))
    for name, ratio in named:
        if ratio >= WORST_RATIO:
            yield f"{name} disagrees with the sensors"
