"""Random missions that the gate clears are flown in wind, and the truth is compared with the zones.

`python -m tests.loopback.random_missions px4 0 250` flies those of the seeds 0 to 249 and prints
how many were refused, and how near the nearest came; with `--alone` the vehicle flies what it was
given without the station, which takes a fifth of the time.  With `--through-bridge` a script of
pymavlink uploads, arms and starts it through the bridge; together with `--alone` nobody looks after
the vehicle from then on.  With `--price` the refused ones are put on board past the gate and flown,
too, to see how many would have stayed inside.  The fence is the policy's, so that the vehicle has
none of its own that could hold it back; shapely says where the truth is.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from msgspec import structs

from gcs.gate.policy.parse import DEFAULT
from gcs.report import DecisionItem
from tests.loopback.drawn_missions import Mission, mission_of, room_m, shape_of
from tests.loopback.flight import PERSONALITIES, Flight, Personality
from tests.loopback.plan_clients import NO_PLACE, items_of, rally_points
from tests.loopback.plan_clients import PlanItem as SentItem
from tests.loopback.pymavlink_script import ACCEPTED, ScriptFlight, VirtualLink
from vehicle_sim.autopilot.interface import PlanItem, Result
from vehicle_sim.simulation.fault_script import fault_of

LONGEST_S = 420.0
SAMPLE_S = 0.1
ENDINGS = ("mission_start", "mode")


@dataclass(frozen=True, slots=True)
class Flown:
    """`refusal` None: it was flown; `nearest_m` is the least distance to a forbidden place.

    Of a refused one that was flown past the gate it is what would have been.
    """

    seed: int
    refusal: str | None
    nearest_m: float = math.inf
    ended: str = ""
    kinds: frozenset[int] = frozenset()
    code: str = ""


class StartRefusedError(Exception):
    """What was cleared at its upload does not clear from where the vehicle is when it starts."""


def fly(
    seed: int,
    personality: Personality,
    *,
    alone: bool = False,
    through_bridge: bool = False,
    price: bool = False,
) -> Flown:
    """Verified by an upload; where it clears, flown to its end, `alone` without the station."""
    mission = mission_of(seed, personality)
    if through_bridge:
        found, flight, moments = _through_bridge(seed, personality, mission, alone)
    else:
        found, flight, moments = _by_the_operator(seed, personality, mission, alone)
    if found.refusal is None:
        try:
            return _flown(found, mission, flight, moments)
        except StartRefusedError as error:
            return replace(found, refusal=str(error), code="AT_START")
    if price:
        return _flown(found, mission, flight, _past_the_gate(flight, mission))
    return found


def _flown(found: Flown, mission: Mission, flight: Flight, moments: Iterator[str]) -> Flown:
    """In wind, to its end; how near the truth came to a forbidden place."""
    wind = {"wind_ned_m_s": [*mission.wind_ned, 0.0], "gust_m_s": 1.0}
    assert flight.world.inject(fault_of("wind", wind, "script"), 1)
    shapes = [(zone, shape_of(zone)) for zone in mission.zones]
    nearest_m, ended = math.inf, ""
    for told in moments:
        ended = told
        truth = flight.truth_enu()
        nearest_m = min(nearest_m, *(room_m(zone, shape, truth) for zone, shape in shapes))
    return replace(found, nearest_m=nearest_m, ended=ended)


# ------------------------------------------------------------------------------ by whom


def _by_the_operator(
    seed: int, personality: Personality, mission: Mission, alone: bool
) -> tuple[Flown, Flight, Iterator[str]]:
    flight = Flight(personality, seed=seed, policy=mission.policy, params=mission.params)
    flight.connected()
    with TemporaryDirectory() as folder:
        path = Path(folder) / "random.plan"
        path.write_text(json.dumps(mission.document), encoding="utf-8")
        ask = flight.say("mission_upload", path=str(path))
        ended = flight.done(ask)
    if ended == "complete":
        moments = _alone(flight) if alone else _with_station(flight)
        return Flown(seed, None, kinds=mission.kinds), flight, moments
    [verdict] = flight.verdicts(ask)
    refused = Flown(seed, verdict.sentence, kinds=mission.kinds, code=verdict.code)
    return refused, flight, iter(())


def _through_bridge(
    seed: int, personality: Personality, mission: Mission, alone: bool
) -> tuple[Flown, Flight, Iterator[str]]:
    """Uploaded, armed and started by a script of pymavlink."""
    rules = structs.replace(DEFAULT.bridge, rally="forward")
    policy = structs.replace(mission.policy, bridge=rules)
    flight = ScriptFlight(personality, seed=seed, policy=policy)
    for name, value in mission.params.items():
        flight.vehicle.parameters.set(name, value)
    script = flight.join_script()
    flight.connected()
    for items in (rally_points(mission.document), items_of(mission.document, personality)):
        if items and script.upload(items) != ACCEPTED:
            last = flight.decisions("refused")[-1]
            refused = Flown(seed, last.sentence, kinds=mission.kinds, code=last.code)
            return refused, flight, iter(())
    found = Flown(seed, None, kinds=mission.kinds)
    return found, flight, _with_script(flight, script, alone)


# ------------------------------------------------------------------------------ how


def _with_script(flight: ScriptFlight, script: VirtualLink, alone: bool) -> Iterator[str]:
    """Armed and started by the script, which from then on sends its heartbeat only."""
    assert script.arm() == ACCEPTED
    if script.start_mission() != ACCEPTED:
        raise StartRefusedError(flight.decisions("refused")[-1].sentence)
    script.deaf = True
    if alone:
        yield from _until_still(flight)
        return
    began_s, read = flight.elapsed_s, 0
    while flight.elapsed_s - began_s < LONGEST_S:
        script.beat()
        flight.run(SAMPLE_S)
        new = [item for _, item in flight.records[read:] if isinstance(item, DecisionItem)]
        read = len(flight.records)
        over = [one.outcome for one in new if one.phase == "ending" and one.word in ENDINGS]
        yield over[-1] if over else "still flying"
        if over:
            return


def _with_station(flight: Flight) -> Iterator[str]:
    """Armed and started through the gate; yields ten times a second how it goes."""
    flight.do("arm")
    ask = flight.say("mission_start")
    began_s = flight.elapsed_s
    while flight.outcome(ask) is None and flight.elapsed_s - began_s < LONGEST_S:
        flight.run(SAMPLE_S)
        yield flight.outcome(ask) or "still flying"


def _alone(flight: Flight) -> Iterator[str]:
    """The same by the vehicle itself."""
    vehicle = flight.vehicle
    if flight.personality == "ardupilot":
        assert vehicle.set_mode_kind("guided") is Result.ACCEPTED
    assert vehicle.arm(False) is Result.ACCEPTED
    assert vehicle.mission_start(0, 0) is Result.ACCEPTED
    yield from _until_still(flight)


def _past_the_gate(flight: Flight, mission: Mission) -> Iterator[str]:
    """What the gate refused is put on board by hand, and flown alone."""
    vehicle, personality = flight.vehicle, flight.personality
    vehicle.load_rally(on_board(rally_points(mission.document)))
    items = on_board(items_of(mission.document, personality))
    bad = vehicle.check_plan(items)
    if bad is not None:
        yield f"the vehicle would not take it: {bad}"
        return
    vehicle.load_plan(items)
    yield from _alone(flight)


def on_board(items: list[SentItem]) -> tuple[PlanItem, ...]:
    """As the vehicle keeps what is sent to it."""
    return tuple(
        PlanItem(
            seq,
            item.frame,
            item.command,
            *item.params,
            round(item.lat_deg * (1.0 if item.frame == NO_PLACE else 1e7)),
            round(item.lon_deg * (1.0 if item.frame == NO_PLACE else 1e7)),
            item.alt_m,
            1,
        )
        for seq, item in enumerate(items)
    )


def _until_still(flight: Flight) -> Iterator[str]:
    """The vehicle alone, until it is disarmed or has stood still in the air for 20 s."""
    vehicle = flight.vehicle
    still_s, was = 0.0, flight.truth_enu()
    for _ in range(round(LONGEST_S / SAMPLE_S)):
        for _ in range(round(250 * SAMPLE_S)):
            vehicle.step()
        here = flight.truth_enu()
        still_s = still_s + SAMPLE_S if math.dist(here, was) < 0.05 else 0.0
        was = here
        yield "still flying" if vehicle.armed else "complete"
        if not vehicle.armed or still_s > 20.0:
            return


# ------------------------------------------------------------------------------ the program


def _told(found: Flown) -> str:
    how = f"{found.ended}, nearest {found.nearest_m:.2f} m"
    if found.refusal is None:
        return how
    flown = f" | would have been: {how}" if found.ended else ""
    return f"refused {found.code}: {found.refusal}{flown}"


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("personality", choices=PERSONALITIES)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int, help="not flown itself")
    parser.add_argument("--alone", action="store_true")
    parser.add_argument("--through-bridge", action="store_true")
    parser.add_argument("--price", action="store_true")
    asked = parser.parse_args()
    flown: list[Flown] = []
    for seed in range(asked.first, asked.last):
        found = fly(
            seed,
            asked.personality,
            alone=asked.alone,
            through_bridge=asked.through_bridge,
            price=asked.price,
        )
        flown.append(found)
        print(f"{asked.personality} {seed}: {_told(found)}", flush=True)
    away = [one for one in flown if one.refusal is None]
    near = [one.nearest_m for one in away]
    print(
        f"{asked.personality}: {len(flown)} missions, {len(flown) - len(away)} refused, "
        f"{len(away)} flown; nearest {min(near, default=math.inf):.2f} m, "
        f"outside {sum(nearest_m < 0.0 for nearest_m in near)}"
    )
    if asked.price:
        would = [one.nearest_m for one in flown if one.refusal is not None and one.ended]
        inside = [nearest_m for nearest_m in would if nearest_m > 0.0]
        margin_m = DEFAULT.margin_h_m
        kept = sum(nearest_m >= margin_m for nearest_m in inside)
        print(
            f"{asked.personality}: of {len(would)} refused ones {len(inside)} would have stayed "
            f"inside, {kept} of them with the margin of {margin_m:g} m"
        )


if __name__ == "__main__":
    main()
