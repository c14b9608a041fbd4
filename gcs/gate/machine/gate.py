"""The gate: runs the state machine's table, and issues the permits.

An input is stored as facts, its changes become events (`observe.py`), and every event is looked up
in `table.TABLE`: the first branch whose guards hold is taken, and its actions run.  This is the
only module that issues permits: for setpoints to a goal that the verifier cleared, and for
commands that a branch of the table sends.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

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
    Verdict,
)
from gcs.gate.inputs import ConditionChanged, Input, OperatorLost, Requested, StreamSeen, Tick
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.machine.observe import events_from
from gcs.gate.machine.pacing import towards, way_is_known
from gcs.gate.machine.rows.row import BACK, STAY, Branch, Next
from gcs.gate.machine.step_context import (
    CommandDraft,
    Draft,
    Reply,
    SampleDraft,
    SetpointDraft,
    StepContext,
)
from gcs.gate.machine.table import STREAMS, TABLE, Streams, Table
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import Request
from gcs.gate.states import Control, FlightMode, LandedState, State

MOTION: Final = frozenset(CommandKind) - {
    CommandKind.HOLD,
    CommandKind.DISARM,
    CommandKind.FORCE_DISARM,
    CommandKind.PHOTO,
}
"""The commands that set the vehicle in motion, or may: they carry a permit."""

DECIDES: Final = (Requested, StreamSeen, OperatorLost, Tick)
"""Before these, what has become too old is handled."""
MUST: Final[Mapping[Severity, Event]] = MappingProxyType(
    {
        Severity.HOLD: Event.MUST_HOLD,
        Severity.RETURN: Event.MUST_RETURN,
        Severity.LAND: Event.MUST_LAND,
        Severity.TERMINATE: Event.MUST_LAND,
    }
)
"""What a severity demands.  At TERMINATE the gate commands no more than landing."""


GOALS_WAIT_IN: Final = frozenset({State.TAKING_OFF, State.HOVERING, State.VERIFYING, State.MOVING})
"""Where a go-to may wait for its tick; one that waits when another state is entered is refused."""

TRIAL: Final = -1
"""The number of a request that is only tried: no real one has it."""


class ImpossibleError(Exception):
    """An event happened in a state where the table says that it cannot: a bug of the gate."""


class Gate:
    """`handle(input, now_ns) -> effects`.

    Times are nanoseconds of one monotonic clock; positions are metres in local NED.  `autopilot`
    ("px4", "ardupilot", or "" while it is not known) decides how control is taken and in which
    modes the vehicle arms; a `VerifierChanged` sets it too.
    """

    def __init__(self, policy: Policy, autopilot: str, now_ns: int, table: Table = TABLE) -> None:
        self._table = table
        self._step = StepContext(policy, Memory(autopilot), now_ns)

    @classmethod
    def resumed(cls, policy: Policy, memory: Memory, now_ns: int, table: Table = TABLE) -> Gate:
        """A gate that goes on from `memory`, which belongs to it from now on."""
        gate = cls(policy, memory.autopilot, now_ns, table)
        gate._step.memory = memory
        return gate

    # --------------------------------------------------------------------------- reading

    @property
    def memory(self) -> Memory:
        """A copy of what the gate knows and has accepted."""
        return self._step.memory.copy()

    @property
    def state(self) -> State:
        return self._step.memory.state

    @property
    def severity(self) -> Severity:
        return self._step.severity

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """The active conditions."""
        return tuple([condition for condition, _ in self._step.memory.conditions])

    @property
    def reasons(self) -> tuple[tuple[Condition, str], ...]:
        """The active conditions, and what each was reported with."""
        return tuple(self._step.memory.conditions)

    def severity_of(self, condition: Condition) -> Severity:
        """What the policy makes of a condition."""
        return self._step.policy.severities[condition]

    @property
    def control(self) -> Control:
        return self._step.memory.control

    @property
    def active_goal_ned(self) -> Vec3 | None:
        """The goal that the vehicle flies to, else the one that it hovers at; None without one."""
        memory = self._step.memory
        if memory.flown_state is State.STREAMING and memory.flown is not None:
            return memory.flown.sample.pos_ned
        by_itself = STREAMS[memory.state] is Streams.HOLD_GOAL_UNTIL_MODE
        flown = memory.goal or (None if by_itself else memory.hold)
        return None if flown is None else flown.pos_ned

    @property
    def hold_goal_ned(self) -> Vec3 | None:
        hold = self._step.memory.hold
        return None if hold is None else hold.pos_ned

    @property
    def pos_ned(self) -> Vec3 | None:
        return self._step.memory.pos_ned

    def position_age_s(self, now_ns: int) -> float | None:
        age_ns = self._step.memory.position_age_ns(now_ns)
        return None if age_ns is None else age_ns / SECOND_NS

    @property
    def settled(self) -> bool:
        """May the station leave?  The vehicle is seen holding, returning or landing, or is on the
        ground with no command unanswered, or is not under our control."""
        memory = self._step.memory
        if memory.state in (State.GROUNDED, State.NO_VEHICLE):
            awaited = memory.hold_again_ns is not None and memory.state is State.NO_VEHICLE
            return not (memory.outstanding or awaited)
        if memory.hold_again_ns is not None:
            return False
        if memory.state in (State.RETURNING, State.LANDING):
            return memory.asked_mode is None
        return memory.control is Control.NONE or (
            memory.state is State.HOLDING and memory.mode is FlightMode.HOLD
        )

    @property
    def deadline_ns(self) -> int | None:
        """When the next thing is due; it happens at the first tick after it.  None: nothing is."""
        memory, policy = self._step.memory, self._step.policy
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
        """The effects of `given` at `now_ns`, in order.

        Raises ImpossibleError where the table has a bug; every input is legal at any time.
        """
        step = self._step = StepContext(self._step.policy, self._step.memory, now_ns)
        if isinstance(given, DECIDES):
            self._check_ages()
        if isinstance(given, Requested):
            step.requested = given
        elif isinstance(given, StreamSeen):
            step.streamed = given
        severity = step.severity if isinstance(given, ConditionChanged) else None
        for event, why, breach in events_from(step, given):
            step.why, step.breach = why, breach
            self._fire(event)
        if severity is not None:
            self._demand(severity)
        if isinstance(given, Tick):
            self._tick()
        return [self._permitted(draft) for draft in step.out]

    def would(
        self, request: Request, source: str, now_ns: int, *, at_once: bool = False
    ) -> Verdict | None:
        """The verdict that a request of `source` would get now; None where it would have to wait
        for one.  A go-to waits for its tick: it is tried as well, but where `at_once`.

        A copy of the gate is asked, through the same table, and forgotten: nothing is changed, and
        nothing of it is sent.
        """
        trial = Gate.resumed(self._step.policy, self.memory, now_ns, self._table)
        asked = Requested(TRIAL, source, request)
        effects = trial.handle(asked, now_ns)
        if not at_once:
            effects += trial.handle(Tick(0), now_ns)
        verdicts = (each for each in effects if isinstance(each, Verdict))
        return next((each for each in verdicts if each.request_id == TRIAL), None)

    def _check_ages(self) -> None:
        """Handle what has become too old, before anything is decided on it."""
        step, memory, now_ns = self._step, self._step.memory, self._step.now_ns
        if _due(_plus(memory.landed_ns, step.policy.heartbeat_age_s), now_ns):
            memory.landed, memory.landed_ns = LandedState.UNDEFINED, None
        if memory.state is not State.NO_VEHICLE:
            if _due(_plus(memory.heard_ns, step.policy.heartbeat_age_s), now_ns):
                self._fire(Event.VEHICLE_LOST)
            elif step.stale:
                self._fire(Event.POSITION_AGED)
        if memory.task is not None and _due(memory.task.deadline_ns, now_ns):
            self._fire(Event.DEADLINE)
        awaited = memory.hold_again_ns is None and memory.asked_mode is not None
        if awaited and now_ns >= memory.asked_until_ns:
            self._fire(Event.MODE_OVERDUE)

    def _tick(self) -> None:
        step, memory = self._step, self._step.memory
        if _due(memory.hold_again_ns, step.now_ns):
            self._fire(Event.HOLD_DUE)
        if _due(memory.ask_control_ns, step.now_ns):
            self._fire(Event.CONTROL_DUE)
        self._fire(Event.TICK)
        self._stream()

    def _demand(self, before: Severity) -> None:
        """Handle a change of severity, which was `before` when the input came."""
        after = self._step.severity
        if after > before and after in MUST:
            self._fire(MUST[after])
        elif after < before:
            self._fire(Event.SEVERITY_EASED)

    def _fire(self, event: Event) -> None:
        """Take a branch of the cell for `event` in the present state, then handle the events that
        its actions raised."""
        step = self._step
        branch = self._branch(event)
        for check in branch.needs:
            refusal = check.refusal(step)
            if refusal is not None:
                assert step.requested is not None
                step.verdict(step.requested, Ruling.REFUSED, refusal)
                return
        if branch.refuse is not None:
            step.refuse(branch.refuse)
        if branch.reply is not Reply.NONE:
            step.reply(branch.reply, event, branch.ends)
        elif branch.ends is not None:
            step.end(branch.ends)
        for action in branch.do:
            action.perform(step)
        self._enter(branch.to, event)
        while step.raised:
            self._fire(step.raised.pop(0))

    def _branch(self, event: Event) -> Branch:
        state = self._step.memory.state
        for branch in self._table[state, event]:
            if all(guard.holds(self._step) for guard in branch.when):
                return branch
        raise ImpossibleError(f"{event} in {state.name}")

    def _enter(self, to: Next, event: Event) -> None:
        """Change the state.

        In STALE what a severity demands may be left undone, so it is demanded again when a fresh
        position leads back to the interrupted state.
        """
        step, memory = self._step, self._step.memory
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
        if memory.state not in GOALS_WAIT_IN:
            step.refuse_pending(Refusal(Code.NOT_FLYING, "the vehicle does not hover any more"))
        step.out.append(
            Transition(before, memory.state, event.value, memory.control, step.severity)
        )
        step.say(Level.INFO, f"Current State: {memory.state.name}")
        if to is BACK and step.severity in MUST:
            step.raised.append(MUST[step.severity])

    # --------------------------------------------------------------------------- permits

    def _stream(self) -> None:
        """Send the setpoint of this tick, in the states that send one and with control."""
        step, memory = self._step, self._step.memory
        if memory.control is Control.NONE:
            return
        streams = STREAMS[memory.state]
        if streams is Streams.AS_BEFORE:
            before = None if memory.grace_until_ns is None else memory.back_to
            streams = Streams.NOTHING if before is None else STREAMS[before]
        goal = {
            Streams.HOLD_GOAL: memory.hold,
            Streams.ACTIVE_GOAL: memory.goal,
            Streams.HOLD_GOAL_UNTIL_MODE: memory.hold if _awaits_mode_in_guided(step) else None,
        }.get(streams)
        if streams is Streams.SAMPLE:
            goal = memory.hold
            if memory.state is State.STREAMING and memory.flown is not None:
                step.out.append(SampleDraft(memory.flown.sample, memory.state.name))
                return
        if goal is not None and way_is_known(step, goal.pos_ned):
            step.out.append(SetpointDraft(goal, memory.state.name))

    def _permitted(self, draft: Draft) -> Effect:
        """Make the effect of a draft: the permit is issued here, where one is needed."""
        now_ns = self._step.now_ns
        if isinstance(draft, SetpointDraft):
            goal = draft.goal
            target_ned = towards(self._step, goal.pos_ned, most_m_s=goal.speed_m_s)
            assert all(map(math.isfinite, target_ned))
            return SendSetpoint(permit.issue(target_ned, goal.yaw_rad, now_ns, draft.reason))
        if isinstance(draft, SampleDraft):
            asked = draft.sample
            to_ned = asked.pos_ned
            return SendSetpoint(
                permit.issue(
                    None if to_ned is None else towards(self._step, to_ned, asked.v_ned),
                    asked.yaw_rad,
                    now_ns,
                    draft.reason,
                    v_ned=asked.v_ned,
                    a_ned=asked.a_ned,
                    yaw_rate_rad_s=asked.yaw_rate_rad_s,
                    attitude=asked.attitude,
                )
            )
        if isinstance(draft, CommandDraft):
            moves = draft.kind in MOTION
            return SendCommand(
                draft.request_id,
                draft.kind,
                draft.deadline_ns,
                permit.issue(None, None, now_ns, draft.reason) if moves else None,
                draft.up_m,
                draft.mode_name,
                draft.seq,
            )
        return draft


def _awaits_mode_in_guided(step: StepContext) -> bool:
    """The vehicle still follows setpoints, on a position that can be judged, and is to leave that
    mode."""
    memory = step.memory
    awaited = memory.asked_mode is not None and memory.mode is FlightMode.GUIDED
    return awaited and not step.stale


def _plus(time_ns: int | None, seconds: float) -> int | None:
    return None if time_ns is None else time_ns + round(seconds * SECOND_NS)


def _due(time_ns: int | None, now_ns: int) -> bool:
    return time_ns is not None and now_ns >= time_ns
