"""Several operators of one station: who is told what, who may ask for what, and who leaves."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.config import StationConfig
from gcs.session.effects import EVERYONE, Effect, Emit, ShowTopics
from gcs.session.inputs import (
    ClientCame,
    Datagram,
    OperatorGone,
    OperatorJoined,
    OperatorNoise,
    SignalCame,
)
from tests.unit.station import told, wire
from tests.unit.station.station import Script

SECOND = 2
KEPT = StationConfig(keep=True)


def join(script: Script, client: int = SECOND, *, hold_on_leave: bool = True) -> list[Effect]:
    return script.feed(OperatorJoined(client, f"test {client}", hold_on_leave))


def to(client: int, effects: list[Effect]) -> list[ipc.Event]:
    """What one operator is told, without the log."""
    events = [e.event for e in effects if isinstance(e, Emit) and e.operator in (client, EVERYONE)]
    return [event for event in events if not isinstance(event, ipc.LogEvent)]


def in_control(script: Script) -> int:
    return told.events(script.told, ipc.Operators)[-1].in_control


def holds(script: Script) -> int:
    """How often px4's AUTO.LOITER was asked for."""
    sent = wire.sent(script.told, "COMMAND_LONG")
    return sum((m.command, m.param2, m.param3) == (176, 4, 3) for m in sent)


class TestWhoIsTold:
    def test_one_that_joins_is_told_where_everything_stands(self) -> None:
        script = Script().met()
        hello, snapshot, history, operators = to(SECOND, join(script))
        assert isinstance(hello, ipc.Hello)
        assert (hello.client, hello.schema, hello.log_path) == (SECOND, 1, "logs/a.mcap")
        assert [zone.name for zone in hello.fence] == ["home"]
        assert isinstance(snapshot, ipc.Snapshot)
        assert snapshot.state == "GROUNDED"
        assert isinstance(history, ipc.History)
        assert history.trail[-1].pos_enu == snapshot.pos_enu
        assert "Current State: GROUNDED" in [line.text for line in history.log]
        assert history.in_air_since_ns is None
        names = [ipc.OperatorInfo(1, "first operator"), ipc.OperatorInfo(SECOND, "test 2")]
        assert operators == ipc.Operators(names, 1)

    def test_the_one_that_was_there_is_told_of_it_but_not_the_rest_again(self) -> None:
        script = Script().met()
        (operators,) = to(1, join(script))
        assert isinstance(operators, ipc.Operators)

    def test_answers_go_to_the_one_that_asked_and_facts_to_all(self) -> None:
        script = Script().hovering()
        join(script)
        script.forget()
        script.ask("goto", goal_enu=(2.0, 0.0, 5.0))
        script.run(0.2)
        kinds = {type(event) for event in to(SECOND, script.told)}
        assert kinds == {ipc.StateEvent, ipc.Operation, ipc.Snapshot}
        assert {ipc.VerdictEvent, ipc.StateEvent} <= {type(e) for e in to(1, script.told)}

    def test_who_started_a_bridge_and_looks_alone_is_shown_two_snapshots_a_second(self) -> None:
        script = Script(config=StationConfig(bridge=True)).met()
        script.feed(ClientCame(1, "udp 127.0.0.1:5", False))
        script.feed(Datagram(1, wire.Sender(sysid=254).frame(wire.heartbeat())))
        script.forget()
        script.run(2.0)
        assert len(told.snapshots(script.told)) == 4
        join(script)
        script.forget()
        script.run(2.0)
        assert len(told.snapshots(script.told)) == 20

    def test_who_started_a_station_is_shown_ten_though_nobody_else_looks(self) -> None:
        script = Script().met()
        script.forget()
        script.run(2.0)
        assert len(told.snapshots(script.told)) == 20

    def test_equal_numbers_of_two_operators_are_two_requests(self) -> None:
        script = Script().hovering()
        join(script)
        script.forget()
        script.say(ipc.Ask(7, "hold"))
        script.say(ipc.Ask(7, "land"), SECOND)
        mine = [e for e in to(1, script.told) if isinstance(e, ipc.EndingEvent | ipc.VerdictEvent)]
        theirs = [e for e in to(SECOND, script.told) if isinstance(e, ipc.VerdictEvent)]
        assert {event.word for event in mine} == {"hold"}
        assert {event.word for event in theirs} == {"land"}

    def test_noise_is_answered_to_whoever_made_it(self) -> None:
        script = Script().met()
        join(script)
        effects = script.feed(OperatorNoise(SECOND, "bad: b'x'"))
        assert to(1, effects) == []
        assert to(SECOND, effects) == [ipc.Trouble("not a command: bad: b'x'")]

    def test_what_an_operator_said_is_recorded_with_its_number(self) -> None:
        script = Script().met()
        join(script)
        script.ask("land", client=SECOND)
        kinds = [(item.kind, bytes(item.data)) for item in told.recorded(script.told, "InputItem")]
        said = [data for kind, data in kinds if kind == "OperatorLine"]
        assert said == [b'{"client":2,"command":{"type":"ask","id":1,"word":"land"}}']
        assert ("OperatorJoined" in [kind for kind, _ in kinds]) is True


class TestControl:
    @pytest.mark.parametrize("word", ["arm", "resume", "photo", "mission_start", "mission_clear"])
    def test_who_only_looks_is_refused_and_told_who_is_in_control(self, word: str) -> None:
        script = Script().met()
        join(script)
        number = script.ask(word, client=SECOND)
        (verdict,) = told.events(script.told, ipc.VerdictEvent)
        assert (verdict.id, verdict.outcome, verdict.code) == (number, "refused", "OTHER_OPERATOR")
        assert verdict.sentence == (
            "operator 1 (first operator) is in control of this station; "
            "take it over with --take, or by the words `station take`"
        )
        assert verdict.numbers == {"in_control": 1.0}
        assert wire.sent(script.told[-3:], "COMMAND_LONG") == []

    @pytest.mark.parametrize("word", ["abort", "hold", "land", "rtl"])
    def test_whoever_looks_may_stop_the_vehicle(self, word: str) -> None:
        script = Script().hovering()
        join(script)
        script.ask(word, client=SECOND)
        # The return height is not known here, which is the gate's reason and not the operator's.
        code = "RTL_BLOCKED" if word == "rtl" else ""
        assert told.verdicts(script.told)[-1][2] == code
        assert (in_control(script), holds(script)) == (1, int(word != "land"))

    def test_on_the_ground_anyone_may_disarm_but_not_by_force(self) -> None:
        script = Script().met()
        script.armed = True
        script.report()
        join(script)
        script.ask("disarm", client=SECOND)
        script.say(ipc.Ask(9, "disarm", force=True), SECOND)
        assert told.verdicts(script.told) == [(1, "accepted", ""), (9, "refused", "OTHER_OPERATOR")]

    def test_taking_over_is_a_request_and_all_are_told(self) -> None:
        script = Script().hovering()
        join(script)
        script.forget()
        taken = script.ask("station_take", client=SECOND)
        assert told.outcomes(script.told) == [(taken, "complete", "")]
        assert in_control(script) == SECOND
        assert (
            "operator 2 (test 2) is in control of the station, "
            "taken over from operator 1 (first operator)"
        ) in told.log(script.told)
        refused = script.ask("goto", goal_enu=(1.0, 0.0, 5.0))
        goes = script.ask("goto", goal_enu=(1.0, 0.0, 5.0), client=SECOND)
        script.run(0.1)
        assert (refused, "refused", "OTHER_OPERATOR") in told.verdicts(script.told)
        assert (goes, "accepted", "") in told.verdicts(script.told)
        assert holds(script) == 0

    def test_every_snapshot_tells_who_is_in_control(self) -> None:
        def shown() -> ipc.OperatorInfo | None:
            script.run(0.2)
            return told.events(script.told, ipc.Snapshot)[-1].in_control

        script = Script(config=KEPT).hovering()
        join(script, hold_on_leave=False)
        assert shown() == ipc.OperatorInfo(1, "first operator")
        script.ask("station_take", client=SECOND)
        assert shown() == ipc.OperatorInfo(SECOND, "test 2")
        script.feed(OperatorGone(1, "lost"))
        script.feed(OperatorGone(SECOND, "lost"))
        assert shown() is None

    def test_one_who_has_left_is_not_heard(self) -> None:
        script = Script().met()
        join(script)
        script.feed(OperatorGone(SECOND, "lost"))
        script.ask("land", client=SECOND)
        assert told.verdicts(script.told)[-1][2] == "OPERATOR_LOST"


class TestLeaving:
    def test_who_only_looked_leaves_without_a_trace(self) -> None:
        script = Script().hovering()
        join(script)
        script.forget()
        effects = script.say(ipc.Leave("done"), SECOND)
        (bye,) = [event for event in to(SECOND, effects) if isinstance(event, ipc.Bye)]
        assert (bye.exit_code, bye.goes_on) == (0, True)
        assert not any(isinstance(event, ipc.Bye) for event in to(1, effects))
        script.run(1.0)
        assert (script.state, holds(script)) == ("HOVERING", 0)

    def test_one_that_was_in_control_leaves_a_vehicle_that_holds(self) -> None:
        script = Script().hovering()
        join(script)
        script.ask("station_take", client=SECOND)
        script.forget()
        script.say(ipc.Leave("done"), SECOND)
        assert holds(script) == 1
        assert told.events(script.told, ipc.Bye) == []
        script.mode = wire.LOITER
        script.run(0.3)
        (bye,) = told.events(script.told, ipc.Bye)
        assert bye.sentence == "the vehicle is STILL FLYING in AUTO.LOITER, 5.0 m up"
        assert in_control(script) == 1
        script.ask("resume")
        assert told.verdicts(script.told)[-1][1] == "accepted", "the first operator goes on"

    def test_a_one_shot_that_was_in_control_leaves_the_vehicle_as_it_is(self) -> None:
        script = Script().hovering()
        join(script, hold_on_leave=False)
        script.ask("station_take", client=SECOND)
        script.forget()
        script.say(ipc.Leave("done"), SECOND)
        assert (in_control(script), holds(script), script.state) == (1, 0, "HOVERING")
        (bye,) = told.events(script.told, ipc.Bye)
        assert bye.sentence == "the station goes on", "nothing of a hold that is not waited for"

    def test_an_interrupted_one_shot_leaves_the_vehicle_held_if_it_was_in_control(self) -> None:
        script = Script().hovering()
        for client, taken in ((SECOND, 1), (SECOND + 1, 0)):
            join(script, client, hold_on_leave=False)
            if taken:
                script.ask("station_take", client=client)
            script.forget()
            script.say(ipc.Leave("interrupted", hold=True), client)
            assert holds(script) == taken
            script.mode = wire.LOITER
            script.run(0.3)
            (bye,) = told.events(script.told, ipc.Bye)
            assert ("AUTO.LOITER" in bye.sentence) == bool(taken)
            assert in_control(script) == 1

    @pytest.mark.parametrize("hold_on_leave", [False, True])
    def test_one_that_is_lost_in_control_leaves_a_vehicle_that_holds(
        self, hold_on_leave: bool
    ) -> None:
        script = Script().hovering()
        join(script, hold_on_leave=hold_on_leave)
        script.ask("station_take", client=SECOND)
        script.forget()
        script.feed(OperatorGone(SECOND, "its connection ended"))
        assert (in_control(script), holds(script)) == (1, 1)
        assert told.finishes(script.told) == []

    def test_the_station_ends_with_its_first_operator_whoever_is_in_control(self) -> None:
        script = Script().hovering()
        join(script)
        script.ask("station_take", client=SECOND)
        script.say(ipc.Leave("quit"))
        script.run(4.0)
        assert len(told.finishes(script.told)) == 1

    @pytest.mark.parametrize("goes", ["leave", "lost", "SIGHUP"])
    def test_a_kept_station_holds_and_lives_on(self, goes: str) -> None:
        script = Script(config=KEPT).hovering()
        script.forget()
        match goes:
            case "leave":
                script.say(ipc.Leave("quit"))
            case "lost":
                script.feed(OperatorGone(1, "the command stream ended"))
            case _:
                script.feed(SignalCame(goes))
        assert holds(script) == 1
        script.mode = wire.LOITER
        script.run(5.0)
        assert told.finishes(script.told) == []
        assert in_control(script) == 0
        assert len(told.events(script.told, ipc.Bye)) == (goes == "leave")

    def test_where_nobody_is_in_control_the_first_who_asks_gets_it(self) -> None:
        script = Script(config=KEPT).hovering()
        script.say(ipc.Leave("quit"))
        script.mode = wire.LOITER
        script.run(0.5)
        join(script)
        script.ask("hold", client=SECOND)
        assert in_control(script) == 0, "what anyone may ask for takes nothing"
        resumed = script.ask("resume", client=SECOND)
        assert in_control(script) == SECOND
        assert (resumed, "accepted", "") in told.verdicts(script.told)

    def test_a_kept_station_ends_by_a_signal_or_by_a_word(self) -> None:
        for end in (SignalCame("SIGTERM"), None):
            script = Script(config=KEPT).met()
            join(script)
            if end is None:
                script.feed(OperatorGone(1, "lost"))
                script.ask("station_end", client=SECOND)
            else:
                script.feed(end)
            assert len(told.finishes(script.told)) == 1


def test_who_wants_to_watch_the_topics_is_shown_them_by_the_shell() -> None:
    script = Script().hovering()
    join(script)
    for client in (1, SECOND):
        shown = [e for e in script.say(ipc.WatchTopics(), client) if isinstance(e, ShowTopics)]
        assert shown == [ShowTopics(client)]


class TestOperations:
    def operations(self, script: Script) -> list[tuple[str, int, str]]:
        (listed,) = to(SECOND, script.say(ipc.ListOperations(5), SECOND))
        assert isinstance(listed, ipc.OperationList)
        assert listed.id == 5
        return [(each.asked.word, each.client, each.state) for each in listed.operations]

    def test_anyone_sees_what_runs_and_how_it_ended(self) -> None:
        script = Script().hovering()
        join(script)
        script.ask("goto", goal_enu=(5.0, 0.0, 5.0))
        script.run(0.2)
        seen = [("control", 1, "complete"), ("goto", 1, "running")]
        assert self.operations(script) == seen
        script.ask("land", client=SECOND)
        expected = [*seen[:1], ("goto", 1, "superseded"), ("land", SECOND, "running")]
        assert self.operations(script) == expected

    def test_it_is_told_when_it_begins_and_when_it_has_ended(self) -> None:
        script = Script().hovering()
        script.forget()
        goal = script.ask("goto", goal_enu=(5.0, 0.0, 5.0))
        script.run(0.2)
        ended_ns = script.now_ns
        script.ask("abort")
        begun, ended = [
            each for each in told.events(script.told, ipc.Operation) if each.asked.id == goal
        ]
        (verdict,) = [e for e in told.events(script.told, ipc.VerdictEvent) if e.id == goal]
        assert (begun.id, begun.state, begun.ended_ns) == (verdict.operation, "running", None)
        assert (ended.state, ended.code, ended.ended_ns) == ("aborted", "OPERATOR", ended_ns)

    def test_a_stop_is_an_abort_by_anyone(self) -> None:
        script = Script().hovering()
        join(script)
        script.ask("goto", goal_enu=(5.0, 0.0, 5.0))
        script.run(0.2)
        running = told.events(script.told, ipc.Operation)[-1].id
        script.forget()
        script.ask("abort", client=SECOND, operation=running)
        assert holds(script) == 1
        assert script.state == "HOLDING"

    def test_what_has_ended_cannot_be_stopped_and_nothing_else_is(self) -> None:
        script = Script().hovering()
        done = told.events(script.told, ipc.Operation)[-1].id
        script.ask("goto", goal_enu=(5.0, 0.0, 5.0))
        script.run(0.2)
        for operation in (done, 4711):
            script.ask("abort", operation=operation)
            assert told.verdicts(script.told)[-1][1:] == ("refused", "NOT_RUNNING")
        assert script.state == "MOVING"

    def test_a_transfer_is_stopped_without_touching_the_flight(self) -> None:
        script = Script().hovering()
        download = script.ask("mission_download", path="box.plan")
        assert told.verdicts(script.told)[-1] == (download, "accepted", "")
        running = told.events(script.told, ipc.Operation)[-1].id
        stop = script.ask("abort", operation=running)
        assert (download, "aborted", "OPERATOR") in told.outcomes(script.told)
        assert (stop, "complete", "") in told.outcomes(script.told)
        assert script.state == "HOVERING"

    def test_only_the_latest_that_have_ended_are_kept(self) -> None:
        script = Script().met()
        join(script)
        for _ in range(80):
            script.ask("land", client=SECOND)
        assert len(self.operations(script)) == 51


class TestMessages:
    def subscribe(self, script: Script, *names: str) -> list[ipc.Event]:
        return to(SECOND, script.say(ipc.Subscribe(list(names)), SECOND))

    def test_a_message_is_told_with_its_fields_to_who_asked_for_it(self) -> None:
        script = Script().met()
        join(script)
        self.subscribe(script, "HOME_POSITION")
        script.forget()
        script.hear(wire.home())
        (event,) = [e for e in to(SECOND, script.told) if isinstance(e, ipc.MessageEvent)]
        assert event.name == "HOME_POSITION"
        assert event.fields["latitude"] == wire.home().latitude
        assert event.fields["q"] == [1.0, 0.0, 0.0, 0.0]
        assert not any(isinstance(e, ipc.MessageEvent) for e in to(1, script.told))

    def test_ten_times_a_second_at_most(self) -> None:
        script = Script().met()
        join(script)
        self.subscribe(script, "HEARTBEAT")
        script.forget()
        script.reporting = False
        for _ in range(20):
            script.hear(wire.heartbeat())
            script.run(0.05)
        assert len(told.events(script.told, ipc.MessageEvent)) == 10, "one of two"

    def test_a_name_that_no_message_has_is_told(self) -> None:
        script = Script().met()
        join(script)
        (trouble,) = self.subscribe(script, "BATTERY", "HEARTBEAT")
        assert isinstance(trouble, ipc.Trouble)
        assert trouble.text == "no such MAVLink message: BATTERY"

    def test_what_does_not_come_by_itself_is_asked_for(self) -> None:
        script = Script().met()
        join(script)
        self.subscribe(script, "BATTERY_STATUS", "HEARTBEAT")
        script.forget()
        script.run(2.5)
        asked = [m for m in script.sent("COMMAND_LONG") if m.command == 511]
        assert [(m.param1, m.param2) for m in asked] == [(147.0, 500_000.0)]
        script.run(2.0)
        asked = [m for m in script.sent("COMMAND_LONG") if m.command == 511]
        assert len(asked) == 2, "and again after a while"

    def test_one_that_left_is_told_no_more(self) -> None:
        script = Script().met()
        join(script)
        self.subscribe(script, "HEARTBEAT")
        script.say(ipc.Leave("done"), SECOND)
        script.forget()
        script.hear(wire.heartbeat())
        assert told.events(script.told, ipc.MessageEvent) == []
