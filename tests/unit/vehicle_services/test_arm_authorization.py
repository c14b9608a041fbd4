"""PX4's arm authorization, as a station and an authorizer see it on the link.

Source of the rules and the texts: PX4's ArmAuthorization.cpp; none of it is in the recordings.
"""

from __future__ import annotations

import pytest

from tests.unit.autopilot.flight import item
from tests.unit.vehicle_services.fake_vehicle import MS, S, acks, long
from tests.unit.vehicle_services.flown_vehicle import Flown, on_the_ground
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd

ARM, MISSION_START, AUTHORIZATION = 400, 300, 3001
AUTHORIZER = 10
IN_ONE, IN_TWO = 0, 1  # COM_ARM_AUTH_MET


def guarded(method: int = IN_ONE, timeout_s: float = 1.0) -> Flown:
    """A PX4 on the ground that arms only when authorized."""
    bench = on_the_ground("px4")
    bench.parameters.set("COM_ARM_AUTH_REQ", 1)
    bench.parameters.set("COM_ARM_AUTH_MET", method)
    bench.parameters.set("COM_ARM_AUTH_TO", timeout_s)
    return bench


def requests(heard: list[m.Message]) -> list[m.CommandLong]:
    return [e for e in heard if isinstance(e, m.CommandLong) and e.command == AUTHORIZATION]


def answer(
    bench: Flown, result: Result, param2: int = 0, reason: int = 0, target: int = 1
) -> list[m.Message]:
    """COMMAND_ACK of the authorizer, and what the vehicle says within the next 0.2 s."""
    told = m.CommandAck(AUTHORIZATION, result, reason, param2, target, 1)
    return bench.send(told) + bench.advance(200 * MS)


def ask(bench: Flown) -> list[m.Message]:
    return bench.send(long(Cmd.COMPONENT_ARM_DISARM, 1)) + bench.advance(100 * MS)


def test_it_is_off_as_delivered() -> None:
    heard = ask(on_the_ground("px4"))
    assert acks(heard) == [(ARM, Result.ACCEPTED)]
    assert requests(heard) == []


def test_the_authorizer_is_asked_and_the_arm_is_not_answered_yet() -> None:
    bench = guarded()
    heard = ask(bench)
    assert acks(heard) == []
    (asked,) = requests(heard)
    assert (asked.target_system, asked.target_component) == (AUTHORIZER, 0)
    assert not bench.autopilot.armed


def test_in_one_step_it_arms_when_the_answer_comes() -> None:
    bench = guarded()
    ask(bench)
    heard = answer(bench, Result.ACCEPTED, param2=30)
    assert acks(heard) == [(ARM, Result.ACCEPTED)]
    assert bench.autopilot.armed
    assert "Arm auth: Authorized for the next 30 seconds\t" in bench.texts(heard)


def test_in_one_step_the_time_granted_lets_it_arm_again_without_asking() -> None:
    bench = guarded()
    ask(bench)
    answer(bench, Result.ACCEPTED, param2=10)
    assert bench.result(long(Cmd.COMPONENT_ARM_DISARM, 0), 100 * MS) == Result.ACCEPTED
    heard = ask(bench)
    assert acks(heard) == [(ARM, Result.ACCEPTED)]
    assert requests(heard) == []


def test_the_time_granted_ends() -> None:
    bench = guarded()
    ask(bench)
    answer(bench, Result.ACCEPTED, param2=3)
    assert bench.result(long(Cmd.COMPONENT_ARM_DISARM, 0), 100 * MS) == Result.ACCEPTED
    bench.advance(4 * S)
    heard = ask(bench)
    assert acks(heard) == []
    assert len(requests(heard)) == 1


@pytest.mark.parametrize("timeout_s", [1.0, 2.5])
def test_without_an_answer_it_is_refused_when_the_time_is_out(timeout_s: float) -> None:
    bench = guarded(timeout_s=timeout_s)
    ask(bench)
    heard = bench.advance(int(timeout_s * S) - 200 * MS)
    assert acks(heard) == []
    heard = bench.advance(300 * MS)
    assert acks(heard) == [(ARM, Result.TEMPORARILY_REJECTED)]
    assert "Arm auth: No response\t" in bench.texts(heard)
    assert acks(answer(bench, Result.ACCEPTED, param2=30)) == []
    assert not bench.autopilot.armed


@pytest.mark.parametrize(
    ("result", "reason", "param2", "text"),
    [
        (Result.TEMPORARILY_REJECTED, 0, 0, "Arm auth: Temporarily rejected"),
        (Result.DENIED, 0, 0, "Arm auth: Denied"),
        (Result.DENIED, 2, 7, "Arm auth: Denied, waypoint 7 have a invalid value"),
        (Result.DENIED, 3, 0, "Arm auth: Denied by timeout in authorizer"),
        (Result.DENIED, 4, 0, "Arm auth: Denied because airspace is in use"),
        (Result.DENIED, 5, 0, "Arm auth: Denied because of bad weather"),
        (Result.DENIED, 99, 0, "Arm auth: Denied"),
        (Result.FAILED, 5, 0, "Arm auth: Denied because of bad weather"),
    ],
)
def test_a_denial_is_told_with_its_reason(
    result: Result, reason: int, param2: int, text: str
) -> None:
    bench = guarded()
    ask(bench)
    heard = answer(bench, result, param2, reason)
    assert acks(heard) == [(ARM, Result.TEMPORARILY_REJECTED)]
    assert bench.texts(heard) == [f"{text}\t"]
    assert not bench.autopilot.armed


def test_of_reason_none_the_authorizer_tells_itself() -> None:
    bench = guarded()
    ask(bench)
    heard = answer(bench, Result.DENIED, reason=1)
    assert acks(heard) == [(ARM, Result.TEMPORARILY_REJECTED)]
    assert bench.texts(heard) == []


def test_an_authorizer_that_is_at_work_wins_no_time() -> None:
    bench = guarded()
    ask(bench)
    assert acks(answer(bench, Result.IN_PROGRESS)) == []
    assert acks(bench.advance(1 * S)) == [(ARM, Result.TEMPORARILY_REJECTED)]


def test_an_answer_for_another_vehicle_is_not_ours() -> None:
    bench = guarded()
    ask(bench)
    assert acks(answer(bench, Result.ACCEPTED, param2=30, target=2)) == []
    assert acks(answer(bench, Result.ACCEPTED, param2=30, target=0)) == []
    assert not bench.autopilot.armed


def test_an_answer_that_was_not_asked_for_grants_nothing() -> None:
    bench = guarded()
    assert bench.texts(answer(bench, Result.ACCEPTED, param2=30)) == []
    assert acks(ask(bench)) == []


def test_in_two_steps_the_first_arm_is_refused_and_the_second_is_taken() -> None:
    bench = guarded(IN_TWO)
    heard = ask(bench)
    assert acks(heard) == [(ARM, Result.TEMPORARILY_REJECTED)]
    assert len(requests(heard)) == 1
    assert "Arm auth: Requesting authorization...\t" in bench.texts(heard)
    heard = answer(bench, Result.ACCEPTED, param2=20)
    assert acks(heard) == []
    assert not bench.autopilot.armed
    bench.advance(5 * S)
    assert acks(ask(bench)) == [(ARM, Result.ACCEPTED)]
    assert bench.autopilot.armed


def test_in_two_steps_it_is_refused_while_the_answer_is_awaited() -> None:
    bench = guarded(IN_TWO)
    ask(bench)
    bench.advance(200 * MS)
    heard = ask(bench)
    assert acks(heard) == [(ARM, Result.TEMPORARILY_REJECTED)]
    assert requests(heard) == []


def test_in_two_steps_no_answer_is_told_and_it_can_be_asked_again() -> None:
    bench = guarded(IN_TWO)
    ask(bench)
    heard = bench.advance(1200 * MS)
    assert acks(heard) == []
    assert "Arm auth: No response\t" in bench.texts(heard)
    assert len(requests(ask(bench))) == 1


def test_by_force_nobody_is_asked() -> None:
    bench = guarded()
    heard = bench.send(long(Cmd.COMPONENT_ARM_DISARM, 1, 21196)) + bench.advance(100 * MS)
    assert acks(heard) == [(ARM, Result.ACCEPTED)]
    assert requests(heard) == []


def test_who_may_not_arm_anyway_asks_nobody() -> None:
    bench = guarded()
    bench.mode("AUTO.LAND")
    heard = ask(bench)
    assert acks(heard) == [(ARM, Result.TEMPORARILY_REJECTED)]
    assert requests(heard) == []


def test_a_reboot_forgets_what_was_granted() -> None:
    bench = guarded(IN_TWO)
    ask(bench)
    answer(bench, Result.ACCEPTED, param2=200)
    assert bench.autopilot.reboot() is Result.ACCEPTED
    bench.advance(2 * S)
    assert len(requests(ask(bench))) == 1


def test_a_mission_that_arms_waits_for_the_authorizer_too() -> None:
    bench = guarded()
    bench.autopilot.load_plan((item(0, 22, up_m=4.0), item(1, 21)))
    heard = bench.send(long(Cmd.MISSION_START)) + bench.advance(100 * MS)
    assert acks(heard) == []
    assert len(requests(heard)) == 1
    assert acks(answer(bench, Result.ACCEPTED, param2=30)) == [(MISSION_START, Result.ACCEPTED)]
    assert bench.autopilot.armed
