"""What is asked of a vehicle that was just met, of its telemetry."""

from __future__ import annotations

from itertools import pairwise

import pytest

from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.session.speedup_waits import Times
from gcs.vehicle.talk.discovery import Discovery
from gcs.wire.ids import Cmd, MsgId
from gcs.wire.messages import CommandLong
from tests.unit.station.vehicles import HOME, SECOND_NS, vehicle


class Script:
    """A discovery, its clock, and what is known of the vehicle."""

    def __init__(self) -> None:
        self.now_ns = SECOND_NS
        self.discovery = Discovery(Times())
        self.telemetry = vehicle()


def ask(script: Script, seconds: float = 0.0) -> list[CommandLong]:
    script.now_ns += round(seconds * SECOND_NS)
    script.telemetry.heard_ns = script.now_ns
    return list(script.discovery.missing(script.telemetry, script.now_ns))


def once(commands: list[CommandLong]) -> set[float]:
    return {c.param1 for c in commands if c.command == Cmd.REQUEST_MESSAGE}


def rates_hz(commands: list[CommandLong]) -> dict[float, float]:
    """By message id; param2 is the interval in microseconds."""
    wanted = [c for c in commands if c.command == Cmd.SET_MESSAGE_INTERVAL]
    return {c.param1: 1e6 / c.param2 for c in wanted}


def test_at_first_everything_is_asked_for() -> None:
    script = Script()
    commands = ask(script)
    assert once(commands) == {
        MsgId.GPS_GLOBAL_ORIGIN,
        MsgId.HOME_POSITION,
        MsgId.AUTOPILOT_VERSION,
    }
    assert {MsgId.LOCAL_POSITION_NED, MsgId.EXTENDED_SYS_STATE} <= set(rates_hz(commands))
    assert {(c.target_system, c.target_component) for c in commands} == {(1, 1)}
    unused = {(c.param3, c.param4, c.param5, c.param6, c.param7) for c in commands}
    assert unused == {(0.0,) * 5}  # param7 0: whoever sends it, sends it as it always does


def test_positions_come_at_least_at_10_hz_for_the_prediction_of_the_stop() -> None:
    assert rates_hz(ask(Script()))[MsgId.LOCAL_POSITION_NED] >= 10.0


def test_what_did_not_come_is_asked_for_again_every_two_seconds() -> None:
    script = Script()
    ask(script)
    assert ask(script, 1.9) == []
    assert once(ask(script, 0.2)) == {MsgId.GPS_GLOBAL_ORIGIN, MsgId.HOME_POSITION}
    assert ask(script, 1.9) == []


def test_what_came_is_not_asked_for_again() -> None:
    script = Script()
    ask(script)
    telemetry = script.telemetry
    telemetry.origin, telemetry.home = HOME, (47.0, 8.0, 488.0)
    telemetry.pos_ned, telemetry.landed_ns = (0.0, 0.0, 0.0), script.now_ns + 2 * SECOND_NS
    assert ask(script, 3.0) == []


def test_a_landed_state_that_stops_coming_is_asked_for_again() -> None:
    script = Script()
    ask(script)
    telemetry = script.telemetry
    telemetry.origin, telemetry.home = HOME, (47.0, 8.0, 488.0)
    telemetry.pos_ned, telemetry.landed_ns = (0.0, 0.0, 0.0), script.now_ns
    assert set(rates_hz(ask(script, 3.0))) == {MsgId.EXTENDED_SYS_STATE}


@pytest.mark.parametrize(("speedup", "hz"), [(1.0, 30.0), (4.0, 120.0), (100.0, 200.0)])
def test_a_sped_up_vehicle_is_asked_for_positions_so_much_more_often_up_to_a_limit(
    speedup: float, hz: float
) -> None:
    discovery = Discovery(Times(speedup))
    commands = list(discovery.missing(vehicle(), SECOND_NS))
    assert rates_hz(commands)[MsgId.LOCAL_POSITION_NED] == pytest.approx(hz, rel=1e-4)


# ------------------------------------------------------------------- streams that stopped


def silent(script: Script) -> Script:
    """All came that was asked for, until now; from here on the landed state alone comes."""
    ask(script)
    telemetry = script.telemetry
    telemetry.origin, telemetry.home = HOME, (47.0, 8.0, 488.0)
    telemetry.pos_ned, telemetry.position_came_ns = (0.0, 0.0, 0.0), script.now_ns
    telemetry.landed_ns = script.now_ns + 1_000 * SECOND_NS
    return script


def test_positions_that_stop_are_asked_for_again_with_all_else_and_ever_more_seldom() -> None:
    script = silent(Script())
    began_ns = script.now_ns
    asked_s = []
    for _ in range(100):
        commands = ask(script, 1.0)
        if commands:
            assert {MsgId.LOCAL_POSITION_NED, MsgId.ATTITUDE} <= set(rates_hz(commands))
            asked_s.append((script.now_ns - began_ns) // SECOND_NS)
    pauses_s = [later - before for before, later in pairwise(asked_s)]
    assert asked_s[0] == 4
    assert pauses_s == [4, 8, 16, 30, 30]


def test_that_they_stopped_is_told_once() -> None:
    script = silent(Script())
    assert heard_after(script, 2) == ""
    assert "sends no positions" in heard_after(script, 1)
    assert heard_after(script, 6) == ""
    script.telemetry.position_came_ns = script.now_ns + SECOND_NS
    assert heard_after(script, 2) == ""
    assert heard_after(script, 9) != ""


def heard_after(script: Script, seconds: int) -> str:
    """What is told of missing positions when a frame has come."""
    script.now_ns += seconds * SECOND_NS
    script.telemetry.heard_ns = script.now_ns
    return script.discovery.silence(script.telemetry, script.now_ns)


def test_of_a_link_that_is_wholly_out_it_is_not_said_that_the_vehicle_is_heard() -> None:
    """Positions stopped, and after a last heartbeat everything did."""
    script = silent(Script())
    script.telemetry.heard_ns = script.now_ns + 3 * SECOND_NS
    script.now_ns += 6 * SECOND_NS
    assert script.discovery.silence(script.telemetry, script.now_ns) == ""
    assert not rates_hz(list(script.discovery.missing(script.telemetry, script.now_ns)))


def test_a_vehicle_that_is_not_heard_has_not_stopped_its_positions() -> None:
    """They are missing from when it is heard again, and come with what else it sends."""
    script = silent(Script())
    ask(script, 0.5)
    script.now_ns += 10 * SECOND_NS
    assert script.discovery.silence(script.telemetry, script.now_ns) == ""
    script.telemetry.heard_again_ns = script.now_ns
    assert heard_after(script, 0) == heard_after(script, 2) == ""
    assert "sends no positions" in heard_after(script, 1)


@pytest.mark.parametrize(
    ("autopilot", "sent", "unknown"),
    [
        (PX4, {MsgId.ESTIMATOR_STATUS}, {MsgId.EKF_STATUS_REPORT, MsgId.FENCE_STATUS}),
        (ARDUPILOT, {MsgId.EKF_STATUS_REPORT, MsgId.FENCE_STATUS}, {MsgId.ESTIMATOR_STATUS}),
    ],
    ids=lambda given: getattr(given, "name", ""),
)
def test_no_autopilot_is_asked_for_what_it_does_not_know(
    autopilot: Autopilot, sent: set[MsgId], unknown: set[MsgId]
) -> None:
    """An ArduCopter 4.7 tells everybody "No ap_message for mavlink id (230)", each time."""
    script = Script()
    script.telemetry = vehicle(autopilot)
    asked = set(rates_hz(ask(script)))
    assert sent <= asked
    assert asked.isdisjoint(unknown)
    again = script.discovery.again(script.telemetry, sorted(sent | unknown))
    assert set(rates_hz(list(again))) == sent
