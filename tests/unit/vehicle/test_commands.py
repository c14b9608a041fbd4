"""Commands on their way to an autopilot that is not ready yet, or says nothing."""

from __future__ import annotations

import pytest

from gcs.gate.effects import CommandKind, SendCommand
from gcs.gate.inputs import CommandEnded
from gcs.gate.permit import issue
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.protocol.effects import Address, Heard, Send
from gcs.session.speedup_waits import Times
from gcs.session.work import GateInput, Log, Work
from gcs.vehicle.talk.commands import Commands
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import Cmd, Result
from gcs.wire.messages import CommandAck, CommandLong
from tests.unit.station.vehicles import HOME, SECOND_NS, vehicle

OWN = Address(255, 190)
DEADLINE_NS = 5 * SECOND_NS


def told(*, prearm_ok: bool | None = True) -> Telemetry:
    """A vehicle that says this of its pre-arm checks."""
    telemetry = vehicle()
    telemetry.prearm_ok = prearm_ok
    return telemetry


def arm(commands: Commands, telemetry: Telemetry, now_ns: int = 0) -> list[Work]:
    permit = issue(None, None, now_ns, "a test")
    return commands.send(SendCommand(7, CommandKind.ARM, DEADLINE_NS, permit), telemetry, now_ns)


def answer(commands: Commands, result: Result, now_ns: int) -> list[Work]:
    ack = CommandAck(command=Cmd.COMPONENT_ARM_DISARM, result=result)
    return commands.heard(Heard(1, 1, ack), now_ns)


def sent(work: list[Work]) -> int:
    return sum(isinstance(item, Send) for item in work)


def answers(work: list[Work]) -> list[CommandEnded]:
    """What the gate is told."""
    given = [item.given for item in work if isinstance(item, GateInput)]
    return [answer for answer in given if isinstance(answer, CommandEnded)]


def test_not_yet_is_asked_again_until_it_is_yes() -> None:
    commands = Commands(OWN, Times())
    assert sent(arm(commands, told())) == 1
    (line,) = answer(commands, Result.TEMPORARILY_REJECTED, 1)
    assert isinstance(line, Log)
    assert commands.deadline_ns is not None
    assert sent(commands.wake(told(), commands.deadline_ns)) == 1
    ended = answer(commands, Result.ACCEPTED, SECOND_NS)
    assert answers(ended) == [CommandEnded(7, CommandKind.ARM, Result.ACCEPTED)]


def test_not_yet_is_not_asked_again_past_the_deadline() -> None:
    commands = Commands(OWN, Times())
    arm(commands, told())
    now_ns, tries, ended = 0, 1, False
    while not ended:
        out = answer(commands, Result.TEMPORARILY_REJECTED, now_ns)
        ended = bool(answers(out))
        if not ended:
            assert commands.deadline_ns is not None
            now_ns = commands.deadline_ns
            tries += sent(commands.wake(told(), now_ns))
    assert now_ns < DEADLINE_NS
    assert tries == 10


def test_a_no_is_a_no() -> None:
    commands = Commands(OWN, Times())
    arm(commands, told())
    ended = answer(commands, Result.DENIED, 1)
    assert answers(ended) == [CommandEnded(7, CommandKind.ARM, Result.DENIED)]
    assert commands.deadline_ns is None


def test_a_disarm_takes_back_the_arm_that_waits() -> None:
    commands = Commands(OWN, Times())
    arm(commands, told())
    answer(commands, Result.TEMPORARILY_REJECTED, 1)
    out = commands.send(SendCommand(8, CommandKind.DISARM, DEADLINE_NS), vehicle(), 2)
    assert CommandEnded(7, CommandKind.ARM, Result.TEMPORARILY_REJECTED) in answers(out)
    answer(commands, Result.ACCEPTED, 3)
    assert commands.deadline_ns is None


def test_silence_is_no_answer() -> None:
    commands = Commands(OWN, Times())
    arm(commands, told())
    out: list[Work] = []
    while commands.deadline_ns is not None:
        out = commands.wake(told(), commands.deadline_ns)
    (ended,) = answers(out)
    assert ended.result is None


@pytest.mark.parametrize(
    ("kind", "tries"),
    [
        (CommandKind.LAND, 11),
        (CommandKind.RETURN, 11),
        (CommandKind.ARM, 4),
        (CommandKind.HOLD, 4),
    ],
)
def test_only_what_brings_it_down_is_tried_until_its_deadline(
    kind: CommandKind, tries: int
) -> None:
    commands = Commands(OWN, Times())
    wanted = SendCommand(7, kind, DEADLINE_NS, issue(None, None, 0, "a test"))
    count = sent(commands.send(wanted, vehicle(), 0))
    out: list[Work] = []
    while commands.deadline_ns is not None:
        now_ns = commands.deadline_ns
        out = commands.wake(told(), now_ns)
        count += sent(out)
        assert not sent(out) or now_ns <= DEADLINE_NS
    assert count == tries
    assert [ended.result for ended in answers(out)] == [None]


def test_a_vehicle_that_says_it_would_not_arm_is_not_asked_until_the_time_is_nearly_over() -> None:
    commands = Commands(OWN, Times())
    assert sent(arm(commands, told(prearm_ok=False))) == 0
    now_ns, tries = 0, 0
    while not tries:
        assert commands.deadline_ns is not None
        now_ns = commands.deadline_ns
        tries = sent(commands.wake(told(prearm_ok=False), now_ns))
    assert DEADLINE_NS - SECOND_NS < now_ns < DEADLINE_NS


def test_a_vehicle_that_says_nothing_of_its_checks_is_asked_at_once() -> None:
    """PX4 1.14 never says that it has the bit (autopilots.md, defect 12): every arm waited."""
    commands = Commands(OWN, Times())
    assert sent(arm(commands, told(prearm_ok=None))) == 1


def test_an_arm_that_waits_and_is_taken_back_is_not_asked_again() -> None:
    commands = Commands(OWN, Times())
    arm(commands, told())
    answer(commands, Result.TEMPORARILY_REJECTED, 1)
    assert commands.cancel(7, CommandKind.ARM, 2) == []
    assert commands.deadline_ns is None
    assert commands.wake(told(), 4 * SECOND_NS) == []


def test_the_taking_back_of_another_request_s_arm_changes_nothing() -> None:
    commands = Commands(OWN, Times())
    arm(commands, told())
    answer(commands, Result.TEMPORARILY_REJECTED, 1)
    commands.cancel(8, CommandKind.ARM, 2)
    commands.cancel(7, CommandKind.LAND, 2)
    assert commands.deadline_ns is not None
    assert sent(commands.wake(told(), commands.deadline_ns)) == 1


@pytest.mark.parametrize(
    ("autopilot", "altitude_m"),
    [
        (PX4, 488.0 + 3.0 + 10.0),  # above the sea
        (ARDUPILOT, 2.0 + 10.0),  # above home
    ],
)
def test_a_climb_counts_from_where_the_vehicle_stands(
    autopilot: Autopilot, altitude_m: float
) -> None:
    """The origin lies 488 m above the sea, home 1 m above it, and the vehicle 2 m above home."""
    telemetry = vehicle(autopilot)
    telemetry.origin, telemetry.home_ned, telemetry.pos_ned = (
        HOME,
        (5.0, 5.0, -1.0),
        (9.0, 9.0, -3.0),
    )
    permit = issue(None, None, 0, "a test")
    wanted = SendCommand(7, CommandKind.TAKE_OFF, DEADLINE_NS, permit, up_m=10.0)
    (climb,) = Commands(OWN, Times()).send(wanted, telemetry, 0)
    assert isinstance(climb, Send)
    assert isinstance(climb.message, CommandLong)
    assert climb.message.command == Cmd.NAV_TAKEOFF
    assert climb.message.param7 == pytest.approx(altitude_m)


def test_a_picture_that_is_answered_late_is_answered() -> None:
    """autopilots.md, defect 8: given up after half a second, on a link with a longer round trip."""
    commands = Commands(OWN, Times())
    commands.send(SendCommand(7, CommandKind.PHOTO, DEADLINE_NS), vehicle(), 0)
    assert commands.deadline_ns == DEADLINE_NS
    assert commands.wake(vehicle(), 4 * SECOND_NS) == []
    taken = CommandAck(command=Cmd.IMAGE_START_CAPTURE, result=Result.ACCEPTED)
    ended = commands.heard(Heard(1, 1, taken), 4 * SECOND_NS)
    assert answers(ended) == [CommandEnded(7, CommandKind.PHOTO, Result.ACCEPTED)]


def test_every_picture_has_a_number_of_its_own_and_one_try() -> None:
    """IMAGE_START_CAPTURE: param3 is how many, param4 the number that tells a repetition."""
    commands = Commands(OWN, Times())
    numbers = []
    for _ in range(2):
        photo = SendCommand(7, CommandKind.PHOTO, DEADLINE_NS)
        (taken,) = commands.send(photo, vehicle(), 0)
        assert isinstance(taken, Send)
        assert isinstance(taken.message, CommandLong)
        assert (taken.message.command, taken.message.param3) == (Cmd.IMAGE_START_CAPTURE, 1.0)
        numbers.append(taken.message.param4)
        out: list[Work] = []
        while commands.deadline_ns is not None:
            out += commands.wake(vehicle(), commands.deadline_ns)
        assert sent(out) == 0
    assert len(set(numbers)) == 2
