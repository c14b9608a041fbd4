"""Leaving: the vehicle is seen safe first, for at most three seconds; then it is said how it is."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.session.inputs import FileRead, Input, OperatorGone, OperatorLine, SignalCame
from tests.unit.station import told, wire
from tests.unit.station.station import Script, is_finish, is_frame
from tests.unit.station.wire import SECOND_NS
from tests.unit.vehicle.plans import BOX

DO_SET_MODE = 176
LEAVE = OperatorLine(1, ipc.Leave("quit"))


def holds(script: Script) -> list[int]:
    """When the vehicle was asked for px4's AUTO.LOITER (main mode 4, sub mode 3)."""

    def is_hold(message: wire.Message) -> bool:
        return bool(message.command == DO_SET_MODE and (message.param2, message.param3) == (4, 3))

    return [
        time_ns
        for time_ns, effect in script.timed
        if any(is_hold(message) for message in wire.sent([effect], "COMMAND_LONG"))
    ]


@pytest.mark.parametrize("goes", [LEAVE, SignalCame("SIGTERM"), OperatorGone(1, "end of file")])
def test_whoever_leaves_a_vehicle_that_we_fly_it_is_told_to_hold_at_once(goes: Input) -> None:
    script = Script().hovering()
    script.forget()
    script.feed(goes)
    assert holds(script) == [script.now_ns]
    assert told.finishes(script.told) == []


def test_the_session_ends_as_soon_as_the_hold_is_seen() -> None:
    script = Script().hovering(up_m=5.0)
    script.feed(LEAVE)
    script.run(0.4)
    assert told.finishes(script.told) == []
    script.mode = wire.LOITER
    (finish,) = told.finishes(script.run(0.2))
    assert finish.exit_code == 0
    assert finish.sentence == "the vehicle is STILL FLYING in AUTO.LOITER, 5.0 m up"


def test_a_hold_that_is_never_seen_is_asked_for_every_second_and_given_up_after_three() -> None:
    script = Script().hovering()
    script.forget()
    left_ns = script.now_ns
    script.feed(LEAVE)
    script.run(4.0)
    (finished_ns,) = script.times_ns(is_finish)
    assert 3 * SECOND_NS <= finished_ns - left_ns <= 3 * SECOND_NS + 50_000_000
    seconds = {(time_ns - left_ns) // SECOND_NS for time_ns in holds(script)}
    assert {0, 1, 2} <= seconds
    (finish,) = told.finishes(script.told)
    assert finish.sentence == "the vehicle was not seen to hold within 3 s"


def test_leaving_once_more_does_not_make_it_longer() -> None:
    script = Script().hovering()
    left_ns = script.now_ns
    script.feed(LEAVE)
    script.run(2.9)
    script.feed(OperatorGone(1, "the command stream ended"))
    script.run(1.0)
    (finished_ns,) = script.times_ns(is_finish)
    assert finished_ns - left_ns <= 3 * SECOND_NS + 50_000_000


def test_a_vehicle_that_somebody_else_flies_is_left_alone() -> None:
    script = Script().flying()
    script.run(5.0)
    script.forget()
    script.feed(LEAVE)
    (finish,) = told.finishes(script.told)
    assert "STILL FLYING in POSCTL" in finish.sentence
    assert holds(script) == []


def test_a_vehicle_on_the_ground_is_left_at_once() -> None:
    script = Script().met()
    script.feed(LEAVE)
    (finish,) = told.finishes(script.told)
    assert (finish.exit_code, finish.sentence) == (0, "the vehicle is on the ground")


def test_a_vehicle_that_is_left_armed_on_the_ground_is_said_to_be() -> None:
    script = Script().met()
    script.armed = True
    script.run(0.3)
    script.feed(LEAVE)
    script.run(4.0)
    (finish,) = told.finishes(script.told)
    assert finish.sentence == "the vehicle is on the ground, still ARMED"


def test_without_a_vehicle_there_is_nothing_to_wait_for() -> None:
    script = Script()
    script.feed(LEAVE)
    (finish,) = told.finishes(script.told)
    assert (finish.exit_code, finish.sentence) == (0, "no vehicle was heard")


def test_a_goal_that_is_flown_has_its_outcome_before_the_end() -> None:
    script = Script().hovering()
    goal = script.ask("goto", goal_enu=(5.0, 0.0, 5.0))
    script.run(0.2)
    script.feed(LEAVE)
    script.run(4.0)
    assert told.verdicts(script.told)[-1] == (goal, "accepted", "")
    assert told.outcomes(script.told)[-1] == (goal, "aborted", "OPERATOR_LOST")


def test_a_mission_job_that_is_under_way_has_its_verdict_before_the_end() -> None:
    script = Script().met()
    upload = script.ask("mission_upload", path="box.plan")
    (asked,) = told.files(script.told)
    script.feed(FileRead(asked.token, "box.plan", BOX))
    script.feed(LEAVE)
    assert told.verdicts(script.told) == [(upload, "refused", "OPERATOR_LOST")]
    assert told.finishes(script.told[-1:]) != []


def test_while_leaving_no_mission_job_begins() -> None:
    script = Script().hovering()
    script.feed(LEAVE)
    script.mode = wire.LOITER
    script.run(0.5)
    late = script.ask("mission_download")
    assert told.verdicts(script.told)[-1] == (late, "refused", "OPERATOR_LOST")


def test_a_landing_that_is_asked_for_while_leaving_has_its_outcome_before_the_end() -> None:
    script = Script().hovering()
    script.feed(LEAVE)
    script.run(0.1)
    late = script.ask("land")
    script.run(4.0)
    assert told.verdicts(script.told)[-1] == (late, "accepted", "")
    assert told.outcomes(script.told)[-1] == (late, "aborted", "OPERATOR_LOST")
    assert told.finishes(script.told) != []


def test_the_session_ends_once() -> None:
    script = Script().met()
    script.feed(LEAVE)
    script.feed(SignalCame("SIGHUP"))
    script.run(5.0)
    assert len(told.finishes(script.told)) == 1


def test_the_heartbeat_goes_on_while_the_vehicle_is_awaited() -> None:
    script = Script().hovering()
    script.forget()
    script.feed(LEAVE)
    script.run(2.5)
    assert len(script.times_ns(is_frame("HEARTBEAT"))) in (2, 3)
