"""What PX4 stores and then does not start, by the order of the items.

PX4 acknowledges such a mission and checks it when it is on board.  It refuses to arm in mission
mode (recorded); one that was armed in another mode stands with its motors running until it disarms
by itself (vehicle-sim does so).

Recorded of PX4 1.14.3 (C8, C9c and C11 of `scenarios_px4.json`): CONDITION_DELAY and _DISTANCE, a
take-off after a waypoint ("takeoff is not the first waypoint item"), another take-off after a
take-off (of a VTOL there), a landing as the first item ("starts with landing").  From memory of its
FeasibilityChecker: it looks at the items in their order, not at the jumps.  That a take-off after a
delay or after a return is refused is taken from the same rule and was not recorded; the recorded
ArduCopter starts all of these.
"""

from __future__ import annotations

from collections.abc import Iterator

from gcs.plan.commands import FLOWN, KINDS
from gcs.plan.items import Flown, flown_as
from gcs.plan.model import AutopilotName, Plan
from gcs.wire.ids import Cmd


def never_starts(plan: Plan, autopilot: AutopilotName) -> Iterator[tuple[int, str]]:
    """Each item for which the mission is not started, into `Plan.items`, and why."""
    flown = 0
    for index, item in enumerate(plan.items):
        if flown_as(item.command, autopilot) is Flown.NEVER_STARTS:
            yield index, "it waits for a condition"
        if autopilot != "px4" or KINDS.get(item.command) not in FLOWN:
            continue
        if item.command == Cmd.NAV_TAKEOFF and flown:
            yield index, "a take-off must be the first item that is flown"
        elif item.command == Cmd.NAV_LAND and not flown:
            yield index, "a landing must not be the first item that is flown"
        flown += 1
