"""The fence in flight: uploaded zones, limits by parameter, and what is breached now."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntFlag
from math import hypot, inf

from vehicle_sim.autopilot.fence.zones import Fence
from vehicle_sim.autopilot.interface import FenceState
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.numerics.vectors import Vec3

_AGAIN_M = 20.0  # AC_Fence: so far beyond a limit that was crossed lies the next one
_RECOVERY_NS = 10_000_000_000  # AC_Fence: a pilot who takes over is left alone so long


class BreachKind(IntFlag):
    """The fences that can be breached, with the bits of FENCE_TYPE."""

    NONE = 0
    ALT_MAX = 1
    CIRCLE = 2  # about home
    POLYGON = 4  # all that was uploaded
    ALT_MIN = 8


_NAMES = {
    BreachKind.ALT_MAX: "Max Alt",
    BreachKind.CIRCLE: "Circle",
    BreachKind.POLYGON: "Polygon",
    BreachKind.ALT_MIN: "Min Alt",
}


def names(kinds: BreachKind) -> str:
    """As ArduPilot says them: "Max Alt, Circle and Polygon fences"."""
    each = [name for kind, name in _NAMES.items() if kind in kinds]
    joined = ", ".join(each[:-1]) + " and " + each[-1] if len(each) > 1 else "".join(each)
    return f"{joined} fence" + ("s" if len(each) > 1 else "")


@dataclass(frozen=True, slots=True)
class FenceLimits:
    """What the parameters say: metres above home, and horizontally from it; infinite = none.

    `kinds` are those that are on, `zones` whether the uploaded ones are among them.
    """

    kinds: BreachKind
    top_up_m: float
    floor_up_m: float
    radius_m: float
    zones: bool
    margin_m: float = 0.0
    union: bool = False
    predict: bool = False


def _px4_limits(parameters: Parameters) -> FenceLimits:
    """PX4 counts a distance of 0 as no limit."""
    get = parameters.get
    top_m, radius_m = get("GF_MAX_VER_DIST"), get("GF_MAX_HOR_DIST")
    kinds = BreachKind.POLYGON
    kinds |= BreachKind.ALT_MAX if top_m > 0.0 else BreachKind.NONE
    kinds |= BreachKind.CIRCLE if radius_m > 0.0 else BreachKind.NONE
    return FenceLimits(
        kinds,
        top_m if top_m > 0.0 else inf,
        -inf,
        radius_m if radius_m > 0.0 else inf,
        zones=True,
        union=True,  # 1.14: one inclusion zone is enough
        predict=get("GF_PREDICT") != 0,
    )


def _copter_limits(parameters: Parameters) -> FenceLimits:
    """ArduCopter has a mask, and a switch for it all."""
    get = parameters.get
    kinds = BreachKind(int(get("FENCE_TYPE"))) if get("FENCE_ENABLE") != 0 else BreachKind.NONE
    return FenceLimits(
        kinds,
        get("FENCE_ALT_MAX") if BreachKind.ALT_MAX in kinds else inf,
        get("FENCE_ALT_MIN") if BreachKind.ALT_MIN in kinds else -inf,
        get("FENCE_RADIUS") if BreachKind.CIRCLE in kinds else inf,
        zones=BreachKind.POLYGON in kinds,
        margin_m=get("FENCE_MARGIN"),
        union=bool(int(get("FENCE_OPTIONS")) & 2),
    )


_LIMITS: dict[Personality, Callable[[Parameters], FenceLimits]] = {
    "px4": _px4_limits,
    "ardupilot": _copter_limits,
}


@dataclass(frozen=True, slots=True)
class Crossing:
    """What changed in one check.  `beyond_m`: how far outside the newly crossed limits it is."""

    breached: BreachKind
    cleared: BreachKind
    beyond_m: float


NOTHING = Crossing(BreachKind.NONE, BreachKind.NONE, 0.0)


class Geofence:
    """Checked at 10 Hz, armed or not; remembers what is breached since when."""

    __slots__ = (
        "_again",
        "_count",
        "_floor_barred",
        "_floor_on",
        "_idle",
        "_limits",
        "_parameters",
        "_room_m",
        "_seen_ne",
        "_since_ns",
        "_suspended_until_ns",
        "_version",
        "breached",
        "fence",
    )

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters
        self.load(Fence())
        self.forget()

    def load(self, fence: Fence) -> None:
        self.fence = fence
        self._version = -1
        self._room_m = 0.0

    def forget(self) -> None:
        """As after power-up; the uploaded zones stay."""
        self.breached = BreachKind.NONE
        self._count = 0
        self._since_ns = 0
        self._suspended_until_ns = 0
        self._floor_on = False
        self._floor_barred = False
        self._again: dict[BreachKind, float] = {}
        self._seen_ne = (0.0, 0.0)
        self._room_m = 0.0
        self._version = -1

    @property
    def limits(self) -> FenceLimits:
        if self._version != self._parameters.version:
            self._version = self._parameters.version
            self._limits = _LIMITS[self._parameters.personality](self._parameters)
            self._room_m = 0.0
            kinds = (
                self._limits.kinds if self.fence.zones else self._limits.kinds & ~BreachKind.POLYGON
            )
            self._idle = not kinds
        return self._limits

    @property
    def idle(self) -> bool:
        """Nothing is fenced."""
        return not self.limits.kinds or self._idle

    # --------------------------------------------------------------------------- checks

    def check(
        self, pos_ned: Vec3, stop_ned: Vec3, home_ned: Vec3, landing: bool, time_ns: int
    ) -> Crossing:
        """What is newly breached (or breached again, further out), and what no more.

        `stop_ned` is where it would come to rest; GF_PREDICT asks for that place too.  `landing`:
        on the ground or on its way there, where the floor does not count.
        """
        limits = self.limits
        if self.idle and not self.breached:
            return NOTHING
        beyond = self._outside(pos_ned, home_ned)
        if limits.predict:
            for kind, by_m in self._outside(stop_ned, home_ned).items():
                beyond.setdefault(kind, by_m)
        self._mind_floor(home_ned[2] - pos_ned[2], landing, beyond)
        if not beyond and not self.breached:
            return NOTHING
        now = BreachKind.NONE
        breached = BreachKind.NONE
        for kind, by_m in beyond.items():
            now |= kind
            if kind not in self.breached or by_m >= self._again.get(kind, inf):
                breached |= kind
                if kind is not BreachKind.POLYGON:
                    self._again[kind] = by_m + _AGAIN_M
        cleared = self.breached & ~now
        for kind in _NAMES:
            if kind in cleared:
                self._again.pop(kind, None)
        if breached:
            self._since_ns = self._since_ns if self.breached else time_ns
            self._count = min(self._count + breached.bit_count(), 65500)
        self.breached = now
        if time_ns < self._suspended_until_ns:
            breached = BreachKind.NONE
        hardest = max((by for kind, by in beyond.items() if kind in breached), default=0.0)
        return Crossing(breached, cleared, hardest)

    def _outside(self, pos_ned: Vec3, home_ned: Vec3) -> dict[BreachKind, float]:
        """The limits that this place is beyond, and by how many metres (0 for the polygons)."""
        limits = self.limits
        up_m = home_ned[2] - pos_ned[2]
        away_m = hypot(pos_ned[0] - home_ned[0], pos_ned[1] - home_ned[1])
        beyond: dict[BreachKind, float] = {}
        if up_m >= limits.top_up_m:
            beyond[BreachKind.ALT_MAX] = up_m - limits.top_up_m
        if up_m <= limits.floor_up_m:
            beyond[BreachKind.ALT_MIN] = limits.floor_up_m - up_m
        if away_m >= limits.radius_m:
            beyond[BreachKind.CIRCLE] = away_m - limits.radius_m
        if limits.zones and self._room(pos_ned) < 0.0:
            beyond[BreachKind.POLYGON] = 0.0
        return beyond

    def _room(self, pos_ned: Vec3) -> float:
        """Looks at the polygons anew only when the vehicle has come as far as it had room."""
        if not self.fence.zones:
            return inf
        n, e = pos_ned[0], pos_ned[1]
        moved_m = hypot(n - self._seen_ne[0], e - self._seen_ne[1])
        if moved_m >= abs(self._room_m):
            self._room_m = self.fence.room_m(n, e, self.limits.union)
            self._seen_ne = (n, e)
        return self._room_m

    def _mind_floor(self, up_m: float, landing: bool, beyond: dict[BreachKind, float]) -> None:
        """The floor counts once the vehicle has been above it, until it lands."""
        limits = self.limits
        if landing or self._floor_barred:
            self._floor_on = False
        elif up_m >= limits.floor_up_m + limits.margin_m:
            self._floor_on = True
        if not self._floor_on:
            beyond.pop(BreachKind.ALT_MIN, None)

    def bar_floor(self, barred: bool) -> None:
        """Whether the floor does not count, however high the vehicle is."""
        self._floor_barred = barred

    def beyond(self, pos_ned: Vec3, home_ned: Vec3) -> BreachKind:
        """The limits that a goal is beyond."""
        kinds = BreachKind.NONE
        for kind in self._outside(pos_ned, home_ned):
            kinds |= kind
        return kinds

    def allows(self, pos_ned: Vec3, home_ned: Vec3) -> bool:
        """Whether a goal lies within all that is fenced now."""
        return not self._outside(pos_ned, home_ned)

    def allows_ground(self, north_m: float, east_m: float, home_ned: Vec3) -> bool:
        """The same for a place to land at, whatever its height."""
        where = self._outside((north_m, east_m, home_ned[2]), home_ned)
        return not {BreachKind.CIRCLE, BreachKind.POLYGON} & where.keys()

    def taken_over(self, time_ns: int) -> None:
        """The operator flies out of a breach himself: no action for a while (ArduCopter)."""
        if self.breached and self._parameters.rules.pilot_suspends_fence:
            self._suspended_until_ns = time_ns + _RECOVERY_NS

    # --------------------------------------------------------------------------- report

    @property
    def state(self) -> FenceState:
        limits = self.limits
        present = limits.kinds if self.fence.zones else limits.kinds & ~BreachKind.POLYGON
        action = self._parameters.get(self._parameters.rules.fence_action)
        kind = 3 if self.breached & (BreachKind.CIRCLE | BreachKind.POLYGON) else 0  # BOUNDARY
        if not kind and BreachKind.ALT_MAX in self.breached:
            kind = 2  # MAXALT
        elif not kind and BreachKind.ALT_MIN in self.breached:
            kind = 1  # MINALT
        return FenceState(
            bool(present),
            bool(present) and action != 0,
            bool(self.breached),
            self._count,
            kind,
            self._since_ns,
        )

    def settings_error(self) -> str | None:
        """What of ArduCopter's own settings contradicts itself, in AC_Fence's words."""
        limits = self.limits
        parameters = self._parameters
        if not parameters.rules.checks_fence_settings or parameters.get("FENCE_ENABLE") == 0:
            return None
        if not limits.kinds:
            return "Fences enabled, but none selected"
        if limits.radius_m < limits.margin_m:
            return "Circle FENCE_MARGIN is less than FENCE_RADIUS"
        top_m, floor_m = parameters.get("FENCE_ALT_MAX"), parameters.get("FENCE_ALT_MIN")
        if top_m < floor_m:
            return "FENCE_ALT_MAX < FENCE_ALT_MIN"
        if top_m - floor_m <= 2.0 * limits.margin_m:
            return "FENCE_MARGIN too big"
        return None
