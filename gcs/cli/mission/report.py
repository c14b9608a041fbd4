"""How plans and checks of them read: lines for people, JSON for scripts."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from gcs.cli.mission import fence_facts
from gcs.cli.mission.check import Checked
from gcs.cli.mission.route import Route
from gcs.cli.mission.route_text import route_lines
from gcs.enu_text import signed_enu
from gcs.exit_codes import ExitCode
from gcs.flight_report.number_format import clock
from gcs.frames import enu_from_ned
from gcs.plan import commands
from gcs.plan.errors import Finding, Level
from gcs.plan.flight_time import FlightTime
from gcs.plan.model import Circle, Frame, Geodetic, Geographic, Item, Local, Plan, Zone
from gcs.plan.parts import held
from gcs.plan.verify import LegVerdict, Verification

_LEVEL_WORDS = {Level.NOTE: "note", Level.WARNING: "warning", Level.ERROR: "error"}
_DATUMS = {
    Frame.AMSL: "AMSL",
    Frame.HOME: "above home",
    Frame.LOCAL: "above take-off",
    Frame.TERRAIN: "above terrain",
    Frame.MISSION: "",
}


# ----------------------------------------------------------------------------- check


def check_lines(checked: Checked) -> Iterator[str]:
    """Findings, then a line for every leg, then the verdict."""
    plan = checked.plan
    yield (
        f"{plan.source}: {plan.name}: {len(plan.items)} items, "
        f"for {checked.autopilot}, under policy {checked.policy.name}"
    )
    from_policy = _zones(len(checked.policy.fence))
    yield f"fence: {from_policy} from the policy, {len(plan.fence.zones)} from the file"
    for finding in checked.findings:
        yield from finding_lines(plan, finding)
    if checked.verification is None:
        for refusal in checked.bad_landings:
            yield f"  refused  {refusal.sentence}"
        yield f"verdict: {verdict(checked)}"
        return
    for leg in checked.verification.verdicts:
        yield _verdict_line(plan, leg)
    for problem in checked.verification.path.problems:
        yield f"  refused  {problem.sentence}"
    for landing in checked.verification.bad_landings:
        yield f"  refused  {landing.sentence}"
    if checked.verification.beyond_battery is not None:
        refusal = checked.verification.beyond_battery
        yield f"  refused  {refusal.code}: {refusal.sentence}"
    yield from _return_lines(checked.verification)
    yield f"verdict: {verdict(checked)}"


def against_it(checked: Checked) -> Iterator[str]:
    """Of the lines of a check those that are against flying it."""
    yield from (
        line for line in check_lines(checked) if line.startswith(("  refused", "error", "warning"))
    )


def _zones(count: int) -> str:
    return f"{count} zone" if count == 1 else f"{count} zones"


def finding_lines(plan: Plan, finding: Finding) -> Iterator[str]:
    place = f"{plan.source}:{finding.where}" if finding.where else plan.source
    yield f"{_LEVEL_WORDS[finding.level]}: {place}: {finding.item}: {finding.what}"
    if finding.hint:
        yield f"  hint: {finding.hint}"


def _verdict_line(plan: Plan, verdict: LegVerdict) -> str:
    answer = "clear  " if verdict.refusal is None else "refused"
    to = signed_enu(enu_from_ned(verdict.to_ned))
    what = f"circle of {verdict.radius_m:g} m about" if verdict.radius_m else f"{verdict.kind} to"
    line = f"  {answer}  {_told(plan, verdict.item)}: {what} {to}"
    if verdict.refusal is not None:
        line += f": {verdict.refusal.code}: {verdict.refusal.sentence}"
    return line


def _return_lines(verification: Verification) -> Iterator[str]:
    if verification.return_warning is not None:
        after, why = verification.return_warning
        yield f"warning: {after}:"
        yield f"  {why}"


def verdict(checked: Checked) -> str:
    """Whether it may be flown, in a few words."""
    verification = checked.verification
    if checked.exit_code is ExitCode.BAD_FILE:
        return "not to be flown as it is"
    if verification is None:
        return "refused by the gate" if checked.bad_landings else "there is no mission in it to fly"
    if checked.start_refusal is not None:
        return f"refused by the gate: {checked.start_refusal.sentence}"
    if verification.refusal is not None:
        return "refused by the gate"
    text = f"may be flown, {verification.path.length_m:.0f} m of path"
    flight = checked.flight
    if flight is None or not flight.whole:
        return f"{text}, for longer than a day"
    minutes, seconds = divmod(round(flight.time_s), 60)
    return f"{text}, about {minutes} min {seconds:02d} s in the air"


def _told(plan: Plan, index: int) -> str:
    return commands.item_label(index, plan.items[index].command)


def check_json(checked: Checked) -> str:
    """One object: findings, legs, verdict."""
    verification = checked.verification
    legs = [] if verification is None else [_leg_json(v) for v in verification.verdicts]
    problems = [landing.sentence for landing in checked.bad_landings]
    if verification is not None:
        problems += [problem.sentence for problem in verification.path.problems]
        problems += [landing.sentence for landing in verification.bad_landings]
        if verification.beyond_battery is not None:
            problems.append(verification.beyond_battery.sentence)
    document = {
        "file": checked.plan.source,
        "name": checked.plan.name,
        "autopilot": checked.autopilot,
        "policy": checked.policy.name,
        "home": _home_json(checked.home),
        "items": len(checked.plan.items),
        "findings": [finding_json(finding) for finding in checked.findings],
        "legs": legs,
        "problems": problems,
        "returns_blocked_after": (
            [] if verification is None else [b.item + 1 for b in verification.blocked_returns]
        ),
        "flight_s": _flight_s(checked.flight),
        "verdict": verdict(checked),
        "exit_code": int(checked.exit_code),
    }
    return json.dumps(document, indent=2, allow_nan=False)


def _flight_s(flight: FlightTime | None) -> float | None:
    """None where it has no end, or nothing flies."""
    return flight.time_s if flight is not None and flight.whole else None


def _home_json(home: Geodetic | None) -> list[float | None] | None:
    return None if home is None else [home.lat_deg, home.lon_deg, home.alt_amsl_m]


def finding_json(finding: Finding) -> dict[str, str | int | None]:
    return {
        "level": _LEVEL_WORDS[finding.level],
        "where": finding.where,
        "item": finding.item,
        "what": finding.what,
        "hint": finding.hint,
    }


def _leg_json(verdict: LegVerdict) -> dict[str, object]:
    refusal = verdict.refusal
    return {
        "item": verdict.item + 1,
        "kind": verdict.kind,
        "from_enu": list(enu_from_ned(verdict.from_ned)),
        "to_enu": list(enu_from_ned(verdict.to_ned)),
        "radius_m": verdict.radius_m,
        "cleared": refusal is None,
        "code": "" if refusal is None else str(refusal.code),
        "sentence": "" if refusal is None else refusal.sentence,
        "zone": "" if refusal is None else refusal.zone,
    }


def part_lines(checked: Checked) -> Iterator[str]:
    """Of a fence or rally points alone: findings, then the verdict."""
    plan = checked.plan
    if plan.source:
        yield f"{plan.source}: {', '.join(held(plan))}, for {checked.autopilot}"
    if not plan.rally:
        yield from fence_facts.lines(checked)
    for finding in checked.findings:
        yield from finding_lines(plan, finding)
    for refusal in checked.bad_landings:
        yield f"  refused  {refusal.code}: {refusal.sentence}"
    if plan.rally and checked.home is None:
        yield "note: not held against the policy, as home is not known: give --home LAT,LON,ALT"
    yield f"verdict: {_part_verdict(checked)}"


def _part_verdict(checked: Checked) -> str:
    return {
        ExitCode.DONE: "nothing is wrong with it",
        ExitCode.BAD_FILE: "not to be uploaded as it is",
    }.get(checked.exit_code, "refused by the policy")


def part_json(checked: Checked) -> str:
    """The same as one object."""
    plan = checked.plan
    document = {
        "file": plan.source,
        "autopilot": checked.autopilot,
        "policy": checked.policy.name,
        "home": _home_json(checked.home),
        "zones": len(plan.fence.zones),
        "rally_points": len(plan.rally),
        **({} if plan.rally else fence_facts.facts_json(checked)),
        "findings": [finding_json(finding) for finding in checked.findings],
        "problems": [landing.sentence for landing in checked.bad_landings],
        "verdict": _part_verdict(checked),
        "exit_code": int(checked.exit_code),
    }
    return json.dumps(document, indent=2, allow_nan=False)


# ------------------------------------------------------------------------------ show


def print_plan(plan: Plan, route: Route, *, ascii_only: bool) -> None:
    """A table of the items, one of the fence, the reader's notes, and the route as a picture."""
    console = Console(highlight=False)
    title = Text(f"{plan.name}  ({plan.source})", "italic")
    console.print(title, _items(plan, route) if plan.items else Text("no items"), sep="\n")
    if plan.fence.zones:
        fence = Table(title="fence", title_justify="left")
        for heading in ("#", "zone", "shape", "heights above home"):
            fence.add_column(heading, overflow="fold")
        for index, zone in enumerate(plan.fence.zones, start=1):
            stay = "stay inside" if zone.inclusion else "stay out"
            fence.add_row(str(index), stay, _shape(zone), _heights(zone))
        console.print(fence)
    for line in _facts(plan):
        console.print(line, markup=False)
    for drawn in route_lines(route, console.width, ascii_only=ascii_only):
        console.print(drawn)


def _items(plan: Plan, route: Route) -> Table:
    """One row an item; `id` only where a jump would not count the rows.

    `way` is the length of its legs, `after` when it is over for the first time.
    """
    numbered = any(item.do_jump_id != n for n, item in enumerate(plan.items, start=1))
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for heading in ("#", *(["id"] if numbered else []), "item"):
        table.add_column(heading, no_wrap=True)
    for heading in ("where", "height", "p1-p4"):
        table.add_column(heading)
    for heading in ("way", "after"):
        table.add_column(heading, no_wrap=True, justify="right")
    for index, item in enumerate(plan.items, start=1):
        params = " ".join("-" if math.isnan(p) else f"{p:g}" for p in item.params)
        numbers = (str(index), *([str(item.do_jump_id)] if numbered else []))
        name = commands.name(item.command)
        way_m, end_s = route.item_length_m(index), route.ends_s.get(index)
        table.add_row(
            *numbers,
            name,
            _position(item),
            _height(item),
            params,
            f"{way_m:.0f} m" if way_m else "",
            "" if end_s is None else clock(end_s).partition(".")[0],
        )
    return table


def _facts(plan: Plan) -> Iterator[str]:
    yield f"written for: {plan.firmware or 'any autopilot'}"
    if plan.home is not None:
        alt = plan.home.alt_amsl_m
        height = "height not known" if alt is None else f"{alt:g} m AMSL"
        yield f"planned home: {plan.home.lat_deg:.7f}, {plan.home.lon_deg:.7f}, {height}"
    for point in plan.rally:
        yield (
            f"rally point: {point.lat_deg:.7f}, {point.lon_deg:.7f}, "
            f"{point.alt_above_home_m:g} m above home"
        )
    for finding in plan.notes:
        yield from finding_lines(plan, finding)


def _position(item: Item) -> str:
    place = item.place
    if isinstance(place, Geographic):
        return "here" if place.here else f"{place.lat_deg:.7f}, {place.lon_deg:.7f}"
    if isinstance(place, Local):
        return f"E {place.east_m:+.2f} N {place.north_m:+.2f} m"
    plain = ["-" if math.isnan(p) else f"{p:g}" for p in place]
    return "" if set(plain) <= {"0", "-"} else "parameters 5-7: " + " ".join(plain)


def _height(item: Item) -> str:
    if isinstance(item.place, Geographic):
        alt_m = item.place.alt_m
        datum = _DATUMS[item.frame].removeprefix("above ")
        return "not set" if math.isnan(alt_m) else f"{alt_m:g} m {datum}"
    if isinstance(item.place, Local):
        return f"{item.place.up_m:g} m"
    return ""


def _shape(zone: Zone) -> str:
    if isinstance(zone.shape, Circle):
        return f"circle of {zone.shape.radius_m:g} m about {_point(zone.shape.centre)}"
    corners = "; ".join(_point(corner) for corner in zone.shape.corners)
    return f"polygon of {len(zone.shape.corners)} corners: {corners}"


def _point(point: tuple[float, float]) -> str:
    return f"{point[0]:.7g}, {point[1]:.7g}"


def _heights(zone: Zone) -> str:
    floor_m, ceiling_m = zone.floor_above_home_m, zone.ceiling_above_home_m
    if floor_m is None and ceiling_m is None:
        return "all"
    low = "any" if floor_m is None else f"{floor_m:g}"
    high = "any" if ceiling_m is None else f"{ceiling_m:g}"
    return f"{low} to {high} m"


def plan_json(plan: Plan, route: Route) -> str:
    """The plan as it was understood, and its route; what is not set is null."""
    items = [
        {
            "number": index,
            "do_jump_id": item.do_jump_id,
            "command": item.command,
            "name": commands.name(item.command),
            "datum": _DATUMS[item.frame],
            "params": [_number(p) for p in item.params],
            "place": {key: _number(value) for key, value in item.place._asdict().items()},
            "where": item.where,
        }
        for index, item in enumerate(plan.items, start=1)
    ]
    document = {
        "file": plan.source,
        "name": plan.name,
        "firmware": plan.firmware,
        "home": _home_json(plan.home),
        "items": items,
        "fence": [
            {"inclusion": zone.inclusion, "shape": _shape(zone), "heights": _heights(zone)}
            for zone in plan.fence.zones
        ],
        "rally": [[r.lat_deg, r.lon_deg, r.alt_above_home_m] for r in plan.rally],
        "notes": [finding_json(finding) for finding in plan.notes],
        "route": _route_json(route),
    }
    return json.dumps(document, indent=2, allow_nan=False)


def _route_json(route: Route) -> dict[str, object]:
    """Metres about home, east, north, up; `ends_s` by the number of the item."""
    return {
        "length_m": route.length_m,
        "climb_m": route.climb_m,
        "highest_m": route.highest_m,
        "farthest_m": route.farthest_m,
        "flight_s": _flight_s(route.flight),
        "battery": route.battery,
        "problems": list(route.problems),
        "ends_s": {str(number): time_s for number, time_s in route.ends_s.items()},
        "legs": [
            {
                "item": leg.item,
                "kind": leg.kind.value,
                "from_enu": list(leg.from_enu),
                "to_enu": list(leg.to_enu),
                "length_m": leg.length_m,
            }
            for leg in route.legs
        ],
    }


def _number(value: float) -> float | None:
    return None if math.isnan(value) else value
