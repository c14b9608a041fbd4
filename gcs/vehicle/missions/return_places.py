"""Where the vehicle's own return may end: at home, or at one of the rally points on board.

The gate clears a return by the ways to all of these places (`ReturnPlacesSeen`), so they are read
(`plan_on_board.py`) when a vehicle appears, and again whenever they may have changed; so they may
when a client sends RALLY_POINT, too, and they count in another way when the parameter RTL_TYPE has
another value (PX4).  While they are not known, a return is refused.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from gcs.gate.airspace.return_place import ReturnPlace
from gcs.gate.effects import Level
from gcs.gate.inputs import ReturnPlacesSeen
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Refusal
from gcs.plan.wire import WireItem
from gcs.protocol.effects import Address, Heard
from gcs.session.speedup_waits import Times
from gcs.session.work import GateInput, Log, Work
from gcs.vehicle.missions.jobs.facts import landings_on_board
from gcs.vehicle.missions.paths import bad_rally_points
from gcs.vehicle.missions.plan_on_board import PlanOnBoard
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import Cmd, MavFrame, MissionType
from gcs.wire.messages import RallyPoint

NODE = "link"
READING: Final = "its rally points are still being read (ask again in a second)"
HEIGHT: Final = "its return height is being read anew (ask again in a second)"
NO_ORIGIN: Final = "its origin is not known, so its rally points cannot be placed"
ON_BOARD: Final = "rally point on board"

JUDGED_TYPES: Final = frozenset({0, 5})
"""PX4's RTL_TYPE: straight to home or a rally point, or to a rally point only.  1 and 3 may lead to
the landing of the mission on board, 2 and 4 along that mission."""


class ReturnPlaces:
    """Reads the rally points of one vehicle, and tells its gate where a return may end."""

    def __init__(self, own: Address, times: Times, policy: Policy) -> None:
        self._policy = policy
        self.rally = PlanOnBoard(own, times, MissionType.RALLY)
        self._return_type: int | None = None
        self._told: ReturnPlacesSeen | None = None
        self._warned: frozenset[str] = frozenset()
        """The rally points on board, by name, of which it was told that they are outside."""

    def start(self, telemetry: Telemetry, *, busy: bool, now_ns: int) -> list[Work]:
        """The vehicle appeared: nothing is known of it.  `busy`: a job transfers a plan."""
        self._return_type = None
        self.rally.start(telemetry, now_ns)
        return [*self._tell(telemetry), *self.follow((), telemetry, busy=busy, now_ns=now_ns)]

    def follow(
        self, work: Iterable[Work], telemetry: Telemetry, *, busy: bool, now_ns: int
    ) -> list[Work]:
        """What the jobs send may change the rally points, or ask for them."""
        asked = self.rally.follow(work, telemetry, busy=busy, now_ns=now_ns)
        return [*self._tell(telemetry), *asked]

    def heard(self, heard: Heard, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """A mission message or parameter of the vehicle; before the jobs hear it."""
        work = self.rally.heard(heard, telemetry, now_ns)
        return [*work, *self._tell(telemetry)]

    def wake(self, telemetry: Telemetry, *, busy: bool, now_ns: int) -> list[Work]:
        work = self.rally.wake(telemetry, busy=busy, now_ns=now_ns)
        return [*work, *self._tell(telemetry)]

    def returns_by(self, return_type: int | None, telemetry: Telemetry) -> list[Work]:
        """PX4's RTL_TYPE; None: the vehicle says that it has none."""
        self._return_type = return_type or 0
        return self._tell(telemetry)

    def height_known(self, telemetry: Telemetry) -> list[Work]:
        """The vehicle has told its return height, and the gate was told."""
        return self._tell(telemetry)

    def placed(self, telemetry: Telemetry) -> list[Work]:
        """Home or the origin has changed."""
        return self._tell(telemetry) if self.rally.items else []

    def changed(self, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """They may be others from now on."""
        self.rally.changed(now_ns)
        return self._tell(telemetry)

    def _tell(self, telemetry: Telemetry) -> list[Work]:
        """The gate, where it is news."""
        if not telemetry.autopilot.commanded:
            return []
        seen = self._seen(telemetry)
        if seen == self._told:
            return []
        self._told = seen
        return [GateInput(seen), *_logged(seen), *self._outside(telemetry)]

    def _outside(self, telemetry: Telemetry) -> list[Work]:
        """Said once of each rally point where the policy lets nobody land: the vehicle's own
        failsafe may return there, which no ground station can stop."""
        items = self.rally.items
        if not items:
            self._warned = frozenset()
            return []
        if telemetry.origin is None or telemetry.home_ned is None:
            return []
        work: list[Work] = []
        for landing in landings_on_board(items, telemetry, ON_BOARD):
            for refusal in bad_rally_points((landing,), self._policy, telemetry):
                if landing.name not in self._warned:
                    self._warned |= {landing.name}
                    text = f"{refusal.sentence}; its own failsafe may land there"
                    work.append(Log(Level.WARNING, NODE, text))
        return work

    def _seen(self, telemetry: Telemetry) -> ReturnPlacesSeen:
        items = self.rally.items
        if items is None:
            return ReturnPlacesSeen(None, self.rally.failure or READING)
        if telemetry.return_void:
            return ReturnPlacesSeen(None, HEIGHT)
        if telemetry.autopilot.name == "px4":
            kind = self._return_type
            if kind is None:
                return ReturnPlacesSeen(None, "its RTL_TYPE is still being read")
            if kind not in JUDGED_TYPES:
                said = f"it returns as its RTL_TYPE {kind} says, by its mission or to its landing"
                return ReturnPlacesSeen(None, f"{said}, which is not judged")
        if items and (telemetry.origin is None or telemetry.home_ned is None):
            return ReturnPlacesSeen(None, NO_ORIGIN)
        landings = landings_on_board(items, telemetry)
        places = (ReturnPlace(each.name, each.ground_ned, each.over_up_m) for each in landings)
        return ReturnPlacesSeen(tuple(places))


def why_not_rally_point(policy: Policy, telemetry: Telemetry, point: RallyPoint) -> Refusal | None:
    """Why the vehicle must not have it on board; a client of an ArduPilot sends them one by one."""
    frame, place = MavFrame.GLOBAL_RELATIVE_ALT_INT, (point.lat, point.lng, float(point.alt))
    item = WireItem(0, frame, Cmd.NAV_RALLY_POINT, 0, 1, 0, 0, 0, 0, *place, MissionType.RALLY)
    landings = (
        replace(landing, name=f"rally point {point.idx + 1}")
        for landing in landings_on_board((item,), telemetry)
    )
    return next(iter(bad_rally_points(tuple(landings), policy, telemetry)), None)


def _logged(seen: ReturnPlacesSeen) -> list[Work]:
    """Said where it is not the usual."""
    if seen.places:
        names = ", ".join(each.name for each in seen.places)
        return [Log(Level.INFO, NODE, f"a return may end at home, {names}")]
    if seen.places is None and seen.unknown not in (READING, HEIGHT):
        return [Log(Level.WARNING, NODE, f"no return can be cleared: {seen.unknown}")]
    return []
