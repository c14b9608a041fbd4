"""The gate: inputs become facts, facts become events, and the table says what follows.

Every event is looked up in `table.TABLE`; the first branch whose guards hold is taken, and its
actions run.  This is the one module that issues permits: motion leaves it only with the goal
that the verifier cleared, or in answer to a branch of the table.
"""

from __future__ import annotations

import math

from gcs.frames import Vec3
from gcs.gate import permit
from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import (
    CommandKind,
    Effect,
    Level,
    Ruling,
    SendCommand,
    SendSetpoint,
    Transition,
)
from gcs.gate.inputs import Input, OperatorLost, Requested, Tick
from gcs.gate.machine.actions import ACTIONS
from gcs.gate.machine.events import Event
from gcs.gate.machine.facts import events_from
from gcs.gate.machine.guards import CHECKS, GUARDS
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.machine.rules import BACK, STAY, Answer, Branch, Next
from gcs.gate.machine.table import STREAMS, TABLE, Streams, Table
from gcs.gate.machine.turn import CommandDraft, Draft, SetpointDraft, Turn
from gcs.gate.policy.policy import Policy
from gcs.gate.states import Control, FlightMode, LandedState, State

MOTION = frozenset(CommandKind) - {
    CommandKind.HOLD,
    CommandKind.DISARM,
    CommandKind.FORCE_DISARM,
    CommandKind.PHOTO,
}
"""What sets the vehicle in motion, or may: these carry a permit."""

MUST = {
    Severity.HOLD: Event.MUST_HOLD,
    Severity.RETURN: Event.MUST_RETURN,
    Severity.LAND: Event.MUST_LAND,
    Severity.TERMINATE: Event.MUST_LAND,
}
"""What a severity demands.  TERMINATE is reported; the gate itself goes no further than land."""


class ImpossibleError(Exception):
    """A cell that cannot be entered was entered: a bug of the gate's own, not of any peer."""


class Gate:
    """`handle(input, now_ns) -> effects`; time is handed in and nothing else is looked at.

    `autopilot` ("px4", "ardupilot", "" while it is not known) decides how control is taken and
    what the vehicle arms from; a `VerifierChanged` brings it too.
    """

    def __init__(self, policy: Policy, autopilot: str, now_ns: int, table: Table = TABLE) -> None:
        self._table = table
        self._turn = Turn(policy, Memory(autopilot), now_ns)

    @classmethod
    def resumed(cls, policy: Policy, memory: Memory, now_ns: int, table: Table = TABLE) -> Gate:
        """A gate that goes on from `memory`, which it owns from here on."""
        gate = cls(policy, memory.autopilot, now_ns, table)
        gate._turn.memory = memory
        return gate

    # --------------------------------------------------------------------------- reading

    @property
    def memory(self) -> Memory:
        """A copy of what the gate knows and intends."""
        return self._turn.memory.copy()

    @property
    def state(self) -> State:
        return self._turn.memory.state

    @property
    def severity(self) -> Severity:
        return self._turn.severity

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """Everything that is wrong now."""
        return tuple(condition for condition, _ in self._turn.memory.conditions)

    @property
    def control(self) -> Control:
        return self._turn.memory.control

    @property
    def active_goal_ned(self) -> Vec3 | None:
        """Where the vehicle is asked to be: the goal it flies to, or the one it hovers at."""
        memory = self._turn.memory
        flown = memory.goal or memory.hold
        return None if flown is None else flown.pos_ned

    @property
    def hold_goal_ned(self) -> Vec3 | None:
        hold = self._turn.memory.hold
        return None if hold is None else hold.pos_ned

    @property
    def pos_ned(self) -> Vec3 | None:
        return self._turn.memory.pos_ned

    def position_age_s(self, now_ns: int) -> float | None:
        age_ns = self._turn.memory.position_age_ns(now_ns)
        return None if age_ns is None else age_ns / SECOND_NS

    @property
    def settled(self) -> bool:
        """The vehicle may be left: seen holding, on the ground, or not ours to hold."""
        memory = self._turn.memory
        if memory.state is State.GROUNDED:
            return not memory.outstanding
        if memory.hold_again_ns is not None:
            return False
        return memory.control is Control.NONE or (
            memory.state is State.HOLDING and memory.mode is FlightMode.HOLD
        )

    @property
    def deadline_ns(self) -> int | None:
        """The next time that something is due; it is judged at the tick that follows."""
        memory, policy = self._turn.memory, self._turn.policy
        times = [
            memory.ask_control_ns,
            memory.hold_again_ns,
            memory.grace_until_ns,
            None if memory.task is None else memory.task.deadline_ns,
            None if memory.asked_mode is None else memory.asked_until_ns,
            _plus(memory.heard_ns, policy.heartbeat_age_s),
            None if memory.state is State.STALE else _plus(memory.pos_ns, policy.position_age_s),
        ]
        return min((time_ns for time_ns in times if time_ns is not None), default=None)

    # -------------------------------------------------------------------------- handling

    def handle(self, given: Input, now_ns: int) -> list[Effect]:
        """Everything that follows from `given` at `now_ns`, in order.

        Raises ImpossibleError for a bug of the gate's own, and for nothing else.
        """
        turn = self._turn = Turn(self._turn.policy, self._turn.memory, now_ns)
        if isinstance(given, Requested | OperatorLost | Tick):
            self._judge_ages()
        if isinstance(given, Requested):
            turn.requested = given
        severity = turn.severity
        for event, why, breach in events_from(turn, given):
            turn.why, turn.breach = why, breach
            self._fire(event)
        self._weigh(severity)
        if isinstance(given, Tick):
            self._tick()
        return [self._seal(draft) for draft in turn.out]

    def _judge_ages(self) -> None:
        """What has become too old, before anything is decided on it."""
        turn, memory, now_ns = self._turn, self._turn.memory, self._turn.now_ns
        if _due(_plus(memory.landed_ns, turn.policy.heartbeat_age_s), now_ns):
            memory.landed, memory.landed_ns = LandedState.UNDEFINED, None
        if memory.state is not State.NO_VEHICLE:
            if _due(_plus(memory.heard_ns, turn.policy.heartbeat_age_s), now_ns):
                self._fire(Event.LOST)
            elif turn.stale:
                self._fire(Event.AGED)
        if memory.task is not None and _due(memory.task.deadline_ns, now_ns):
            self._fire(Event.DEADLINE)
        overdue = memory.asked_mode is not None and now_ns >= memory.asked_until_ns
        if overdue and memory.hold_again_ns is None:
            self._fire(Event.MODE_OVERDUE)

    def _tick(self) -> None:
        turn, memory = self._turn, self._turn.memory
        if _due(memory.hold_again_ns, turn.now_ns):
            self._fire(Event.HOLD_DUE)
        if _due(memory.ask_control_ns, turn.now_ns):
            self._fire(Event.CONTROL_DUE)
        self._fire(Event.TICK)
        self._stream()

    def _weigh(self, before: Severity) -> None:
        after = self._turn.severity
        if after > before and after in MUST:
            self._fire(MUST[after])
        elif after < before:
            self._fire(Event.EASED)

    def _fire(self, event: Event) -> None:
        """Run the cell of `event` in the present state, and of what that raises."""
        turn = self._turn
        branch = self._branch(event)
        for check in branch.needs:
            objection = CHECKS[check](turn)
            if objection is not None:
                assert turn.requested is not None
                turn.verdict(turn.requested, Ruling.REFUSED, objection)
                return
        if branch.refuse is not None:
            turn.refuse(branch.refuse)
        if branch.answer is not Answer.NONE:
            turn.answer(branch.answer, event, branch.ends)
        elif branch.ends is not None:
            turn.end(branch.ends)
        for do in branch.do:
            ACTIONS[do](turn)
        self._enter(branch.to, event)
        while turn.raised:
            self._fire(turn.raised.pop(0))

    def _branch(self, event: Event) -> Branch:
        state = self._turn.memory.state
        for branch in self._table[state, event]:
            if all(GUARDS[guard](self._turn) for guard in branch.when):
                return branch
        raise ImpossibleError(f"{event} in {state.name}")

    def _enter(self, to: Next, event: Event) -> None:
        turn, memory = self._turn, self._turn.memory
        if to is STAY:
            return
        before, back_to = memory.state, memory.back_to
        if to is BACK:
            assert back_to is not None
            memory.state = back_to
        else:
            assert isinstance(to, State)
            memory.state = to
        if before is memory.state:
            return
        if before is State.STALE:
            memory.back_to = memory.grace_until_ns = None
        turn.out.append(
            Transition(before, memory.state, event.value, memory.control, turn.severity)
        )
        turn.say(Level.INFO, f"Current State: {memory.state.name}")
        if to is BACK and turn.severity in MUST:
            turn.raised.append(MUST[turn.severity])

    # ------------------------------------------------------------------------ permitting

    def _stream(self) -> None:
        """The setpoint of this tick, where the state streams and control is there to stream."""
        turn, memory = self._turn, self._turn.memory
        if memory.control is Control.NONE:
            return
        streams = STREAMS[memory.state]
        if streams is Streams.AS_BEFORE:
            before = None if memory.grace_until_ns is None else memory.back_to
            streams = Streams.NOTHING if before is None else STREAMS[before]
        goal = {
            Streams.HOLD_GOAL: memory.hold,
            Streams.ACTIVE_GOAL: memory.goal,
        }.get(streams)
        if goal is not None:
            turn.out.append(SetpointDraft(goal, memory.state.name))

    def _seal(self, draft: Draft) -> Effect:
        """Issue the permit that a moving frame must carry."""
        now_ns = self._turn.now_ns
        if isinstance(draft, SetpointDraft):
            goal = draft.goal
            assert all(map(math.isfinite, goal.pos_ned))
            return SendSetpoint(permit.issue(goal.pos_ned, goal.yaw_rad, now_ns, draft.reason))
        if isinstance(draft, CommandDraft):
            moves = draft.kind in MOTION
            return SendCommand(
                draft.request_id,
                draft.kind,
                draft.deadline_ns,
                permit.issue(None, None, now_ns, draft.reason) if moves else None,
                draft.up_m,
                draft.mode_name,
            )
        return draft


def _plus(time_ns: int | None, seconds: float) -> int | None:
    return None if time_ns is None else time_ns + round(seconds * SECOND_NS)


def _due(time_ns: int | None, now_ns: int) -> bool:
    return time_ns is not None and now_ns >= time_ns
