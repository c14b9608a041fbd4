"""The legs of those items that need nothing of the mission but where it stands."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, isfinite

from vehicle_sim.autopilot.control.demands import Situation
from vehicle_sim.autopilot.interface import PlanItem
from vehicle_sim.autopilot.mission.plan import Cmd
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.autopilot.rules import AutopilotRules
from vehicle_sim.autopilot.tasks.guided_limits import AwaitGuidance, GuidedLimits
from vehicle_sim.autopilot.tasks.legs import Go, GoAndLand, Leg
from vehicle_sim.autopilot.tasks.payload_place import PlacePayload
from vehicle_sim.numerics.vectors import Vec3

_PAYLOAD = frozenset({Cmd.GRIPPER, Cmd.WINCH})
PLACELESS = frozenset({Cmd.TAKEOFF, Cmd.DELAY, Cmd.GUIDED_ENABLE}) | _PAYLOAD
"""Those that do not turn the nose to a place."""


def waits_for_payload(item: PlanItem, rules: AutopilotRules) -> bool:
    """Whether the mission goes on only after a time, as in PX4."""
    return rules.payload_item_lasts is not None and item.command in _PAYLOAD


def leg_of(
    item: PlanItem,
    place: Vec3,
    goal: Vec3,
    s: Situation,
    parameters: Parameters,
    accept_m: float,
    guided_limits: Callable[[], GuidedLimits],
) -> Leg:
    """`place` is the item's own [m, NED], `goal` that of the item before."""
    match item.command:
        case Cmd.LAND:
            return GoAndLand(parameters, (place[0], place[1], s.stop_ned[2]))
        case Cmd.DELAY:
            return Go(goal, inf, item.p1)
        case Cmd.GRIPPER | Cmd.WINCH:
            # Nothing on board ever answers: PX4 waits for it so long.
            return Go(goal, inf, parameters.get(str(parameters.rules.payload_item_lasts)))
        case Cmd.GUIDED_ENABLE:
            begins = item.p1 > 0.0
            return AwaitGuidance(s.stop_ned, guided_limits) if begins else Go(goal, inf, 0.0)
        case Cmd.PAYLOAD_PLACE:
            return PlacePayload(parameters, place, item.p1)
        case Cmd.LOITER_UNLIM:
            return Go(place, accept_m, inf)
        case _:
            return Go(place, accept_m, seconds(item))


def seconds(item: PlanItem) -> float:
    """How long to stay: param 1."""
    return item.p1 if isfinite(item.p1) else 0.0
