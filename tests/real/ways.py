"""The ways to go beside a goto, and what comes amid them: how a row is flown, what must be so."""

import math
import time
from collections.abc import Callable
from dataclasses import replace

from gcs import ipc
from gcs.operator.operation import Operation
from tests.real.flight import Flight
from tests.real.pilots import LEG_S, outcome_of
from tests.real.rows import EIGHT, HEIGHT_M, Row
from tests.real.trials import Told
from tests.real.truth import Vector

THERE_M = {"px4": 2.0, "arducopter": 1.0}
"""How far from where it was asked to go, by the truth: the estimate is off at both ends."""
TURNED_DEG = 10.0
"""The nose, by the truth."""
LEAST_ROOM_M = 1.0
"""A goal with less room to the fence is refused, whatever the rest of the policy."""


def go(flight: Flight, row: Row) -> Told:
    """One way to go, to a place inside or to one that must be refused; judged by the truth."""
    flight.in_air_at(row, row.start)
    observer, bearing_deg = flight.observer, math.degrees(math.atan2(row.unit[0], row.unit[1]))
    if row.word == "forward":
        told = ask(flight, row, "heading", bearing_deg)
        if told != "complete":
            return told, f"heading: {told}"
    here, first = flight.from_home, len(observer.flown_from_home)
    told = ask(flight, row, row.word, *numbers(flight, row))
    at_end = observer.now  # at once, as whoever asked goes on now
    if row.word == "speed" and told == "complete":
        told = ask(flight, row, "goto", *flight.local(row.at(row.goal_m)))
    observer.at_rest(20.0)
    flown, there = observer.flown_from_home[first:], flight.from_home
    speeds = [sample.speed_m_s for sample in observer.truth.samples[first:]]
    too_fast = row.word == "speed" and row.trouble == "most"
    if too_fast or row.clearance_m(row.at(row.goal_m)) < LEAST_ROOM_M:
        moved_m = math.dist(here, there)
        right = told.startswith("refused") and moved_m < THERE_M[flight.kind.name]
        return f"{told}; moved {moved_m:.1f} m", "" if right else f"not refused: {told}"
    goal = here if row.word == "heading" else row.at(row.goal_m)
    off_m = math.dist(there, goal)
    text, right = f"{told}: {off_m:.2f} m off", off_m <= THERE_M[flight.kind.name]
    match row.word:
        case "heading":
            off_deg = abs(turned_deg(row.figure, at_end.yaw_deg))
            later_deg = abs(turned_deg(row.figure, observer.now.yaw_deg))
            text += f", the nose {off_deg:.1f} deg off, at rest {later_deg:.1f}"
            right = right and off_deg <= TURNED_DEG
        case "speed":
            text += f", top {max(speeds):.1f} m/s"
            right = right and 0.6 * row.figure < max(speeds) < row.figure + 0.7
        case "orbit":
            text, right = round_it(flight, row, flown, at_end.yaw_deg)
            text = f"{told}: {text}"
    return text, "" if right and told == "complete" else text


def numbers(flight: Flight, row: Row) -> tuple[float, ...]:
    """What the word is told, so that it leads to the row's goal from where the vehicle is."""
    goal, here = row.at(row.goal_m), flight.from_home
    east, north, up = (there - at for there, at in zip(goal, here, strict=True))
    match row.word:
        case "move":
            return east, north, up
        case "forward":
            e, n, _ = row.unit
            return east * e + north * n, east * n - north * e, up
        case "goto-global":
            return *flight.observer.on_map(goal), goal[2]
        case "orbit":
            centre = flight.local(row.at(row.goal_m - abs(row.figure)))
            return row.figure, 2.0, 1.0, *centre
        case _:
            return (row.figure,)


def ask(flight: Flight, row: Row, word: str, *figures: float) -> str:
    """By whom the row says.  A speed holds as long as its station lives, so it goes through one."""
    pilot = flight.library(row) if row.by == "library" or row.word == "speed" else None
    if pilot is not None:
        taken = pilot.take()
        if taken != "complete":
            return f"control {taken}"
    if pilot is None:
        return flight.one_shot(row).ask(word, *figures)
    if row.by == "one-shot":
        told = flight.joined(row).ask(word, *figures)
        pilot.station.take_control()
        return told
    station = pilot.station
    if word == "orbit":
        radius_m, speed_m_s, turns, *centre = figures
        east, north, up = centre
        return outcome_of(
            lambda: station.orbit(
                radius_m, speed_m_s, (east, north, up), turns=turns, timeout_s=LEG_S
            )
        )
    method: Callable[..., Operation] = getattr(station, word.replace("-", "_"))
    return outcome_of(lambda: method(*figures, timeout_s=LEG_S))


def turned_deg(from_deg: float, to_deg: float) -> float:
    """From -180 to 180."""
    return (to_deg - from_deg + 180.0) % 360.0 - 180.0


def round_it(flight: Flight, row: Row, flown: list[Vector], yaw_deg: float) -> tuple[str, bool]:
    """How far beside its circle it was once there, how far round it came, and where its nose is."""
    east, north, _ = row.at(row.goal_m - abs(row.figure))
    radius_m, most_m = abs(row.figure), THERE_M[flight.kind.name]
    ways = [(e - east, n - north) for e, n, _ in flown]
    on_it = next((i for i, way in enumerate(ways) if abs(math.hypot(*way) - radius_m) < 0.5), 0)
    ways = ways[on_it::5]
    bearings = [math.degrees(math.atan2(*way)) for way in ways]
    round_deg = sum(map(turned_deg, bearings, bearings[1:])) * math.copysign(1.0, row.figure)
    beside_m = max(abs(math.hypot(*way) - radius_m) for way in ways)
    nose_deg = abs(turned_deg(bearings[-1] + 180.0, yaw_deg))
    text = f"{beside_m:.2f} m beside it, {round_deg:.0f} deg round, nose {nose_deg:.0f} deg off"
    return text, beside_m <= most_m and abs(round_deg - 360.0) < 30.0 and nose_deg < 30.0


NO_GOAL = ("takeoff", "rtl", "land")
GIVES_WAY = ("orbit", "parameters", "download")
"""What a goto may be given amid; amid legs where the policy's `retarget` is "replace".  A heading
is over, or is a leg that still turns."""


def amid(flight: Flight, row: Row) -> Told:
    """A goto that comes while something else is under way: one of the two is flown to its end, and
    the other one is over, or was refused as BUSY."""
    if row.word == "takeoff":
        flight.on_ground(row)
        flight.mark()
    else:
        flight.in_air_at(row, row.start)
    pilot, name = flight.library(row), flight.kind.name
    station = pilot.station
    if row.word == "takeoff":
        taken = outcome_of(lambda: station.arm(timeout_s=90.0))
    else:
        taken = pilot.take()
    if taken != "complete":
        return taken, f"before it: {taken}"
    far, aside = row.at(row.goal_m), replace(row, direction=EIGHT[EIGHT.index(row.direction) - 2])
    here = flight.from_home
    leg = (a - b for a, b in zip(far, here, strict=True))
    plan = str(flight.folder / f"{time.time_ns()}.plan")
    begin: dict[str, Callable[[], Operation]] = {
        "goto": lambda: station.goto(*flight.local(far), wait=False),
        "move": lambda: station.move(*leg, wait=False),
        "heading": lambda: station.heading(180.0, wait=False),
        "orbit": lambda: station.orbit(10.0, 2.0, turns=3.0, wait=False),
        "takeoff": lambda: station.takeoff(HEIGHT_M, wait=False),
        "rtl": lambda: station.rtl(wait=False),
        "land": lambda: station.land(wait=False),
        "parameters": lambda: station.request(ipc.Ask(0, "param_list"), wait=False),
        "download": lambda: station.download(plan, wait=False),
    }  # fmt: skip
    began: list[Operation] = []
    told = outcome_of(lambda: began.append(begin[row.word]()))
    if told != "complete":
        return told, f"{row.word}: {told}"
    time.sleep(row.when)
    speed_m_s, state = flight.observer.now.speed_m_s, station.state
    second = aside.at(row.goal_m)
    told = outcome_of(lambda: station.goto(*flight.local(second), timeout_s=LEG_S))
    first, goal = began[0], second
    if told != "complete":
        if row.word != "takeoff" and row.word in NO_GOAL:
            outcome_of(lambda: station.hold(timeout_s=30.0))
        outcome_of(lambda: first.wait(LEG_S))
        goal = here if row.word == "heading" else far
    flight.observer.at_rest(20.0)
    there = row.word in NO_GOAL or math.dist(flight.from_home, goal) < THERE_M[name]
    gives_way = row.word in GIVES_WAY or row.trouble == "replace"
    right: tuple[str, ...] = ("complete",) if gives_way else ("refused BUSY",)
    right = ("complete", "refused BUSY") if row.word == "heading" else right
    as_asked = told.startswith(right)
    text = f"{told} amid {row.word} ({state}, {speed_m_s:.1f} m/s), which is {first.state}"
    return text, "" if as_asked and there and first.state != "running" else text


KINDS: dict[str, Callable[[Flight, Row], Told]] = {"go": go, "amid": amid}
