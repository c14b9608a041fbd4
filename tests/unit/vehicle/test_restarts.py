"""Whether a vehicle has restarted, or is another one: what shows it, and what follows."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs.gate.states import State
from gcs.vehicle.talk.restarts import Restarts
from gcs.wire.messages import Attitude, Heartbeat
from tests.unit.station import told, wire
from tests.unit.station.station import Script
from tests.unit.station.wire import MS_NS

UP_S = 100
BRAKE = 17
"""ArduCopter's."""


def attitude(boot_ms: int) -> Attitude:
    return Attitude(boot_ms, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def beat(status: int, *, armed: bool = False) -> Heartbeat:
    return Heartbeat(0, 2, 12, 128 if armed else 0, status, 3)


def signs(stamps_ms: list[int], every_ms: int = 250) -> list[int]:
    """At which stamp a restart is seen."""
    restarts = Restarts()
    came = enumerate(stamps_ms)
    return [ms for turn, ms in came if restarts.sign(attitude(ms), turn * every_ms * MS_NS)]


# ------------------------------------------------------------------------------ its clock


def test_a_clock_that_ran_back_and_stays_there_is_a_restart() -> None:
    assert signs([60_000, 60_250, 200, 450, 700, 950]) == [700]
    assert signs([60_000, 61_000, 200, 1200, 2200], every_ms=1000) == [1200]


@pytest.mark.parametrize(
    "stamps_ms",
    [
        [60_000, 200, 60_050, 60_100, 60_150],  # one that is late or forged
        [60_000, 200, 250, 60_050, 300, 350, 60_100],  # two, and a newer one between them
        [60_000, 200, 200, 200, 200],  # one that came twice
        [60_000, 59_100, 59_150, 59_200, 59_250],  # overtaken
        [60_000, 30_000, 200, 45_000],  # which do not follow each other
    ],
)
def test_late_and_forged_frames_are_no_restart(stamps_ms: list[int]) -> None:
    assert signs(stamps_ms) == []


def test_a_stamp_that_begins_anew_after_49_days_is_taken_for_a_restart() -> None:
    assert signs([2**32 - 50, 200, 450, 700]) == [700]


def answers(*heard: tuple[float, float, float], armed: bool = False) -> list[bool]:
    """When each was asked for, what the vehicle's clock says, when it came; seconds."""
    restarts = Restarts()
    return [
        bool(
            restarts.answered(
                round(asked_s * 1e9), round(clock_s * 1e9), round(came_s * 1e9), armed=armed
            )
        )
        for asked_s, clock_s, came_s in heard
    ]


def test_answers_to_timesync_show_the_restart_of_a_vehicle_that_was_up_for_seconds() -> None:
    """Its new clock is soon past the last stamp that came of the old one."""
    heard = [(10.0, 3.0, 10.1), (11.0, 4.0, 11.1), (14.0, 4.5, 14.1), (15.0, 5.5, 15.1)]
    assert answers(*heard) == [False, False, False, True]
    assert answers(*heard, armed=True) == [False] * 4


def test_nor_is_one_that_took_long_or_one_that_is_alone() -> None:
    assert answers((10.0, 3.0, 10.1), (11.0, 4.0, 15.0), (12.0, 5.0, 15.0)) == [False] * 3
    assert answers((10.0, 3.0, 10.1), (11.0, 9.0, 11.1), (12.0, 5.0, 12.1)) == [False] * 3


def test_a_simulator_that_is_slower_than_real_time_does_not_restart() -> None:
    heard = [(10.0 + t, 3.0 + 0.3 * t, 10.1 + t) for t in range(20)]
    assert not any(answers(*heard))
    starved = [(10.0 + t, 3.0 + 0.55 * t, 10.1 + t) for t in range(0, 200, 10)]
    assert not any(answers(*starved))


# -------------------------------------------------------------------------- its heartbeats


@pytest.mark.parametrize("starting", [0, 1])
def test_two_heartbeats_of_a_start_are_a_restart(starting: int) -> None:
    restarts = Restarts()
    said = [restarts.sign(beat(status), 0) for status in (3, starting, starting, starting, 3)]
    assert [bool(each) for each in said] == [False, False, True, False, False]


def test_one_is_none_and_so_are_those_of_an_armed_vehicle_and_the_first_ones() -> None:
    restarts = Restarts()
    assert not any(restarts.sign(beat(status), 0) for status in (1, 1, 1, 3, 1, 3, 1, 4))
    assert not any(restarts.sign(beat(1, armed=True), 0) for _ in range(5))


# ----------------------------------------------------------------------- what follows


def known() -> Script:
    """A px4 on the ground, of which a return could be cleared."""
    script = Script()
    script.acknowledged = {511, 512, 176}
    script.met()
    script.hear(
        wire.float_param("RTL_RETURN_ALT", 30.0),
        wire.int_param("RTL_TYPE", 0),
        wire.no_rally_points(),
    )
    memory = script.session.gate.memory
    assert (memory.return_up_m, memory.return_places) == (30.0, ())
    return script


def restarted(script: Script) -> None:
    """Its first attitudes: no position came yet."""
    script.reporting = False
    script.hear(mavlink_attitude(round(UP_S * 1e3)), mavlink_attitude(round(UP_S * 1e3) + 50))
    script.forget()
    script.sender.seq = 0
    for boot_ms in (200, 450, 700):
        script.hear(mavlink_attitude(boot_ms))
        script.run(0.25)


def mavlink_attitude(boot_ms: int) -> wire.Message:
    return mavlink.MAVLink_attitude_message(boot_ms, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def read(script: Script) -> list[str]:
    return [each.param_id for each in script.sent("PARAM_REQUEST_READ")]


def test_after_a_restart_no_return_is_cleared_until_its_height_was_read_anew() -> None:
    script = known()
    restarted(script)
    assert told.log(script.told).count("has restarted (its clock ran back)") == 1
    assert "RTL_RETURN_ALT" in read(script)
    assert script.session.gate.memory.return_places is None
    script.hear(wire.int_param("RTL_TYPE", 0), wire.no_rally_points())
    assert script.session.gate.memory.return_places is None
    assert "return height" in script.session.gate.memory.return_unknown
    script.hear(wire.float_param("RTL_RETURN_ALT", 70.0))
    memory = script.session.gate.memory
    assert (memory.return_up_m, memory.return_places) == (70.0, ())


def test_after_a_restart_its_place_and_its_streams_are_asked_for() -> None:
    script = known()
    restarted(script)
    script.reporting = True
    script.run(3.0)
    asked = {(each.command, each.param1) for each in script.sent("COMMAND_LONG")}
    assert {(512, 49.0), (512, 242.0)} <= asked  # GPS_GLOBAL_ORIGIN, HOME_POSITION
    assert {(511, 32.0), (511, 245.0)} <= asked  # LOCAL_POSITION_NED, EXTENDED_SYS_STATE


def test_its_first_positions_do_not_make_a_second_restart_of_it() -> None:
    script = known()
    restarted(script)
    script.hear(wire.position(960, (0.0, 0.0, 0.0)), wire.position(990, (0.0, 0.0, 0.0)))
    assert told.log(script.told).count("has restarted") == 1
    assert script.session.gate.memory.boot_ms == 990


def test_two_vehicles_with_one_number_do_not_restart_over_and_over() -> None:
    stamps_ms = [60_000 + 25 * n - 50_000 * (n % 3 > 0) for n in range(200)]
    assert signs(stamps_ms, every_ms=25) == []


# ------------------------------------------------------------------------ another vehicle


def others(script: Script, count: int, every_s: float = 1.0) -> None:
    """Heartbeats of an ArduPilot in its name."""
    script.reporting = False
    for _ in range(count):
        script.run(every_s)
        script.hear(wire.heartbeat(wire.ARDUPILOT, mode=0, armed=script.armed))


def test_another_autopilot_is_another_vehicle_with_a_gate_of_its_own() -> None:
    script = known()
    others(script, 1)
    assert script.session.gate.memory.autopilot == "px4"
    others(script, 1)
    assert script.session.gate.memory.autopilot == "ardupilot"
    assert script.session.gate.memory.return_up_m is None
    assert "another vehicle has the number of 1/1 px4 quadrotor" in told.log(script.told)
    assert "RTL_ALT_M" in read(script)


def test_it_is_told_after_a_silence_too_and_is_not_said_to_be_back() -> None:
    script = known()
    script.reporting = False
    script.run(6.0)
    others(script, 2)
    assert script.session.gate.memory.autopilot == "ardupilot"
    assert script.session.gate.state is not State.NO_VEHICLE
    assert "is back" not in told.log(script.told)


def test_a_plane_of_the_same_autopilot_is_another_vehicle() -> None:
    script = Script()
    script.hear(wire.heartbeat(wire.ARDUPILOT))
    for _ in range(2):
        script.run(1.0)
        script.hear(wire.heartbeat(wire.ARDUPILOT, type_=1))
    assert "1/1 ardupilot fixed wing" in told.log(script.told)


def test_what_was_under_way_has_its_ending_and_is_not_sent_to_the_other() -> None:
    script = known()
    arm = script.ask("arm")
    assert any(each.command == 400 for each in script.sent("COMMAND_LONG"))
    script.reporting = False
    others(script, 2, every_s=0.8)
    assert [each[1] for each in told.outcomes(script.told) if each[0] == arm] == ["aborted"]
    script.forget()
    script.run(5.0)
    assert not any(each.command == 400 for each in script.sent("COMMAND_LONG"))


def test_forged_heartbeats_between_its_own_change_nothing() -> None:
    script = known()
    for _ in range(6):
        script.run(0.5)
        script.hear(wire.heartbeat(wire.ARDUPILOT), wire.heartbeat(wire.ARDUPILOT))
    assert script.session.gate.memory.autopilot == "px4"


def test_what_we_fly_is_not_given_up_before_it_is_lost() -> None:
    script = Script().hovering()
    others(script, 3)
    assert script.session.gate.memory.autopilot == "px4"
    others(script, 1)
    assert script.session.gate.memory.autopilot == "ardupilot"


def test_it_is_held_in_its_own_modes() -> None:
    script = Script()
    script.armed, script.landed, script.pos_ned = True, wire.IN_AIR, (0.0, 0.0, -5.0)
    script.mode = wire.POSCTL
    script.met()
    others(script, 4)
    script.forget()
    script.hear(wire.landed(wire.IN_AIR), wire.position(300_000, (0.0, 0.0, -5.0)))
    script.ask("hold")
    modes = [each.param2 for each in script.sent("COMMAND_LONG") if each.command == 176]
    assert modes == [BRAKE]
