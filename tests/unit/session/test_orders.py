"""Commands on their way to an autopilot that is not ready yet, or says nothing."""

from __future__ import annotations

from gcs.gate.effects import CommandKind, SendCommand
from gcs.gate.inputs import CommandEnded
from gcs.gate.permit import issue
from gcs.protocol.effects import Heard
from gcs.session.orders import Orders, Out
from gcs.wire.ids import Cmd, Result
from gcs.wire.messages import CommandAck, CommandLong
from tests.unit.session.vehicles import SECOND_NS, vehicle

DEADLINE_NS = 5 * SECOND_NS


def arm(orders: Orders, now_ns: int = 0, *, prearm_ok: bool | None = True) -> list[Out]:
    permit = issue(None, None, now_ns, "a test")
    seen = vehicle()
    seen.prearm_ok = prearm_ok
    return orders.send(SendCommand(7, CommandKind.ARM, DEADLINE_NS, permit), seen, now_ns)


def answer(orders: Orders, result: Result, now_ns: int) -> list[Out]:
    ack = CommandAck(command=Cmd.COMPONENT_ARM_DISARM, result=result)
    return orders.heard(Heard(1, 1, ack), now_ns)


def commands(out: list[Out]) -> int:
    return sum(isinstance(item, CommandLong) for item in out)


def test_not_yet_is_asked_again_until_it_is_yes() -> None:
    orders = Orders(255, 190)
    assert commands(arm(orders)) == 1
    assert not [x for x in answer(orders, Result.TEMPORARILY_REJECTED, 1) if not isinstance(x, str)]
    assert orders.deadline_ns is not None
    assert commands(orders.wake(orders.deadline_ns)) == 1
    ended = answer(orders, Result.ACCEPTED, SECOND_NS)
    assert ended == [CommandEnded(7, CommandKind.ARM, Result.ACCEPTED)]


def test_not_yet_is_not_asked_again_past_the_deadline() -> None:
    orders = Orders(255, 190)
    arm(orders)
    now_ns, tries, ended = 0, 1, False
    while not ended:
        out = answer(orders, Result.TEMPORARILY_REJECTED, now_ns)
        ended = any(isinstance(item, CommandEnded) for item in out)
        if not ended:
            assert orders.deadline_ns is not None
            now_ns = orders.deadline_ns
            tries += commands(orders.wake(now_ns))
    assert now_ns < DEADLINE_NS
    assert tries == 10


def test_a_no_is_a_no() -> None:
    orders = Orders(255, 190)
    arm(orders)
    ended = answer(orders, Result.DENIED, 1)
    assert ended == [CommandEnded(7, CommandKind.ARM, Result.DENIED)]
    assert orders.deadline_ns is None


def test_a_disarm_takes_back_the_arm_that_waits() -> None:
    orders = Orders(255, 190)
    arm(orders)
    answer(orders, Result.TEMPORARILY_REJECTED, 1)
    out = orders.send(SendCommand(8, CommandKind.DISARM, DEADLINE_NS), vehicle(), 2)
    assert CommandEnded(7, CommandKind.ARM, Result.TEMPORARILY_REJECTED) in out
    answer(orders, Result.ACCEPTED, 3)
    assert orders.deadline_ns is None


def test_silence_is_no_answer() -> None:
    orders = Orders(255, 190)
    arm(orders)
    out: list[Out] = []
    while orders.deadline_ns is not None:
        out = orders.wake(orders.deadline_ns)
    (ended,) = out
    assert isinstance(ended, CommandEnded)
    assert ended.result is None


def test_a_vehicle_that_says_it_would_not_arm_is_not_asked_until_the_time_is_nearly_over() -> None:
    orders = Orders(255, 190)
    assert commands(arm(orders, prearm_ok=False)) == 0
    now_ns, sent = 0, 0
    while not sent:
        assert orders.deadline_ns is not None
        now_ns = orders.deadline_ns
        sent = commands(orders.wake(now_ns))
    assert DEADLINE_NS - SECOND_NS < now_ns < DEADLINE_NS


def test_a_vehicle_that_says_nothing_of_its_checks_is_asked_a_little_later() -> None:
    orders = Orders(255, 190)
    assert commands(arm(orders, prearm_ok=None)) == 0
    assert orders.deadline_ns is not None
    assert commands(orders.wake(orders.deadline_ns)) == 1
