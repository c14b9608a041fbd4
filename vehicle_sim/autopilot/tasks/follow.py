"""Following a leader: PX4's AUTO.FOLLOW_TARGET and ArduCopter's FOLLOW.

A leader is known by what it says of itself (FOLLOW_TARGET, or a vehicle's GLOBAL_POSITION_INT);
between two sightings it is thought to go straight on.  One that falls silent is no leader any
more: the follower stops where it is, and goes on when the leader speaks again.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import atan2, cos, exp, hypot, pi, radians, remainder, sin

from vehicle_sim.autopilot.control.demands import Demand, FlyTo, Situation, Turner
from vehicle_sim.autopilot.interface import Landed, Target
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.autopilot.tasks.tasks import distance, face
from vehicle_sim.control_loops.trajectory import slowed
from vehicle_sim.numerics.vectors import Vec3

_SILENT_NS = {"px4": 1_500_000_000, "ardupilot": 3_000_000_000}
_COURSE_M_S = 1.0  # slower than this a leader has no course
_ABOVE_LEADER = 2  # FLW_TGT_ALT_M
_NO_OFFSET_M = 0.01


@dataclass(frozen=True, slots=True)
class Sighting:
    """Where a leader was; `system` 0 = it did not say who it is (FOLLOW_TARGET)."""

    system: int
    pos_ned: Vec3
    v_ned: Vec3
    heading_rad: float | None
    wall_ns: int


class Leader:
    """The newest sighting of the one leader that is followed."""

    __slots__ = ("_parameters", "_seen")

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters
        self._seen: Sighting | None = None

    def heard(self, sighting: Sighting) -> None:
        """Another leader is heard only when the present one is silent."""
        if self._parameters.rules.leader_by_id:
            wanted = int(self._parameters.get("FOLL_SYSID"))
            if wanted and sighting.system != wanted:
                return
            known = self.seen(sighting.wall_ns)
            if not wanted and known is not None and known.system != sighting.system:
                return
        self._seen = sighting

    def seen(self, wall_ns: int) -> Sighting | None:
        """Where it is by now; None when there is no leader, or a silent one."""
        seen = self._seen
        if seen is None or wall_ns - seen.wall_ns > _SILENT_NS[self._parameters.personality]:
            return None
        age_s = (wall_ns - seen.wall_ns) * 1e-9
        (n, e, d), (v_n, v_e, v_d) = seen.pos_ned, seen.v_ned
        pos_ned = (n + v_n * age_s, e + v_e * age_s, d + v_d * age_s)
        return Sighting(seen.system, pos_ned, seen.v_ned, seen.heading_rad, seen.wall_ns)


class Follow(ABC):
    """Keeps its place by a leader; without one it stays where it stops."""

    landed_word = Landed.IN_AIR
    done = False

    __slots__ = ("_goal", "_hold", "_leader", "_parameters", "_time_ns")

    def __init__(self, parameters: Parameters, leader: Leader) -> None:
        self._parameters = parameters
        self._leader = leader
        self._hold: Vec3 | None = None
        self._goal: Vec3 | None = None
        self._time_ns = 0

    @property
    def target(self) -> Target:
        return Target(self._goal or self._hold, None, None)

    def lifts_off(self, s: Situation) -> bool:
        return False

    def begin(self, s: Situation, turner: Turner) -> None:
        self._hold = s.stop_ned
        self._goal = None
        self._time_ns = s.time_ns

    def update(self, s: Situation, turner: Turner) -> Demand:
        dt_s = (s.time_ns - self._time_ns) * 1e-9
        self._time_ns = s.time_ns
        lead = self._leader.seen(s.wall_ns)
        if lead is None or not self._near(lead, s):
            if self._goal is not None:
                self._goal, self._hold = None, s.stop_ned
            return FlyTo(self._hold or s.stop_ned, s.limits)
        self._goal, v_ned = self._place(lead, s, dt_s)
        self._point(lead, s, turner)
        v_ned = slowed(v_ned, s.limits, self._parameters.si(Quantity.FASTEST_M_S))
        return FlyTo(self._goal, s.limits, v_ned, straight=False, since_ns=s.time_ns)

    def _near(self, lead: Sighting, s: Situation) -> bool:
        """Whether the leader is near enough to be followed."""
        return True

    @abstractmethod
    def _place(self, lead: Sighting, s: Situation, dt_s: float) -> tuple[Vec3, Vec3]:
        """Where to be now [m, NED], and how fast that place moves [m/s, NED]."""

    def _point(self, lead: Sighting, s: Situation, turner: Turner) -> None:
        """Turn the nose."""
        face(lead.pos_ned, s, turner)


class Px4Follow(Follow):
    """AUTO.FOLLOW_TARGET: at an angle to the leader's course."""

    __slots__ = ("_angle_rad", "_course_rad", "_v_ned")

    def __init__(self, parameters: Parameters, leader: Leader) -> None:
        super().__init__(parameters, leader)
        self._v_ned: Vec3 = (0.0, 0.0, 0.0)
        self._course_rad: float | None = None
        self._angle_rad: float | None = None

    def begin(self, s: Situation, turner: Turner) -> None:
        super().begin(s, turner)
        self._angle_rad = None

    def _place(self, lead: Sighting, s: Situation, dt_s: float) -> tuple[Vec3, Vec3]:
        """FLW_TGT_DST from the leader, FLW_TGT_FA off its course, FLW_TGT_HT up.

        The place goes round the leader at FLW_TGT_MAX_VEL at most; FLW_TGT_RS smooths its speed.
        """
        get = self._parameters.get
        v_n, v_e, v_d = lead.v_ned
        keep = exp(-dt_s / get("FLW_TGT_RS")) if get("FLW_TGT_RS") > 0.0 else 0.0
        old = self._v_ned
        above_leader = get("FLW_TGT_ALT_M") == _ABOVE_LEADER
        v_d = v_d if above_leader else 0.0
        self._v_ned = (
            v_n + keep * (old[0] - v_n),
            v_e + keep * (old[1] - v_e),
            v_d + keep * (old[2] - v_d),
        )
        if hypot(v_n, v_e) > _COURSE_M_S or self._course_rad is None:
            here = atan2(s.pos_ned[1] - lead.pos_ned[1], s.pos_ned[0] - lead.pos_ned[0])
            still = remainder(here - radians(get("FLW_TGT_FA")), 2.0 * pi)
            moves = hypot(v_n, v_e) > _COURSE_M_S
            self._course_rad = atan2(v_e, v_n) if moves else still
        away_m = get("FLW_TGT_DST")
        wanted = self._course_rad + radians(get("FLW_TGT_FA"))
        if self._angle_rad is None:
            self._angle_rad = atan2(s.pos_ned[1] - lead.pos_ned[1], s.pos_ned[0] - lead.pos_ned[0])
        most = get("FLW_TGT_MAX_VEL") / away_m * dt_s
        turn = remainder(wanted - self._angle_rad, 2.0 * pi)
        self._angle_rad += min(most, max(-most, turn))
        floor_d = lead.pos_ned[2] if above_leader else s.home_ned[2]
        goal = (
            lead.pos_ned[0] + away_m * cos(self._angle_rad),
            lead.pos_ned[1] + away_m * sin(self._angle_rad),
            floor_d - get("FLW_TGT_HT"),
        )
        return goal, self._v_ned


class CopterFollow(Follow):
    """FOLLOW: at an offset from the leader."""

    __slots__ = ("_offset_ned",)

    def __init__(self, parameters: Parameters, leader: Leader) -> None:
        super().__init__(parameters, leader)
        self._offset_ned: Vec3 | None = None

    def begin(self, s: Situation, turner: Turner) -> None:
        super().begin(s, turner)
        self._offset_ned = None

    def _near(self, lead: Sighting, s: Situation) -> bool:
        return distance(lead.pos_ned, s.pos_ned) <= self._parameters.get("FOLL_DIST_MAX")

    def _place(self, lead: Sighting, s: Situation, dt_s: float) -> tuple[Vec3, Vec3]:
        """The leader's place and FOLL_OFS; without an offset the one at the beginning."""
        get = self._parameters.get
        x, y, z = get("FOLL_OFS_X"), get("FOLL_OFS_Y"), get("FOLL_OFS_Z")
        p = lead.pos_ned
        if abs(x) < _NO_OFFSET_M and abs(y) < _NO_OFFSET_M and abs(z) < _NO_OFFSET_M:
            if self._offset_ned is None:
                here = s.stop_ned
                self._offset_ned = (here[0] - p[0], here[1] - p[1], here[2] - p[2])
            x, y, z = self._offset_ned
        elif get("FOLL_OFS_TYPE") == 1 and lead.heading_rad is not None:
            c, sn = cos(lead.heading_rad), sin(lead.heading_rad)
            x, y = c * x - sn * y, sn * x + c * y
        return (p[0] + x, p[1] + y, p[2] + z), lead.v_ned

    def _point(self, lead: Sighting, s: Situation, turner: Turner) -> None:
        how = int(self._parameters.get("FOLL_YAW_BEHAVE"))
        if how == 1:
            face(lead.pos_ned, s, turner)
        elif how == 2 and lead.heading_rad is not None:
            turner.turn_to(lead.heading_rad)
        elif how == 3 and hypot(s.v_ned[0], s.v_ned[1]) > _COURSE_M_S:
            turner.turn_to(atan2(s.v_ned[1], s.v_ned[0]))


FOLLOW: dict[Personality, type[Px4Follow | CopterFollow]] = {
    "px4": Px4Follow,
    "ardupilot": CopterFollow,
}
