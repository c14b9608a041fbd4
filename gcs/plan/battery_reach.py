"""Whether the battery lasts for a mission, its return and its landing.

The policy says for how long a full battery flies (`[battery] endurance_s`), and from where on it is
low: so much is kept.  The vehicle says how much is left.  How long the mission is in the air is
estimated in `flight_time.py`.
"""

from __future__ import annotations

from gcs.gate.policy.policy import BatteryLimits
from gcs.gate.refusal import Code, Refusal
from gcs.plan.commands import item_label
from gcs.plan.flight_time import DAY_S, FlightTime
from gcs.plan.model import Plan

_NOT_TOLD = (
    "the vehicle has not told how much charge its battery has left, so nobody knows whether it "
    "lasts for this mission (the policy's battery.endurance_s)"
)


def lasts_s(endurance_s: float, limits: BatteryLimits, battery_pct: float | None) -> float:
    """For how long it flies before it is low; a battery of which nothing is told, as a full one."""
    left_pct = 100.0 if battery_pct is None else battery_pct
    return endurance_s * max(0.0, left_pct - limits.low_pct) / 100.0


def battery_refusal(
    flight: FlightTime, plan: Plan, limits: BatteryLimits, battery_pct: float | None
) -> Refusal | None:
    """None where it lasts, or where the policy does not say for how long a full one flies."""
    if limits.endurance_s is None:
        return None
    if battery_pct is None:
        return Refusal(Code.BATTERY_REACH, _NOT_TOLD)
    most_s = lasts_s(limits.endurance_s, limits, battery_pct)
    if flight.whole and flight.time_s <= most_s:
        return None
    sentence = (
        f"{_what(flight, plan)}; the battery is low after {most_s:.0f} s: {battery_pct:.0f} % are "
        f"left of {limits.endurance_s:g} s, and {limits.low_pct:g} % are kept"
    )
    numbers = (
        ("flight_s", flight.time_s),
        ("battery_lasts_s", most_s),
        ("battery_pct", battery_pct),
    )
    return Refusal(Code.BATTERY_REACH, sentence, numbers)


def _what(flight: FlightTime, plan: Plan) -> str:
    time = "a day or more" if flight.time_s >= DAY_S else f"about {flight.time_s:.0f} s"
    if flight.whole:
        return f"the mission, its return and landing included, takes {time}"
    done = f"{_named(plan, flight.item)} is done only after {time}"
    if flight.endless is None:
        return done
    return f"{_named(plan, flight.endless)} repeats for ever, and {done}"


def _named(plan: Plan, index: int) -> str:
    return item_label(index, plan.items[index].command)
