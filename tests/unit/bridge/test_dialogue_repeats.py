"""A command that is sent again: a repetition whose answer was lost, or a new wish?"""

from __future__ import annotations

from collections.abc import Sequence

from gcs import ipc
from gcs.bridge.conversation.dialogue import Dialogue
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import BridgeEffect, ClientRequest, Reply
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd, Result
from gcs.wire.messages import CommandAck, CommandLong, ManualControl

MS = 1_000_000
CLIENT = From(1, Address(255, 190), Address(1, 1))


class Client:
    """One client; every request that it makes is accepted and completes at once."""

    def __init__(self) -> None:
        self.dialogue, self.now_ns, self.operation = Dialogue(1000), 0, 0

    def sends(self, command: int, word: str, outcome: str = "complete", after_ms: int = 500) -> str:
        """What came of it: asked, or answered from memory."""
        self.now_ns += after_ms * MS
        message = CommandLong(0, 0, 0, 0, 0, 0, 0, command, 1, 1, 0)
        effects = self.dialogue.ask(CLIENT, message, (ipc.Ask(0, word),), self.now_ns)
        (effect,) = effects
        if isinstance(effect, Reply):
            assert isinstance(effect.message, CommandAck)
            return f"answered {Result(effect.message.result).name}"
        assert isinstance(effect, ClientRequest)
        assert isinstance(effect.command, ipc.Ask)
        number = effect.command.id
        self.operation += 1
        if outcome == "refused":
            refused = ipc.VerdictEvent(number, word, "refused", "BUSY", operation=self.operation)
            self.dialogue.told(refused, self.now_ns)
            return "asked"
        accepted = ipc.VerdictEvent(number, word, "accepted", operation=self.operation)
        self.dialogue.told(accepted, self.now_ns)
        if outcome == "complete":
            self.dialogue.told(ipc.EndingEvent(number, word, "complete"), self.now_ns)
        return "asked"


def results(effects: Sequence[BridgeEffect]) -> list[int]:
    messages = [each.message for each in effects if isinstance(each, Reply)]
    return [each.result for each in messages if isinstance(each, CommandAck)]


def test_a_repetition_is_answered_and_not_asked_twice() -> None:
    client = Client()
    assert client.sends(Cmd.NAV_TAKEOFF, "takeoff", outcome="under way") == "asked"
    assert client.sends(Cmd.NAV_TAKEOFF, "takeoff") == "answered IN_PROGRESS"
    client = Client()
    assert client.sends(Cmd.COMPONENT_ARM_DISARM, "arm") == "asked"
    assert client.sends(Cmd.COMPONENT_ARM_DISARM, "arm") == "answered ACCEPTED"
    assert client.sends(Cmd.COMPONENT_ARM_DISARM, "arm", after_ms=2500) == "asked"


def test_the_mode_of_a_mission_that_begins_is_answered_once() -> None:
    """MAVSDK 3.17 asks again after half a second, and takes IN_PROGRESS for the last answer; not
    so in `offboard.start`, which would give up after 2 s without."""
    client = Client()
    assert client.sends(Cmd.DO_SET_MODE, "mission_start", outcome="under way") == "asked"
    again = CommandLong(0, 0, 0, 0, 0, 0, 0, Cmd.DO_SET_MODE, 1, 1, 1)
    asks = (ipc.Ask(0, "mission_start"),)
    assert client.dialogue.ask(CLIENT, again, asks, client.now_ns + 500 * MS) == []
    done = client.dialogue.command_answered(client.operation, Result.ACCEPTED, client.now_ns)
    assert results(done) == [Result.ACCEPTED]
    client = Client()
    assert client.sends(Cmd.DO_SET_MODE, "resume", outcome="under way") == "asked"
    assert client.sends(Cmd.DO_SET_MODE, "resume") == "answered IN_PROGRESS"


def test_what_asks_for_nothing_is_nothing_in_between() -> None:
    """Sticks in the middle, 25 times a second."""
    client = Client()
    assert client.sends(Cmd.COMPONENT_ARM_DISARM, "arm") == "asked"
    middle = ManualControl(x=0, y=0, z=500, r=0, buttons=0, target=1)
    assert client.dialogue.ask(CLIENT, middle, (), client.now_ns) == []
    assert client.sends(Cmd.COMPONENT_ARM_DISARM, "arm") == "answered ACCEPTED"


def test_a_stop_is_never_answered_from_memory() -> None:
    """Somebody else may have let it fly on meanwhile (invariant 10)."""
    client = Client()
    for command, word in (
        (Cmd.DO_PAUSE_CONTINUE, "hold"),
        (Cmd.NAV_LAND, "land"),
        (Cmd.NAV_RETURN_TO_LAUNCH, "rtl"),
    ):
        assert client.sends(command, word) == "asked"
        assert client.sends(command, word) == "asked"


def test_what_came_between_makes_it_a_new_wish() -> None:
    client = Client()
    assert client.sends(Cmd.COMPONENT_ARM_DISARM, "arm") == "asked"
    assert client.sends(Cmd.DO_SET_MODE, "control") == "asked"
    assert client.sends(Cmd.COMPONENT_ARM_DISARM, "arm") == "asked"


def test_a_refusal_is_decided_anew() -> None:
    """BUSY a second ago says nothing of now."""
    client = Client()
    assert client.sends(Cmd.DO_REPOSITION, "goto", outcome="refused") == "asked"
    assert client.sends(Cmd.DO_REPOSITION, "goto") == "asked"


def test_an_answer_holds_no_more_where_a_heartbeat_shows_a_change() -> None:
    """Armed, disarmed by somebody past the bridge, and to be armed again; or a pilot's mode."""
    for mode_name, armed in (("AUTO.LOITER", False), ("POSCTL", True)):
        client = Client()
        client.dialogue.shown("AUTO.LOITER", armed=True)
        assert client.sends(Cmd.COMPONENT_ARM_DISARM, "arm") == "asked"
        client.dialogue.shown("AUTO.LOITER", armed=True)
        assert client.sends(Cmd.COMPONENT_ARM_DISARM, "arm") == "answered ACCEPTED"
        client.dialogue.shown(mode_name, armed=armed)
        assert client.sends(Cmd.COMPONENT_ARM_DISARM, "arm") == "asked"


def test_what_is_under_way_is_not_asked_twice_whatever_heartbeats_show() -> None:
    """A take-off's own mode is shown while it climbs."""
    client = Client()
    assert client.sends(Cmd.NAV_TAKEOFF, "takeoff", outcome="under way") == "asked"
    client.dialogue.shown("AUTO.TAKEOFF", armed=True)
    assert client.sends(Cmd.NAV_TAKEOFF, "takeoff") == "answered IN_PROGRESS"


def test_a_sample_of_a_stream_in_between_makes_it_a_new_wish() -> None:
    """It is not where its go-to has led any more."""
    client = Client()
    assert client.sends(Cmd.DO_REPOSITION, "goto") == "asked"
    assert client.sends(Cmd.DO_REPOSITION, "goto") == "answered ACCEPTED"
    client.dialogue.stream(CLIENT, ipc.Stream(v_enu=(1.0, 0.0, 0.0)))
    assert client.sends(Cmd.DO_REPOSITION, "goto") == "asked"


def test_who_is_not_in_control_any_more_is_told_nothing_from_memory() -> None:
    """Its mission is flown on for somebody else."""
    client = Client()
    assert client.sends(Cmd.MISSION_START, "mission_start", outcome="under way") == "asked"
    client.dialogue.command_answered(client.operation, Result.ACCEPTED, client.now_ns)
    assert client.sends(Cmd.MISSION_START, "mission_start") == "answered ACCEPTED"
    client.dialogue.control_lost()
    assert client.sends(Cmd.MISSION_START, "mission_start", outcome="refused") == "asked"


def test_a_stop_after_something_else_is_no_repetition_of_one_under_way() -> None:
    """It was refused, but who stops again means to stop."""
    client = Client()
    assert client.sends(Cmd.DO_PAUSE_CONTINUE, "hold", outcome="under way") == "asked"
    assert client.sends(Cmd.DO_PAUSE_CONTINUE, "hold") == "answered IN_PROGRESS", "sent again"
    assert client.sends(Cmd.DO_SET_MODE, "control", outcome="refused") == "asked"
    assert client.sends(Cmd.DO_PAUSE_CONTINUE, "hold", outcome="under way") == "asked"


def test_a_stop_that_the_same_stop_replaces_is_answered_as_that_one() -> None:
    client = Client()
    assert client.sends(Cmd.DO_PAUSE_CONTINUE, "hold", outcome="under way") == "asked"
    assert client.sends(Cmd.DO_SET_MODE, "control", outcome="refused") == "asked"
    assert client.sends(Cmd.DO_PAUSE_CONTINUE, "hold", outcome="under way") == "asked"
    over = ipc.EndingEvent(1, "hold", "superseded", "SUPERSEDED", "a later request took its place")
    assert client.dialogue.told(over, client.now_ns) == []
    both = client.dialogue.told(ipc.EndingEvent(3, "hold", "complete"), client.now_ns)
    assert results(both) == [0, 0]


def test_a_return_that_the_same_return_replaces_is_answered_with_that_one() -> None:
    """By the vehicle's answer, long before either ends."""
    client = Client()
    assert client.sends(Cmd.NAV_RETURN_TO_LAUNCH, "rtl", outcome="under way") == "asked"
    assert client.sends(Cmd.DO_SET_MODE, "control", outcome="refused") == "asked"
    assert client.sends(Cmd.NAV_RETURN_TO_LAUNCH, "rtl", outcome="under way") == "asked"
    over = ipc.EndingEvent(1, "rtl", "superseded", "SUPERSEDED", "a later request took its place")
    assert client.dialogue.told(over, client.now_ns) == []
    both = client.dialogue.command_answered(client.operation, Result.ACCEPTED, client.now_ns)
    assert results(both) == [0, 0]


def test_three_stops_are_answered_as_the_last_one_is() -> None:
    """A request of somebody else takes its place in the end."""
    client = Client()
    for number in (1, 3, 5):
        assert client.sends(Cmd.DO_PAUSE_CONTINUE, "hold", outcome="under way") == "asked"
        over = ipc.EndingEvent(number - 2, "hold", "aborted", "OPERATOR", "stopped")
        assert client.dialogue.told(over, client.now_ns) == []
        assert client.sends(Cmd.DO_SET_MODE, "control", outcome="refused") == "asked"
    over = ipc.EndingEvent(5, "hold", "superseded", "SUPERSEDED", "a later request took its place")
    assert len(results(client.dialogue.told(over, client.now_ns))) == 3
    assert client.dialogue.told(over, client.now_ns) == []
