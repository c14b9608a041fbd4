"""What happened, and what went wrong first, in a sentence each."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from gcs.flight_report.findings.finding import CAUSE_WITHIN_S, Finding, Level, cause_of
from gcs.flight_report.flight import Flight, VehicleFlight
from gcs.flight_report.number_format import clock, count, duration, metres, sentence

_NAMES = {"px4": "PX4", "ardupilot": "ArduPilot"}
CONSEQUENCES_WITHIN_S = 15.0
MAX_CONSEQUENCES = 6


def vehicle_name(vehicle: VehicleFlight) -> str:
    """ "PX4 quadrotor"."""
    autopilot = _NAMES.get(vehicle.autopilot, "")
    return f"{autopilot} {vehicle.kind or 'vehicle'}".strip()


def what_happened(flight: Flight, vehicle: VehicleFlight | None) -> str:
    """One sentence about the flight itself."""
    if flight.messages == 0 and what_is_damaged(flight):
        return "No message of the record could be read."
    if flight.messages == 0:
        return "The record is empty: nothing was written into it."
    if vehicle is None:
        return f"No vehicle was heard in {duration(flight.seconds)} of record."
    name, totals = vehicle_name(vehicle), vehicle.totals
    if not totals.take_offs:
        if totals.first_armed_s is None:
            return f"The {name} was on the ground throughout, and never armed."
        return f"The {name} was armed for {duration(totals.armed_s)} and did not take off."
    away_from = "where the record begins" if totals.began_in_air else "it"
    parts = [f"The {name} flew for {duration(totals.flying_s)}"]
    if totals.max_up_m is not None and totals.max_distance_m is not None:
        parts.append(
            f"up to {metres(totals.max_up_m)} above {totals.up_from} "
            f"and {metres(totals.max_distance_m)} away from {away_from}"
        )
    if totals.take_offs > 1:
        parts.append(f"in {totals.take_offs} flights")
    end = "and landed" if totals.landed_s is not None else "and was in the air at the record's end"
    return f"{', '.join(parts)}, {end}."


def what_all_did(flight: Flight) -> str:
    """The same of each vehicle that the report is about, with their numbers where it is several."""
    shown = flight.shown_vehicles()
    if len(shown) < 2:
        return what_happened(flight, shown[0] if shown else None)
    return " ".join(f"Vehicle {each.sysid}: {what_happened(flight, each)}" for each in shown)


def lines_of(flight: Flight) -> Iterator[str]:
    """What the whole report comes to, for a terminal: of each vehicle that it is about what
    happened and what went wrong, then who else is in the record."""
    shown = flight.shown_vehicles()
    yield from filter(None, [what_is_damaged(flight)])
    if not shown:
        yield what_happened(flight, None)
    for vehicle in shown:
        name = f"Vehicle {vehicle.sysid}: " if len(shown) > 1 else ""
        yield f"{name}{what_happened(flight, vehicle)}"
        yield f"{name}{what_went_wrong(flight, vehicle)}"
        yield from filter(None, [what_was_before(vehicle)])
    others = other_vehicles(flight, shown)
    if others and len(shown) == 1:
        yield f"This is vehicle {shown[0].sysid}; --vehicle chooses another one."
    yield from (f"Also in the record: {line}" for line in others)


def what_is_damaged(flight: Flight) -> str:
    """One sentence: how much of the record could not be read; empty where all of it was."""
    parts = []
    if flight.damaged:
        parts.append(count(flight.damaged, "damaged record"))
    if flight.unread_bytes:
        parts.append(f"its last {count(flight.unread_bytes, 'byte')}")
    return f"The record is damaged: {' and '.join(parts)} could not be read." if parts else ""


def what_was_asked(vehicle: VehicleFlight) -> str:
    """One sentence about the requests; empty where there were none."""
    total = len(vehicle.requests) + vehicle.requests_left_out
    if not total:
        return ""
    refused = sum(request.outcome == "refused" for request in vehicle.requests)
    if not refused:
        return f"{count(total, 'request')}, none refused."
    return f"{count(total, 'request')}, {refused} of them refused."


def episodes(vehicle: VehicleFlight) -> list[list[Finding]]:
    """What went wrong in flight, or else before it, in pieces: in each one thing followed another
    within `CONSEQUENCES_WITHIN_S`.  Mild findings are left out where there are others."""
    armed_s = vehicle.totals.first_armed_s or 0.0
    troubles = [f for f in vehicle.went_wrong if f.t_s >= armed_s] or vehicle.went_wrong
    troubles = [f for f in troubles if not f.mild] or troubles
    pieces = [[finding] for finding in troubles[:1]]
    for before, finding in pairwise(troubles):
        if finding.t_s - before.t_s > CONSEQUENCES_WITHIN_S:
            pieces.append([])
        pieces[-1].append(finding)
    return pieces


def main_trouble(vehicle: VehicleFlight | None) -> Finding | None:
    """What the worst that went wrong began with: of the episodes the first critical one, else the
    first."""
    pieces = [] if vehicle is None else episodes(vehicle)
    if not pieces:
        return None
    critical = (each for each in pieces if any(f.level is Level.CRITICAL for f in each))
    return cause_of(next(critical, pieces[0]))


def consequences(vehicle: VehicleFlight, first: Finding) -> list[Finding]:
    """What else went wrong soon after it."""
    later = [
        finding
        for finding in vehicle.went_wrong
        if -CAUSE_WITHIN_S <= finding.t_s - first.t_s <= CONSEQUENCES_WITHIN_S
        and finding is not first
    ]
    return later[:MAX_CONSEQUENCES]


def what_was_before(vehicle: VehicleFlight | None) -> str:
    """One sentence: the first of what went wrong before the main trouble; empty: nothing did."""
    main = main_trouble(vehicle)
    if vehicle is None or main is None:
        return ""
    before = [f for f in vehicle.went_wrong if f.t_s < main.t_s - CAUSE_WITHIN_S]
    if not before:
        return ""
    more = f", and {len(before) - 1} more" if len(before) > 1 else ""
    detail = f" ({before[0].detail})" if before[0].detail else ""
    return f"Before it, at {clock(before[0].t_s)}: {before[0].title}{detail}{more}."


def what_went_wrong(flight: Flight, vehicle: VehicleFlight | None) -> str:
    """One sentence: the main trouble, with its time."""
    first = main_trouble(vehicle)
    if vehicle is None:
        return ""
    if first is None:
        looked = sum(check.level is not None for check in vehicle.checks)
        if not looked:
            return "Nothing is known of its health: the record has none of the values looked at."
        where = " in what could be read" if what_is_damaged(flight) else ""
        return f"Nothing went wrong{where}. Values that were looked at: {looked}, none of them bad."
    detail = f" ({first.detail})" if first.detail else ""
    return f"At {clock(first.t_s)} {first.title}{detail}."


def other_vehicles(flight: Flight, shown: list[VehicleFlight]) -> list[str]:
    """A line for each vehicle that this report is not about."""
    return [
        sentence(
            f"vehicle {sysid}: {vehicle_name(other)}, flew for {duration(other.totals.flying_s)}"
        )
        for sysid, other in sorted(flight.vehicles.items())
        if other not in shown
    ]
