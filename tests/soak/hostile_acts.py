"""What a hostile driver does: how a run begins, and the acts that it draws from."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

from gcs.frames import Vec3
from gcs.gate.airspace.mission_box import box_round
from gcs.gate.airspace.zones import Zone
from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind
from gcs.gate.geometry import Circle, Point
from gcs.gate.inputs import (
    AccuracySeen,
    CommandEnded,
    ConditionChanged,
    HeartbeatSeen,
    HomeSeen,
    LandedSeen,
    MessageSeen,
    MissionLoaded,
    MissionPathVerified,
    MissionSeen,
    OperatorLost,
    PhotoSeen,
    PositionSeen,
    StreamSeen,
    Tick,
    VerifierChanged,
)
from gcs.gate.policy.policy import Policy
from gcs.gate.requests import (
    Abort,
    Arm,
    BeginStream,
    Disarm,
    EndStream,
    GoTo,
    Hold,
    Land,
    Request,
    Resume,
    ReturnHome,
    SetMode,
    StartMission,
    SwitchFence,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.soak.hostile_counts import Seen
from tests.soak.hostile_letters import is_told_anything
from tests.soak.hostile_run import MS_NS, SECOND_NS, HostileRun
from tests.soak.point_mass import STILL

Act = Callable[[HostileRun], None]


def fly(seed: int, policy: Policy, *, seconds: float = 4.0, judged: bool = False) -> Seen:
    """Hostile run number `seed`.  Raises Broken."""
    run = HostileRun(seed, policy, judged=judged)
    dice = run.dice
    begin(run)
    steps, done = round(seconds * 50), 0
    while done < steps:
        dice.choice(ACTS)(run)
        more = min(dice.choice((0, 1, 5, 20, 60)), steps - done)
        for _ in range(more):
            run.step()
        done += more + 1
    comes_to_rest(run)
    run.until_tick()
    run.all_answered()
    run.seen.steps = run._steps
    run.seen.cells = run.gate.met
    return run.seen


def comes_to_rest(run: HostileRun) -> None:
    """The last stop is seen to its end."""
    if run.promised and run.vehicle.speed_m_s > 1.0:
        run.ask(run.dice.choice((Abort(), Hold(), Land())))
        for _ in range(600):
            run.step()
            if math.hypot(*run.vehicle.vel[:2]) < STILL or not run.promised:
                break


# ------------------------------------------------------------------------- beginnings


def begin(run: HostileRun) -> None:
    """Into some state: not heard, on the ground, flown by somebody, or under control."""
    dice, vehicle = run.dice, run.vehicle
    kind = dice.choice(("nothing", "ground", "armed", "external", *["control"] * 4))
    if dice.random() < 0.05:
        vehicle.cruise_m_s = vehicle.climb_m_s = 0.0  # it cannot move: everything takes too long
    if kind == "nothing":
        return
    if kind in ("external", "control"):
        hovers_at(run, place(dice, run.verifier().zones, run.policy))
    else:
        vehicle.armed = kind == "armed"
        run.connects()
        run.step()
    if kind == "external" and dice.random() < 0.5:
        somebody_flies(run)
    if kind == "control":
        run.ask(TakeControl())
        run.run(run.policy.control.stream_s + 0.3)


def hovers_at(run: HostileRun, place_ned: Vec3) -> None:
    """It hovers, in hold mode, and the gate has heard of it."""
    vehicle = run.vehicle
    vehicle.armed, vehicle.landed = True, LandedState.IN_AIR
    vehicle.pos, vehicle.mode = list(place_ned), FlightMode.HOLD
    run.connects()
    run.step()


def place(dice: random.Random, zones: tuple[Zone, ...], policy: Policy) -> Vec3:
    """Inside the first zone, mostly near its faces, at times at the margin to the micrometre."""
    zone = zones[0]
    room_v = policy.margin_v_m + policy.creep_m + 0.3
    low, high = max(zone.floor_up_m, policy.min_up_m), min(zone.ceiling_up_m, policy.max_up_m)
    up_m = dice.choice((low + room_v, high - room_v, dice.uniform(low + 0.8, high - 0.5)))
    east, north = edge_place(dice, zone, policy.margin_h_m)
    return (north, east, -max(0.5, up_m))


def edge_place(dice: random.Random, zone: Zone, margin_m: float) -> Point:
    inset_m = margin_m + dice.choice((1e-5, 0.01, 0.6, 1.0, 5.0, 20.0))
    shape = zone.shape
    if isinstance(shape, Circle):
        r_m = max(0.0, shape.radius_m - inset_m) * dice.choice((1.0, 1.0, dice.random()))
        turn = dice.uniform(0.0, math.tau)
        return (
            shape.centre_en[0] + r_m * math.cos(turn),
            shape.centre_en[1] + r_m * math.sin(turn),
        )
    (a, b), t = dice.choice(shape.edges), dice.random()
    length_m = math.dist(a, b)
    e, n = (b[0] - a[0]) / length_m, (b[1] - a[1]) / length_m
    for side in (1.0, -1.0):
        spot = (
            a[0] + t * (b[0] - a[0]) - side * n * inset_m,
            a[1] + t * (b[1] - a[1]) + side * e * inset_m,
        )
        if shape.contains(spot) == zone.inclusion:
            return spot
    return (0.0, 0.0)


# ------------------------------------------------------------------------------- acts


def _goal(run: HostileRun) -> Vec3:
    dice = run.dice
    zones = run.verifier().zones
    match dice.randrange(10):
        case 0:
            return dice.choice(((math.nan, 0.0, -5.0), (1500.0, 0.0, -5.0)))
        case 1:
            return (dice.uniform(-300, 300), dice.uniform(-300, 300), dice.uniform(-80, 5))
        case 2 | 3 | 4:
            x, y, z = run.vehicle.pos
            reach_m = dice.choice((0.0, 1.0, 8.0, 40.0))
            turn = dice.uniform(0.0, math.tau)
            return (x + reach_m * math.cos(turn), y + reach_m * math.sin(turn), z)
        case 5:
            zone = dice.choice(zones)
            east, north = edge_place(dice, zone, run.policy.margin_h_m)
            return (north, east, run.vehicle.pos[2])
        case _:
            return place(dice, zones, run.policy)


def goes(run: HostileRun) -> None:
    run.ask(GoTo(_goal(run), run.dice.choice((None, 0.5))))


def goes_twice(run: HostileRun) -> None:
    goes(run)
    goes(run)


def sensible(run: HostileRun) -> None:
    """What an operator who wants to get on would do."""
    dice = run.dice
    match run.gate.state:
        case State.GROUNDED:
            run.ask(TakeOff(dice.choice((2.0, 10.0, 25.0))) if run.vehicle.armed else Arm())
        case State.HOLDING | State.EXTERNAL:
            run.ask(dice.choice((Resume(), TakeControl())))
        case State.HOVERING:
            ask_station(run, dice.choice((GoTo(_goal(run)), TakePhoto(), StartMission(), Land())))
        case _:
            run.run(0.5)


def dashes(run: HostileRun) -> None:
    """At full speed towards a goal at the margin, and stopped where the stop is the longest."""
    dice, vehicle, policy = run.dice, run.vehicle, run.policy
    taken(run)
    if run.gate.state is not State.HOVERING:
        return
    zone = run.verifier().zones[0]
    east, north = edge_place(dice, zone, policy.margin_h_m)
    run.ask(GoTo((north, east, vehicle.pos[2])))
    late_m = dice.choice((0.0, 1.0, 3.0, 8.0))
    run.until_tick()
    for _ in range(400):
        run.step()
        v, b = vehicle.speed_m_s, vehicle.braking
        held_m = v * b.react_s + v * v / (2.0 * b.a_brake_h_m_s2)
        if held_m > run.clearance(vehicle.at) + late_m or not run.gate.moving:
            break
    stop: Request = dice.choice((Abort(), Hold(), Land(), GoTo(_goal(run))))
    if dice.random() < 0.7:
        run.ask(stop)
    elif dice.random() < 0.5:
        run.feed(OperatorLost("hostile", for_good=False))
    run.run(1.0)


def streams(run: HostileRun) -> None:
    """Velocities at 20 Hz, mostly straight out of the fence; with gaps, and with wild samples."""
    dice = run.dice
    if dice.random() < 0.8:
        taken(run)
    if dice.random() < 0.7:
        run.ask(BeginStream())
    source = dice.choice(("operator", "operator", "another"))
    speed, turn = dice.choice((1.0, 4.0, 9.0, 12.0)), dice.uniform(0.0, math.tau)
    v_ned = (speed * math.cos(turn), speed * math.sin(turn), dice.choice((0.0, 0.0, -2.0, 1.5)))
    for _ in range(dice.choice((5, 30, 80))):
        pos_ned = _goal(run) if dice.random() < 0.02 else None
        wild = (math.nan, 0.0, 0.0) if dice.random() < 0.01 else v_ned
        if dice.random() < 0.95:
            run.feed(StreamSeen(source, pos_ned, None if pos_ned else wild, None, None, None))
        run.run(0.04 if dice.random() < 0.5 else 0.06)
    if dice.random() < 0.2:
        run.ask(dice.choice((EndStream(), Abort(), GoTo(_goal(run)))), source)


def asks(run: HostileRun) -> None:
    dice = run.dice
    anything: tuple[Request, ...] = (
        Abort(),
        Hold(),
        Land(),
        ReturnHome(),
        TakeControl(),
        Resume(),
        Arm(),
        Disarm(),
        Disarm(force=True),
        TakeOff(dice.choice((2.0, 10.0, 29.9, 40.0, 0.0, -1.0, math.nan))),
        TakePhoto(),
        BeginStream(),
        EndStream(),
        StartMission(),
        SwitchFence(dice.random() < 0.5),
        SetMode("X", dice.choice(list(FlightMode))),
        SetMode("ALT_HOLD", FlightMode.OTHER, "LOITER"),
    )
    ask_station(run, dice.choice(anything), dice.choice(("operator", "another")))


def waits(run: HostileRun) -> None:
    run.run(run.dice.choice((0.5, 1.0, 2.0)))


def long_wait(run: HostileRun) -> None:
    """Deadlines pass, if nothing moves."""
    if run.dice.random() < 0.3:
        run.leap(run.dice.choice((5.0, 12.0, 65.0, 190.0)))


def somebody_flies(run: HostileRun) -> None:
    """A pilot, or the vehicle by itself."""
    dice = run.dice
    run.taken_away()
    mode = dice.choice((*FlightMode, FlightMode.OTHER, FlightMode.OTHER, FlightMode.HOLD))
    fast = dice.choice((0.0, 2.0, 12.0))
    turn = dice.uniform(0.0, math.tau)
    v_ned = (fast * math.cos(turn), fast * math.sin(turn), dice.uniform(-1.0, 1.0))
    if mode in (FlightMode.MISSION, FlightMode.RETURN, FlightMode.TAKEOFF):
        run.vehicle.path = [(0.0, 0.0, -10.0)]
    run.vehicle.takes_over(mode, v_ned)


def pilot_arms(run: HostileRun) -> None:
    run.vehicle.armed = not run.vehicle.armed
    run.taken_away()


def outage(run: HostileRun) -> None:
    until_ns = run.now_ns + round(run.dice.choice((0.3, 1.2, 2.0, 4.0)) * SECOND_NS)
    match run.dice.randrange(3):
        case 0:
            run.deaf_until_ns = until_ns
        case 1:
            run.mute_until_ns = until_ns
        case _:
            run.deaf_until_ns = run.mute_until_ns = until_ns


def positions_stop(run: HostileRun) -> None:
    """The link lives, and no position comes: heartbeats alone."""
    run.mute_until_ns = run.now_ns + round(1.6 * SECOND_NS)
    for _ in range(80):
        run.step()
        if run._steps % 25 == 0:
            v = run.vehicle
            run.feed(MessageSeen())
            run.feed(HeartbeatSeen(v.armed, v.mode, v.mode.value, v.failsafe))


def jump(run: HostileRun) -> None:
    """The estimate steps, or says that it did: the local frame has moved, and the truth in it."""
    dice, vehicle = run.dice, run.vehicle
    run.taken_away()
    step_m = dice.choice((0.0, 5.0, 60.0))
    vehicle.pos[0] += step_m
    north, east, down = vehicle.vel
    reset = step_m == 0.0 or dice.random() < 0.5
    run.feed(
        PositionSeen(vehicle.reported(), (north, east, down), run.now_ns // MS_NS, reset=reset)
    )


def bad_position(run: HostileRun) -> None:
    """Not finite, or older than the last one."""
    dice = run.dice
    north = dice.choice((math.nan, math.inf, 0.0))
    run.feed(PositionSeen((north, 0.0, -5.0), (0.0, 0.0, 0.0), 1), judged=False)


def home_moves(run: HostileRun) -> None:
    dice = run.dice
    x, y, _ = run.home_ned
    far_m = dice.choice((0.3, 3.0, 80.0))
    run.home_ned = run.vehicle.home_ned = (x + far_m, y, 0.0)
    run.taken_away()
    run.feed(HomeSeen(run.home_ned))
    run.feed(VerifierChanged(run.verifier()))


def condition(run: HostileRun) -> None:
    which = run.dice.choice(list(Condition))
    run.feed(ConditionChanged(which, run.dice.random() < 0.6, "hostile"))


def conditions_over(run: HostileRun) -> None:
    for which in run.gate.conditions:
        run.feed(ConditionChanged(which, False))


def mission(run: HostileRun, *, starts: bool = False) -> None:
    """One that is verified leg by leg, as a mission job does it; at times started at once."""
    dice, verifier = run.dice, run.verifier()
    x, y, z = run.vehicle.pos
    at: Vec3 = (x, y, z)
    path: list[Vec3] = []
    for _ in range(6):
        goal = place(dice, verifier.zones, run.policy)
        if verifier.mission_leg(at, goal, floor_applies=True) is None:
            path.append(goal)
            at = goal
    if run.vehicle.mode is not FlightMode.MISSION:
        run.vehicle.mission = path
    run.feed(MissionLoaded("hostile", len(path)))
    if starts or dice.random() < 0.5:
        ask_station(run, StartMission())


def ask_station(run: HostileRun, request: Request, source: str = "operator") -> None:
    """A mission is begun as the station begins one: where its path still clears from here, and
    with the box round that."""
    if isinstance(request, StartMission):
        if not _mission_clears(run):
            return
        path = (run.vehicle.reported(), *run.vehicle.mission)
        run.feed(MissionPathVerified(box_round(path)))
    run.ask(request, source)


def _mission_clears(run: HostileRun) -> bool:
    verifier, at = run.verifier(), run.vehicle.reported()
    for goal in run.vehicle.mission:
        if verifier.mission_leg(at, goal, floor_applies=True) is not None:
            return False
        at = goal
    return True


def mission_report(run: HostileRun) -> None:
    seq = run.dice.randrange(4)
    run.feed(MissionSeen(seq, 3, seq == 3))


def photo(run: HostileRun) -> None:
    run.feed(PhotoSeen(run.dice.randrange(3), run.dice.random() < 0.7))


def wild_answer(run: HostileRun) -> None:
    """To a command of ours, or to none."""
    dice = run.dice
    waiting = list(run._awaited)
    if waiting and dice.random() < 0.8:
        key = dice.choice(waiting)
        del run._awaited[key]  # it never reaches the vehicle
        run.promised = False
    else:
        key = (dice.randrange(9), dice.choice(list(CommandKind)))
    run.feed(CommandEnded(*key, dice.choice((0, 1, 2, 4, None)), "hostile"))


def stubborn(run: HostileRun) -> None:
    run.vehicle.stubborn = not run.vehicle.stubborn


def wild_report(run: HostileRun) -> None:
    """A heartbeat or a landed state that is not so."""
    dice = run.dice
    if dice.random() < 0.5:
        run.feed(LandedSeen(dice.choice(list(LandedState))))
    else:
        mode = dice.choice(list(FlightMode))
        run.feed(HeartbeatSeen(dice.random() < 0.7, mode, mode.value, dice.random() < 0.1))
    run.promised = False


def accuracy(run: HostileRun) -> None:
    run.feed(AccuracySeen(run.dice.choice((None, 0.3, 5.0)), run.dice.choice((None, 2.0))))


def operator_leaves(run: HostileRun) -> None:
    run.feed(OperatorLost("hostile", for_good=run.dice.random() < 0.2))


def enters(run: HostileRun) -> None:
    """Into a state in which it does something, as an operator brings it there."""
    dice, vehicle = run.dice, run.vehicle
    if run.gate.state is State.NO_VEHICLE:
        run.connects()
    vehicle.stubborn = False
    run.tells()
    conditions_over(run)
    if vehicle.landed is LandedState.ON_GROUND:
        vehicle.armed = vehicle.armed or dice.random() < 0.8
        run.tells()
        if dice.random() < 0.3:
            return
        run.ask(TakeOff(10.0))
        run.run(dice.choice((0.1, 0.5, 6.0)))
    if dice.random() < 0.2:
        vehicle.takes_over(dice.choice(list(FlightMode)), (0.0, 0.0, 0.0))
        run.taken_away()
        run.tells()
        return
    if run.gate.state in (State.HOLDING, State.EXTERNAL):
        run.ask(dice.choice((Resume(), TakeControl())))
        run.run(1.4)
    if dice.random() < 0.3:
        run.unanswered_until_ns = run.now_ns + 3 * SECOND_NS
    dice.choice(INTO)(run)


def into_mission(run: HostileRun) -> None:
    mission(run, starts=True)
    run.run(run.dice.choice((0.1, 1.0)))


def into_stream(run: HostileRun) -> None:
    run.ask(BeginStream())
    run.feed(StreamSeen("operator", None, (0.3, 0.0, 0.0), None, None, None))


def into_moving(run: HostileRun) -> None:
    for _ in range(4):
        run.ask(GoTo(_goal(run)))
        run.until_tick()
        if run.gate.state is State.MOVING:
            return


def into_stale(run: HostileRun) -> None:
    run.mute_until_ns = run.now_ns + SECOND_NS
    run.passes(round((run.policy.position_age_s + 0.1) * SECOND_NS))
    run.feed(MessageSeen())
    run.feed(Tick(0))


def into_no_vehicle(run: HostileRun) -> None:
    run.mute_until_ns = run.now_ns + SECOND_NS
    run.passes(round((run.policy.heartbeat_age_s + 0.1) * SECOND_NS))
    run.feed(Tick(0))


INTO: tuple[Act, ...] = (
    *[into_mission] * 3,
    *[into_stream] * 2,
    *[lambda run: run.ask(TakePhoto())] * 2,
    *[into_moving] * 2,
    into_stale,
    into_no_vehicle,
    lambda run: run.ask(ReturnHome()),
    lambda run: run.ask(Land()),
    lambda run: run.ask(Abort()),
    lambda run: None,
)


def told_anything(run: HostileRun) -> None:
    if run.dice.random() < 0.7:
        enters(run)
    is_told_anything(run, run.dice.choice((1, 2, 3, 5, 12)))


def taken(run: HostileRun) -> None:
    """Control, wherever it can be had."""
    if run.gate.control is Control.NONE:
        conditions_over(run)
        run.ask(run.dice.choice((Resume(), TakeControl())))
        run.run(1.4)


ACTS: tuple[Act, ...] = (
    *[sensible] * 16,
    *[goes] * 12,
    *[dashes] * 8,
    *[streams] * 4,
    *[told_anything] * 3,
    goes_twice,
    *[asks] * 12,
    *[waits] * 6,
    *[long_wait] * 2,
    *[taken] * 5,
    *[somebody_flies] * 3,
    pilot_arms,
    *[outage] * 2,
    positions_stop,
    jump,
    bad_position,
    home_moves,
    *[condition] * 2,
    *[conditions_over] * 2,
    *[mission] * 2,
    mission_report,
    photo,
    *[wild_answer] * 2,
    stubborn,
    *[wild_report] * 2,
    accuracy,
    operator_leaves,
)
