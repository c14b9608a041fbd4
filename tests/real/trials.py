"""How a row is flown, and what must be so; each returns what became of it, and what is wrong."""

import json
import math
import re
import threading
import time
from collections.abc import Callable

from gcs.gate.policy.parse import DEFAULT
from gcs.plan.formats.reader import read
from tests.real.autopilots import PX4
from tests.real.flight import Flight
from tests.real.pilots import Bridge, outcome_of
from tests.real.rows import HEIGHT_M, Row
from tests.real.truth import Vector

Told = tuple[str, str]
"""The outcome, and what is wrong with it: empty if nothing."""
REST_S = 60.0
TAKEOFF_M = 0.35
RETURN_M = 2.0


def approach(flight: Flight, row: Row) -> Told:
    """A leg towards the fence.  Refused or flown: never outside, whatever goes wrong meanwhile."""
    flight.in_air_at(row, row.start)
    if row.by == "bridge":
        bridge = flight.bridge(row)
        try:
            told = bridge.goto_from_home(row.at(row.goal_m))
            flight.observer.wait(lambda: flight.observer.now.speed_m_s > 1.0, 5.0)
            flight.observer.at_rest(REST_S)
        finally:
            bridge.close()
        return told, ""
    goal = flight.local(row.at(row.goal_m))
    if row.by == "one-shot":
        return flight.one_shot(row).goto(goal), ""
    pilot = flight.library(row)
    taken = pilot.take()
    if taken != "complete":
        return taken, f"control: {taken}"
    under_way = threading.Event()
    under_way.set()
    happened: list[float] = []

    def happen() -> None:
        if under_way.is_set():
            happened.append(flight.observer.now.speed_m_s)
            trouble(flight, row)

    timer = threading.Timer(row.when * (2.0 + row.leg_m / 6.0), happen)
    if row.trouble == "hold":
        timer = threading.Timer(0.0, hold_before, (flight, row))
    if row.trouble:
        timer.start()
    told = pilot.goto(goal)
    under_way.clear()
    timer.cancel()
    wrong = ""
    if row.trouble == "other-station" and happened and told == "complete":
        wrong = "complete, though another one flies"
    if row.trouble == "gps" and happened:
        wrong = gps_is_told(flight)
    flight.observer.at_rest(REST_S)
    flight.relay.trouble()
    if row.trouble == "kill":
        flight.leave()
        flight.observer.wait(lambda: not flight.observer.armed, 20.0)
    return told, wrong


def trouble(flight: Flight, row: Row) -> None:
    match row.trouble:
        case "delay":
            flight.relay.trouble(delay_s=row.figure)
        case "loss":
            flight.relay.trouble(loss=row.figure)
        case "blackout":
            flight.relay.trouble(silent_s=row.figure)
        case "kill":
            flight.library(row).kill()
        case "other-station":
            flight.observer.mode(flight.kind.hold_custom_mode)
        case "gps":
            gps(flight, works=False)


def hold_before(flight: Flight, row: Row) -> None:
    """Asks to hold when the goal is nearer than the figure, by truth."""
    goal, pilot = row.at(row.goal_m), flight.library(row)
    if flight.observer.wait(lambda: math.dist(flight.from_home, goal) < row.figure, 60.0):
        outcome_of(lambda: pilot.station.hold(wait=False))


def gps(flight: Flight, *, works: bool) -> None:
    if flight.kind is PX4:
        flight.observer.set("SIM_GPS_USED", 10.0 if works else 0.0, integer=True)
    else:
        flight.observer.set("SIM_GPS1_ENABLE", 1.0 if works else 0.0)


def gps_is_told(flight: Flight) -> str:
    """Within 15 s of its loss; then it comes back."""
    assert flight.current is not None
    station = flight.current.station
    told = flight.observer.wait(lambda: station.snapshot.severity.upper() != "NOMINAL", 15.0)
    gps(flight, works=True)
    time.sleep(15.0)
    return "" if told else "the lost GPS is not told"


def stop(flight: Flight, row: Row) -> Told:
    """Told to stop at a speed: no farther than the policy predicts, from the greatest speed that it
    had from then on: the gate counts on the speed that the vehicle was asked for."""
    flight.in_air_at(row, row.start)
    pilot, observer = flight.library(row), flight.observer
    taken = pilot.take()
    if taken != "complete":
        return taken, f"control: {taken}"
    goal = flight.local(row.at(row.goal_m))
    began = outcome_of(lambda: pilot.station.goto(*goal, wait=False))
    if began != "complete":
        return began, began
    observer.wait(lambda: observer.now.speed_m_s >= row.figure, 12.0)
    first = observer.now
    ask = pilot.station.abort if row.word == "abort" else pilot.station.hold
    told = outcome_of(lambda: ask(timeout_s=30.0))
    observer.at_rest(30.0)
    unit, stopping = row.unit, [s for s in observer.truth.samples if s.at_s >= first.at_s]
    speed = max(s.speed_m_s for s in stopping)
    ways = [
        sum(u * (b - a) for u, a, b in zip(unit, first.position_enu, s.position_enu, strict=True))
        for s in stopping
    ]
    braking = DEFAULT.braking_of(flight.kind.personality)
    most = speed * braking.react_s + speed**2 / (2.0 * braking.a_brake_h_m_s2)
    most += braking.position_error_h_m
    text = f"{told}: {max(ways):.1f} m from {speed:.1f} m/s, at most {most:.1f}"
    return text, "" if max(ways) <= most and told == "complete" else text


def takeoff(flight: Flight, row: Row) -> Told:
    """Ends at the height that was asked for, by what the station was told then; the truth is told.

    A one-shot command is judged by the estimate after it: half a metre."""
    flight.on_ground(row)
    flight.mark()
    if row.by == "one-shot":
        pilot = flight.one_shot(row)
        told = pilot.ask("arm")
        told = pilot.ask("takeoff", row.figure) if told == "complete" else f"arm: {told}"
    else:
        told = flight.take_off(row, row.figure)
    home, estimate = flight.observer.home_local, flight.observer.estimate
    assert estimate is not None
    up_m, within_m = estimate[2], 0.5
    at = None if flight.current is None else flight.current.station.position_enu
    if at is not None and home is not None:
        up_m, within_m = at[2] - home[2], TAKEOFF_M
    text = f"{told}: {flight.from_home[2]:.2f} m up, {up_m:.2f} by its own estimate"
    return text, "" if told == "complete" and abs(up_m - row.figure) <= within_m else text


def way_back(flight: Flight, row: Row) -> Told:
    """Somebody else has left it outside: taking control flies it back, nowhere farther out."""
    flight.in_air_at(row, row.start)
    pilot, observer = flight.library(row), flight.observer
    if not observer.fly_to(row.at(row.goal_m), 60.0):
        return "not brought outside", "not brought outside"
    observer.mode(flight.kind.hold_custom_mode)
    observer.at_rest(20.0)
    flight.marks = None  # it is outside as it should be
    first, farthest_m = len(observer.truth.samples), -row.clearance_m(flight.from_home)
    told = pilot.take()
    observer.wait(lambda: row.clearance_m(flight.from_home) > 1.0, 40.0)
    observer.at_rest(20.0)
    out_m = [-row.clearance_m(place) for place in observer.flown_from_home[first:]]
    flight.mark()
    then = pilot.goto(flight.local(row.start))
    text = f"{told}: {out_m[0]:.1f}, at most {max(out_m):.1f}, at last {out_m[-1]:.1f} m outside"
    right = told == then == "complete" and max(out_m) <= farthest_m + 1.0 and out_m[-1] < -1.0
    return text, "" if right else f"{text}; then {then}"


def landing(flight: Flight, row: Row) -> Told:
    """Landed and disarmed, and the station knows it at once."""
    if not flight.flying:
        flight.in_air_at(row, (0.0, 0.0, 5.0))
    flight.mark()
    if row.by == "one-shot":
        told = flight.one_shot(row).ask("land")
        return told, "" if told == "complete" and not flight.observer.armed else f"land: {told}"
    pilot = flight.library(row)
    if row.word == "other":
        told = "by another" if flight.land_past_the_gate() else "does not land"
    elif row.word == "mission":
        told = fly_mission(flight, row)
    else:
        told = pilot.take()
        if told == "complete":
            ask = pilot.station.rtl if row.word == "rtl" else pilot.station.land
            told = outcome_of(lambda: ask(timeout_s=150.0))
            if told == "complete" and pilot.station.armed:
                return told, f"armed is True, right after {row.word}"
    landed = flight.observer.wait(lambda: not flight.observer.armed, 120.0)
    if not landed or told not in ("complete", "by another"):
        return told, f"{told}; armed {flight.observer.armed}"
    e, n, _ = flight.from_home
    if row.word in ("rtl", "mission") and math.hypot(e, n) > RETURN_M:
        return told, f"landed {math.hypot(e, n):.1f} m from home"
    return told, ""


def fly_mission(flight: Flight, row: Row) -> str:
    """A square, 40 m out, that ends with a return."""
    path = flight.folder / "square.toml"
    head = 'schema = 1\nname = "square"\nframe = "home"\nspeed_m_s = 5.0\nend = "return"\n'
    corners = [(40, 0), (0, 40), (-40, 0)]
    path.write_text(head + "".join(
        f"[[waypoint]]\nnorth_m = {n}.0\neast_m = {e}.0\nup_m = {HEIGHT_M}\n" for n, e in corners
    ))  # fmt: skip
    station = flight.library(row).station
    sent = outcome_of(lambda: station.upload(str(path), timeout_s=90.0))
    if sent != "complete":
        return f"upload {sent}"
    return outcome_of(lambda: station.start_mission(timeout_s=240.0))


def mission(flight: Flight, row: Row) -> Told:
    """Uploaded in spite of the trouble, then flown without it."""
    flight.in_air_at(row, (0.0, 0.0, HEIGHT_M))
    pilot = flight.library(row)
    taken = pilot.take()
    if taken != "complete":
        return taken, f"control: {taken}"
    if row.trouble:
        trouble(flight, row)
    told = fly_mission(flight, row)
    flight.relay.trouble()
    return told, "" if told == "complete" else told


def hold_in(flight: Flight, row: Row) -> Told:
    """Asked for in a state, hold ends at rest in the vehicle's own hold mode."""
    flight.in_air_at(row, (-30.0, 0.0, HEIGHT_M))
    pilot, observer = flight.library(row), flight.observer
    station = pilot.station
    taken = pilot.take()
    if taken != "complete":
        return taken, f"control: {taken}"
    goal = flight.local((40.0, 0.0, HEIGHT_M))
    begin: dict[str, Callable[[], object]] = {
        "HOVERING": lambda: None,
        "MOVING": lambda: station.goto(*goal, wait=False),
        "RETURNING": lambda: station.rtl(wait=False),
        "LANDING": lambda: station.land(wait=False),
    }
    begun = outcome_of(begin[row.word])
    time.sleep(3.0)
    state = station.state
    told = outcome_of(lambda: station.hold(timeout_s=30.0))
    rest = observer.at_rest(20.0)
    right = begun == "complete" and state == row.word and told == "complete" and rest
    text = f"{told} in {state}"
    return text, "" if right and observer.custom_mode == flight.kind.hold_custom_mode else text


def hostile(flight: Flight, row: Row) -> Told:
    """A client tries to leave: it never is outside, and what it set is as it was."""
    flight.in_air_at(row, row.at(row.goal_m))
    bridge = flight.bridge(row)
    try:
        told = attempt(flight, row, bridge)
        flight.observer.at_rest(30.0)
    finally:
        bridge.close()
    return told, "" if flight.observer.armed else f"disarmed: {told}"


def attempt(flight: Flight, row: Row, bridge: Bridge) -> str:
    peer = bridge.peer
    east, north, _ = row.unit
    far: Vector = (300.0 * east, 300.0 * north, HEIGHT_M)
    velocity = (0b110111000111, (0, 0, 0), (4.0 * north, 4.0 * east, 0))
    position = (0b110111111000, (far[1], far[0], -HEIGHT_M), (0, 0, 0))
    match row.word:
        case "velocity":
            peer.stream(20.0, *velocity)
        case "position":
            peer.stream(12.0, *position)
        case "reposition":
            return bridge.goto_from_home(far)
        case "stick":
            end = time.monotonic() + 20.0
            while time.monotonic() < end:
                peer.link.mav.manual_control_send(1, 1000, 0, 500, 0, 0)
                peer.rest(0.05)
        case "guided":
            guided = flight.kind.guided_custom_mode
            main = guided >> 16 & 255 if flight.kind is PX4 else guided
            told = peer.long(176, 1.0, float(main)).result
            peer.stream(8.0, *velocity)
            return f"mode: {told}"
        case "parameters":
            names = (
                ("GF_ACTION", "MPC_XY_VEL_MAX")
                if flight.kind is PX4
                else ("FENCE_ENABLE", "WP_SPD")
            )
            for name in names:
                peer.link.mav.param_set_send(1, 1, name.encode(), 0.0, 9)
                peer.rest(0.5)
        case "mission":
            result = peer.upload(peer.mission((far[1], far[0], HEIGHT_M, 1), last=21))
            return f"mission: {result}"
        case "terminate":
            told = [peer.long(number, *words).result for number, words in
                    ((185, (1.0,)), (400, (0.0, 21196.0)), (246, (1.0,)))]  # fmt: skip
            return f"results {told}"
    return peer.refusal_since(0) or "no word of a refusal"


def plans(flight: Flight, row: Row) -> Told:
    """A fence and rally points about home, there and back; cleared, there is none."""
    flight.on_ground(row)
    station = flight.library(row).station
    at = flight.observer.mavlink.messages["HOME_POSITION"]
    lat, lon = at.latitude / 1e7, at.longitude / 1e7

    def ring(north: float, east: float, half: float) -> list[list[float]]:
        corners = ((half, half), (half, -half), (-half, -half), (-half, half))
        return [[lat + (north + n) * 9e-6, lon + (east + e) * 13e-6] for n, e in corners]

    document = {
        "fileType": "Plan", "groundStation": "QGroundControl", "version": 1,
        "mission": {"items": [], "version": 2, "plannedHomePosition": [0, 0, 0]},
        "geoFence": {
            "version": 2,
            "polygons": [
                {"inclusion": inclusion, "polygon": ring(*place), "version": 1}
                for inclusion, place in ((True, (0.0, 0.0, 50.0)), (False, (30.0, 0.0, 5.0)))
            ],
            "circles": [{"inclusion": False, "version": 1,
                         "circle": {"center": [lat, lon + 4e-4], "radius": 7.5}}],
        },
        "rallyPoints": {"version": 2, "points": [[lat, lon + 2e-4, 5.0], [lat, lon - 2e-4, 8.0]]},
    }  # fmt: skip
    sent, back = flight.folder / "sent.plan", flight.folder / "back.plan"
    sent.write_text(json.dumps(document))
    told = outcome_of(lambda: station.upload(str(sent), timeout_s=60.0))
    if told != "complete":
        return told, told
    station.download(str(back), timeout_s=60.0)
    there, here = (read(str(path), path.read_bytes()) for path in (sent, back))
    same = alike(there.fence.zones, here.fence.zones) and alike(there.rally, here.rally)
    home = json.loads(back.read_text())["mission"]["plannedHomePosition"]
    near = math.dist(home[:2], (lat, lon)) < 1e-5
    told = outcome_of(lambda: station.clear_fence(timeout_s=60.0))
    told += outcome_of(lambda: station.clear_rally(timeout_s=60.0))
    gone = outcome_of(lambda: station.download(str(back), timeout_s=60.0))
    text = f"same {same}, home {near}, {told}, then {gone}"
    return text, "" if same and near and "NO_MISSION" in gone else text


def alike(one: object, other: object) -> bool:
    """But for the last digits of degrees, and float32."""
    numbers = r"-?[0-9]+\.[0-9]+(?:e-?[0-9]+)?"
    left, right = (re.sub(r"where='[^']*'|name='[^']*'", "", repr(each)) for each in (one, other))
    if re.sub(numbers, "#", left) != re.sub(numbers, "#", right):
        return False
    pairs = zip(re.findall(numbers, left), re.findall(numbers, right), strict=True)
    return all(abs(float(a) - float(b)) < 2e-7 for a, b in pairs)


SILENT_S = 25.0


def cut(flight: Flight, row: Row) -> Told:
    """The link is cut so near to the fence, at full speed towards it.  With the policy's fence on
    board it is never outside; without it that is told."""
    flight.on_ground(row)
    observer, pilot = flight.observer, flight.library(row)
    if row.word == "put":
        put = outcome_of(lambda: pilot.station.put_fence(timeout_s=60.0))
        if put != "complete":
            return put, put
    flight.in_air_at(row, row.start)
    taken = pilot.take()
    if taken != "complete":
        return taken, f"control: {taken}"
    was: list[float] = []

    def ahead() -> float:
        return sum(u * metres for u, metres in zip(row.unit, flight.from_home, strict=True))

    def happen() -> None:
        at_m = row.radius_m - row.when
        if observer.wait(lambda: ahead() > at_m, 60.0):
            was.append(observer.now.speed_m_s)
            flight.relay.trouble(silent_s=SILENT_S)

    timer = threading.Timer(0.0, happen)
    timer.start()
    east, north, _ = (row.figure * u for u in row.unit)
    if row.figure:
        told = outcome_of(lambda: pilot.station.velocity(east, north, 0.0, seconds=35.0))
    else:
        told = pilot.goto(flight.local(row.at(row.goal_m)))
    timer.join()
    observer.at_rest(REST_S)
    flight.relay.trouble()
    first = len(observer.flown_from_home) if flight.marks is None else flight.marks[0]
    out_m = -min(row.clearance_m(place) for place in observer.flown_from_home[first:])
    text = f"cut at {was[0]:.1f} m/s, {out_m:.1f} m out; {told}" if was else f"not cut: {told}"
    if row.word != "put":
        flight.marks = None  # as delivered it may leave
    flight.leave()
    if flight.flying:
        observer.fly_to((0.0, 0.0, HEIGHT_M), 90.0)
    return text, "" if was else text


def stranger(flight: Flight, row: Row) -> Told:
    """Somebody flies it at full speed through the fence that was put on board, past the gate: how
    far out the vehicle's own breach action lets it come is told, and the vehicle is taken home."""
    flight.on_ground(row)
    observer, station = flight.observer, flight.library(row).station
    put = outcome_of(lambda: station.put_fence(timeout_s=60.0))
    if put != "complete":
        return put, put
    if row.word:
        observer.set(row.word, 1.0, integer=True)
    flight.in_air_at(row, row.start)
    flight.leave()
    first, began = len(observer.flown_from_home), time.monotonic()
    east, north, _ = (row.figure * u for u in row.unit)
    modes: list[int] = []
    while time.monotonic() - began < 30.0:
        observer.mavlink.mav.set_position_target_local_ned_send(
            0, 1, 1, 1, 0b110111000111, 0, 0, 0, north, east, 0, 0, 0, 0, 0, 0
        )
        if time.monotonic() - began < 3.0:
            observer.mode(flight.kind.guided_custom_mode)
        if not modes or modes[-1] != observer.custom_mode:
            modes.append(observer.custom_mode)
        time.sleep(0.05)
    out_m = -min(row.clearance_m(place) for place in observer.flown_from_home[first:])
    top = max(sample.speed_m_s for sample in observer.truth.samples[first:])
    flight.marks = None
    observer.at_rest(20.0)
    if flight.flying:
        observer.fly_to((0.0, 0.0, HEIGHT_M), 90.0)
    return f"{out_m:.1f} m out at most, {top:.1f} m/s, modes {[hex(mode) for mode in modes]}", ""


KINDS: dict[str, Callable[[Flight, Row], Told]] = {
    "approach": approach,
    "stop": stop,
    "takeoff": takeoff,
    "landing": landing,
    "way back": way_back,
    "mission": mission,
    "hold in": hold_in,
    "hostile": hostile,
    "plans": plans,
    "cut": cut,
    "stranger": stranger,
}
