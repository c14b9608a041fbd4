"""What operators' programs say, and what they are told: all of the session that is per operator.

Who is in control is `operator_control.py`, the numbers of requests `requests.py`, what became of
accepted ones `operations.py`, who is told of which messages `subscriptions.py`.  This composes them
and returns work for the rest of the session.
"""

from __future__ import annotations

import math

from gcs import ipc
from gcs.bridge.effects import AsksPlan, StopsPlan
from gcs.enu_text import plain_enu
from gcs.gate import inputs as gate_inputs
from gcs.gate.effects import Level, Outcome, OutcomeKind, Ruling, StreamVerdict
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import Abort, Request, SetMode, StartMission
from gcs.gate.states import FlightMode
from gcs.protocol.autopilot import GENERIC, Autopilot
from gcs.request_words import BadAskError, Doer, doer_of
from gcs.session import announcements
from gcs.session.effects import Effect, Emit, ShowTopics
from gcs.session.requests import FIRST, Requests, operator_of, request_of
from gcs.session.setup import Setup
from gcs.session.speedup_waits import Times
from gcs.session.stop_of_several import StopOfSeveral
from gcs.session.work import (
    AskMission,
    AskOrbit,
    AskReader,
    AskSpeed,
    EndSession,
    GateInput,
    GiveVerdict,
    Log,
    StopTransfer,
    StreamOver,
    TellOperator,
    Work,
)
from gcs.station.leases import Leases
from gcs.station.operations import Operations
from gcs.station.operator_control import NOBODY, OperatorControl
from gcs.station.screens import Screens
from gcs.station.streams import BEGIN, Streams
from gcs.station.subscriptions import Subscriptions
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.frame import Frame
from gcs.wire.messages import CommandLong
from gcs.wire.text import clean

NODE = "link"
LOGGED_LETTERS = 40
"""Of a word that may be anything; all operators read the log."""
NOTED_LETTERS = 500


class Operators:
    """Everybody who talks with this station."""

    def __init__(self, setup: Setup, times: Times) -> None:
        self._keep = setup.config.keep
        self.control = OperatorControl(setup.config.operator, first_looks=setup.config.bridge)
        self._requests = Requests()
        self._operations = Operations()
        self._leases = Leases(times)
        self.subscriptions = Subscriptions(times)
        self._streams = Streams()
        self.screens = Screens(self.control)

    @property
    def in_control(self) -> ipc.OperatorInfo | None:
        """The operator in control of the station; None: nobody."""
        operator = self.control.in_control
        return ipc.OperatorInfo(operator, self.control.name(operator)) if operator else None

    @property
    def first_is_alone(self) -> bool:
        """Nobody has joined whoever started the station; MAVLink clients look at no screen."""
        return self.control.first_is_alone

    def operator_of(self, request_id: int) -> int:
        """Who has made the request that is not over yet."""
        return self._requests.get(request_id).operator

    # ----------------------------------------------------------------------- come and go

    def join(self, operator: int, name: str, hold_on_leave: bool) -> list[Work]:
        return self.control.join(operator, name, hold_on_leave)

    def lost(self, operator: int, reason: str) -> list[Work]:
        """Its connection has ended.  The station lives as long as its first operator, unless it
        is to be kept."""
        self.subscriptions.forget(operator)
        ended = [*self._streams.forget(operator), *self._not_read_on(operator)]
        if operator == FIRST and not self._keep:
            return [*ended, EndSession(reason)]
        return [*ended, *self.control.lost(operator, reason)]

    def signalled(self, name: str) -> list[Work]:
        """A kept station outlives the terminal of its first operator."""
        return self.lost(FIRST, name) if name == "SIGHUP" else [EndSession(name)]

    def farewells(self, settled: bool, words: str, log_path: str, now_ns: int) -> list[Work]:
        """Good-bye to those who leave a station that lives on; `words` say how the vehicle is."""
        work: list[Work] = []
        for operator in self.control.farewells(settled, now_ns):
            self.subscriptions.forget(operator)
            sentence = words if self.control.leaves_held(operator) else self._goes_on()
            work.append(Emit(ipc.Bye(0, log_path, sentence, goes_on=True), operator))
            work += self.control.gone(operator)
        return work

    def _goes_on(self) -> str:
        """What the station does on, for one that leaves it."""
        running = ", ".join(
            f"operation {each.id} ({each.asked.word})"
            for each in self._operations.listed()
            if each.ended_ns is None
        )
        return "the station goes on" + (f", with {running}; gcs abort stops it" if running else "")

    def _leave(self, operator: int, reason: str, hold: bool, now_ns: int) -> list[Work]:
        if operator == FIRST and not self._keep:
            return [EndSession(reason)]
        return [*self._not_read_on(operator), *self.control.leave(operator, hold, now_ns)]

    def _not_read_on(self, operator: int) -> list[Work]:
        """It is gone, or goes: nobody waits for what it reads of a vehicle.  What it has set is
        read back all the same."""
        return [
            StopTransfer(request_id)
            for request_id, asked in self._requests.of(operator)
            if doer_of(asked.word) is Doer.READER and asked.word != "param_set"
        ]

    # ------------------------------------------------------------------------------ lines

    def vehicle_of(self, command: ipc.Ask | ipc.Stream) -> int:
        """The system id of the vehicle that it is for, 0 for the first: an abort of an operation
        is for that one's."""
        if isinstance(command, ipc.Ask) and command.operation:
            operation = self._operations.get(command.operation)
            return command.vehicle if operation is None else operation.asked.vehicle
        return command.vehicle

    def line(
        self,
        operator: int,
        command: ipc.Command,
        autopilot: Autopilot | None,
        no_vehicle: Refusal | None,
        now_ns: int,
        several: StopOfSeveral | None = None,
    ) -> list[Work]:
        """One command; `autopilot` is the vehicle's, None before one is heard; `no_vehicle` says
        why nothing can be asked of any, such as several that are heard; `several`: what it is a
        part of."""
        match command:
            case ipc.Ask():
                return self._ask(operator, command, autopilot, no_vehicle, now_ns, several)
            case ipc.Stream():
                return self._stream(operator, command, no_vehicle, now_ns)
            case ipc.Pending(goal_enu, yaw_deg):
                if operator != self.control.in_control:
                    return []  # who only looks cannot send it
                text = f"Keyboard: {plain_enu(goal_enu)}"
                goal = ipc.OperatorGoal(operator, goal_enu, yaw_deg, self.screens.chosen(operator))
                return [Log(Level.INFO, "keyboard_manager", text), Emit(goal)]
            case ipc.Leave(reason, hold):
                return self._leave(operator, reason, hold, now_ns)
            case ipc.Subscribe(names):
                return [*self.subscriptions.subscribe(operator, names, now_ns)]
            case ipc.ListOperations(number):
                return [Emit(ipc.OperationList(number, self._operations.listed()), operator)]
            case ipc.Check() | ipc.Preflight() | ipc.Show():
                return []  # answered before: no part of an operator's is asked
            case ipc.Renew(number):
                operation = self._operations.get(number)
                if operation is not None and operation.client == operator:
                    self._leases.renew(number, now_ns)
                return []
            case ipc.Note(text):
                noted = f"{self.control.name(operator)}: {clean(text[:NOTED_LETTERS])}"
                return [Log(Level.INFO, NODE, noted)]
            case ipc.WatchTopics():
                return [ShowTopics(operator)]
            case ipc.Join():
                return [Emit(ipc.Trouble("this connection has joined already"), operator)]

    def _ask(
        self,
        operator: int,
        ask: ipc.Ask,
        autopilot: Autopilot | None,
        no_vehicle: Refusal | None,
        now_ns: int,
        several: StopOfSeveral | None,
    ) -> list[Work]:
        """What cannot be judged at all takes no control."""

        def opened() -> int:
            return self._requests.open(ask, operator, several)

        refusal = self.control.refusal(operator, ask)
        if refusal is not None:
            return self._refuse(opened(), ask, refusal)
        doer = doer_of(ask.word)
        if doer is Doer.STATION:
            return self._ask_station(operator, ask, now_ns)
        if ask.operation:
            return self._ask_stop(operator, ask)
        if no_vehicle is not None:
            return self._refuse(opened(), ask, no_vehicle)
        if doer in (Doer.JOB, Doer.TRANSFER):
            given = self._give_where_free(operator, ask, now_ns)
            return [*given, AskMission(opened(), ask)]
        if doer is Doer.READER:
            given = self._give_where_free(operator, ask, now_ns)
            return [*given, AskReader(opened(), ask)]
        if doer is Doer.ORBIT:
            given = self._give_where_free(operator, ask, now_ns)
            return [*given, AskOrbit(opened(), ask, operator)]
        if doer is Doer.LEGS:
            given = self._give_where_free(operator, ask, now_ns)
            speed_m_s = math.nan if ask.speed_m_s is None else ask.speed_m_s
            return [*given, AskSpeed(opened(), speed_m_s)]
        try:
            request = request_of(ask, autopilot or GENERIC)
        except BadAskError as error:
            refused = ipc.VerdictEvent(ask.id, ask.word, "refused", "BAD_REQUEST", str(error))
            return [Emit(refused, operator)]
        given = self._give_where_free(operator, ask, now_ns)
        request_id = opened()
        if isinstance(request, SetMode) and request.meaning is FlightMode.MISSION:
            # The mission mode by its name is a mission start, and is verified like one.
            return [*given, AskMission(request_id, ask)]
        return [*given, *self.ask_gate(request_id, request)]

    def _stream(
        self, operator: int, sample: ipc.Stream, no_vehicle: Refusal | None, now_ns: int
    ) -> list[Work]:
        """One sample: for the gate, if this operator is in control or nobody is."""
        refusal = self.control.refusal(operator, BEGIN)
        if refusal is not None:
            return self._refuse_sample(operator, sample, refusal, now_ns)
        if no_vehicle is not None:
            return self._refuse_sample(operator, sample, no_vehicle, now_ns)
        free = self.control.in_control == NOBODY
        if free and not self._streams.goes_on(operator, sample, now_ns):
            return []
        # Who is free to take control has it when the gate has let the sample through.
        return [GateInput(self._streams.seen(operator, sample, now_ns))]

    def _refuse_sample(
        self, operator: int, sample: ipc.Stream, refusal: Refusal, now_ns: int
    ) -> list[Work]:
        """One that reaches no gate: told where that is news."""
        told = self._streams.refuse(operator, sample, refusal, now_ns)
        if told is None:
            return []
        text = f"stream of {told.source}: refused {refusal.code.value}: {refusal.sentence}"
        return [*self._tell_stream(told, 0, now_ns), Log(Level.WARNING, NODE, text)]

    def _give_where_free(self, operator: int, ask: ipc.Ask, now_ns: int) -> list[Work]:
        """Control, to the first who asks for something that needs it."""
        return self._without_streams(operator, self.control.give_where_free(operator, ask), now_ns)

    def _without_streams(self, operator: int, given: list[Work], now_ns: int) -> list[Work]:
        """`operator` is given control: the stream of whoever had it is over, and not only when it
        has been silent for a while."""
        if not given:
            return []
        ends = [
            StreamOver(vehicle, self._requests.open(_end_of_stream(vehicle), other))
            for other, vehicle in self._streams.others(operator, now_ns)
        ]
        return [*ends, *given]

    def end_stream(self, operator: int, sysid: int) -> list[Work]:
        """The stream that the station has made in this operator's name is over."""
        return [StreamOver(sysid, self._requests.open(_end_of_stream(sysid), operator))]

    def _ask_station(self, operator: int, ask: ipc.Ask, now_ns: int) -> list[Work]:
        """What is asked of the station, not of the vehicle, is done at once."""
        done = _done(self._requests.open(ask, operator), "")
        if ask.word == "station_take":
            taken = self.control.take(operator)
            return [*self._without_streams(operator, taken, now_ns), *done]
        if ask.word == "station_release":
            return [*self.control.release(operator), *done]
        return [*done, EndSession(f"operator {operator} ended the station")]

    def _ask_stop(self, operator: int, ask: ipc.Ask) -> list[Work]:
        """An abort of one operation: nothing else is stopped in its place if that has ended."""
        request_id = self._requests.open(ask, operator)
        operation = self._operations.get(ask.operation)
        if ask.word != "abort" or operation is None or operation.ended_ns is not None:
            ended = "is not known" if operation is None else f"has ended: {operation.state}"
            refusal = Refusal(Code.NOT_RUNNING, f"operation {ask.operation} {ended}")
            return self._refuse(request_id, ask, refusal)
        if doer_of(operation.asked.word) in (Doer.TRANSFER, Doer.READER):
            return [StopTransfer(ask.operation), *_done(request_id, "the transfer is stopped")]
        return self.ask_gate(request_id, Abort())

    def ask_plan(self, asked: AsksPlan, no_vehicle: Refusal | None, now_ns: int) -> list[Work]:
        """A MAVLink client brings a plan, or asks for one to be taken off."""
        operator, ask = asked.client, asked.ask
        request_id = self._requests.open(ask, operator)
        refusal = self.control.refusal(operator, ask) or no_vehicle
        if refusal is not None:
            return self._refuse(request_id, ask, refusal)
        given = self._give_where_free(operator, ask, now_ns)
        return [*given, AskMission(request_id, ask, asked.plan, asked.kind)]

    def stop_plan(self, stopped: StopsPlan) -> list[Work]:
        """The operator does not want it any more."""
        request_id = self._requests.number_of(stopped.client, stopped.ask_id)
        return [] if request_id is None else [StopTransfer(request_id)]

    def refuse(self, operator: int, ask: ipc.Ask, refusal: Refusal) -> list[Work]:
        """What is refused before it is a request: it has a number, a verdict and a record too."""
        return self._refuse(self._requests.open(ask, operator), ask, refusal)

    def refuse_goal(self, request_id: int, refusal: Refusal) -> list[Work]:
        """A goal that the gate is not asked for."""
        return self._refuse(request_id, self._requests.get(request_id).ask, refusal)

    @staticmethod
    def _refuse(request_id: int, ask: ipc.Ask, refusal: Refusal) -> list[Work]:
        text = f"{ask.word[:LOGGED_LETTERS]}: refused {refusal.code.value}: {refusal.sentence}"
        return [GiveVerdict(request_id, Ruling.REFUSED, refusal), Log(Level.WARNING, NODE, text)]

    # ---------------------------------------------------------------------------- answers

    def ask_gate(self, request_id: int, request: Request) -> list[Work]:
        """The gate's input for a request, and the line that says so.

        The start of a mission is prepared before: whoever has lost control meanwhile starts none.
        """
        made = self._requests.get(request_id)
        if isinstance(request, StartMission):
            refusal = self.control.refusal(made.operator, made.ask)
            if refusal is not None:
                return self._refuse(request_id, made.ask, refusal)
        given = gate_inputs.Requested(request_id, made.source, request)
        return [announcements.requested(made, request), GateInput(given)]

    def verdict(self, told: GiveVerdict, sysid: int, now_ns: int) -> list[Work]:
        """To the operator who asked; an accepted request is an operation, which all are told."""
        request_id, requests = told.request_id, self._requests
        asked = requests.get(request_id)
        name = self.control.name(asked.operator)
        work: list[Work] = [*announcements.verdict(told, asked, name, sysid, now_ns)]
        if told.ruling is not Ruling.ACCEPTED:
            requests.close(request_id)
            return work
        begun = self._operations.begin(request_id, asked.ask, asked.operator, name, now_ns)
        self._leases.begin(request_id, asked.ask.lease_s, now_ns)
        return [*work, Emit(begun)]

    def outcome(self, told: Outcome, sysid: int, now_ns: int) -> list[Work]:
        """The same, of how it ended."""
        asked = self._requests.close(told.request_id)
        ended = self._operations.end(told, now_ns)
        self._leases.end(told.request_id)
        return [*announcements.outcome(told, asked, sysid), Emit(ended)]

    def stream_verdict(self, told: StreamVerdict, sysid: int, now_ns: int) -> list[Work]:
        """What the gate makes of somebody's setpoint stream, where that changes.

        Where nobody is in control, whose samples are flown gets it; a refused one takes none."""
        operator = operator_of(told.source)
        given = [] if told.refusal else self._give_where_free(operator, BEGIN, now_ns)
        verdict = self._streams.verdict(told, sysid, now_ns)
        return [*given, *self._tell_stream(verdict, sysid, now_ns)]

    def _tell_stream(self, told: StreamVerdict, sysid: int, now_ns: int) -> list[Work]:
        """To the operator, and where it is a MAVLink client to whoever watches the bridge."""
        operator = operator_of(told.source)
        name = self.control.name(operator)
        return [*announcements.stream_verdict(told, operator, name, sysid, now_ns)]

    def second(self, now_ns: int) -> list[Work]:
        """Once a second: what has ended because nothing more came."""
        return self._streams.second(now_ns)

    def unwatched(self, now_ns: int) -> list[tuple[int, list[Work]]]:
        """Operations whose lease has run out are aborted: what to do, by the vehicle's system id.

        That is asked in the name of their operator, who may have left."""
        overdue = map(self._operations.get, self._leases.overdue(now_ns))
        return [(each.asked.vehicle, self._stop_unwatched(each)) for each in overdue if each]

    def _stop_unwatched(self, operation: ipc.Operation) -> list[Work]:
        label = f"operation {operation.id} ({operation.asked.word})"
        text = f"{label} of {operation.operator} is stopped: its lease was not renewed"
        stop = ipc.Ask(0, "abort", operation=operation.id, vehicle=operation.asked.vehicle)
        return [Log(Level.WARNING, NODE, text), *self._ask_stop(operation.client, stop)]

    def tell(self, told: TellOperator) -> list[Work]:
        return [Emit(told.event, self._requests.get(told.request_id).operator)]

    def missing_messages(
        self, telemetry: Telemetry, now_ns: int, *, first: bool
    ) -> list[CommandLong]:
        """Commands that ask the vehicle for what somebody who is shown it has subscribed to and
        does not hear; `first`: it is the first one."""

        def shown(operator: int) -> bool:
            return self.screens.shows(operator, telemetry.sysid, first=first)

        return [*self.subscriptions.missing(telemetry, shown, now_ns)]

    def heard_message(self, frame: Frame, now_ns: int, *, first: bool) -> list[Effect]:
        """A good frame of a vehicle that somebody has subscribed to."""

        def shown(operator: int) -> bool:
            return self.screens.shows(operator, frame.sysid, first=first)

        return self.subscriptions.heard(frame, shown, now_ns)


def _end_of_stream(vehicle: int) -> ipc.Ask:
    return ipc.Ask(0, "stream_end", vehicle=vehicle)


def _done(request_id: int, sentence: str) -> list[Work]:
    complete = Outcome(request_id, OutcomeKind.COMPLETE, None, sentence or "complete")
    return [GiveVerdict(request_id, Ruling.ACCEPTED), complete]
