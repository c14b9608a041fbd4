"""Which memories of the gate are one situation: what can still make a difference, no more.

Request ids and sentences are left out, times are reduced to what is due and what is not, and
what the present state does not look at is left out altogether.  Two memories that differ only
there are one situation, and the explorer goes on from the first of them that it met.

What a later state looks at makes a difference too, and not all of it is here: that would be several
times as many situations.  `FINER` tells most of it apart; `unexplored_memories.py` samples what is
lost.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Final, TypeAlias

from gcs.gate.condition import Severity
from gcs.gate.effects import CommandKind
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.policy.policy import Policy
from gcs.gate.states import FlightMode, LandedState, State
from tests.proof.invariants_command import FORCE_WINDOW_NS
from tests.proof.world import ABOVE, EDGE, LOW, TOP

_MODES: Final = {
    State.GROUNDED: frozenset({FlightMode.RETURN, FlightMode.LAND, FlightMode.MISSION}),
    State.STALE: frozenset({FlightMode.RETURN, FlightMode.LAND}),
    State.TAKING_OFF: frozenset({FlightMode.HOLD, FlightMode.GUIDED}),
    State.HOVERING: frozenset({FlightMode.HOLD, FlightMode.GUIDED}),
    State.HOLDING: frozenset({FlightMode.HOLD}),
    State.FLYING_MISSION: frozenset({FlightMode.MISSION}),
    State.RETURNING: frozenset({FlightMode.RETURN, FlightMode.HOLD, FlightMode.GUIDED}),
    State.LANDING: frozenset({FlightMode.LAND, FlightMode.HOLD, FlightMode.GUIDED}),
}
"""The modes that are told apart in a state; in any other state none is."""

_PLACES: Final = frozenset(
    {State.TAKING_OFF, State.HOVERING, State.FLYING_MISSION, State.HOLDING, State.EXTERNAL}
)
"""Where a dash for the fence matters beyond the sample that shows it: staying is judged there."""

_LATE_GUIDED: Final = frozenset({State.HOLDING, State.EXTERNAL})
_LATE_TAKE_OFF: Final = frozenset({State.NO_VEHICLE, State.GROUNDED, State.STALE, State.HOLDING})

ALIKE: Final = {
    Event.RESUME: Event.CONTROL,
    Event.RETURN: Event.LAND,
    Event.FORCE_DISARM: Event.DISARM,
}
"""Requests that are treated alike once they are under way."""


@dataclass(frozen=True, slots=True)
class ToldApart:
    """In which states a thing is told apart that may matter in a later state only."""

    modes: Mapping[State, frozenset[FlightMode]]
    places: frozenset[State]
    late_guided: frozenset[State]  # a GUIDED command that may yet take effect
    late_take_off: frozenset[State]
    worst: Mapping[State, Severity]
    """Severities beyond this one are taken for it; beyond RETURN, where none is named."""


USUAL: Final = ToldApart(
    _MODES, _PLACES, _LATE_GUIDED, _LATE_TAKE_OFF, {State.STALE: Severity.LAND}
)

FINER: Final = ToldApart(
    {**_MODES, State.STALE: frozenset(FlightMode), State.GROUNDED: frozenset(FlightMode)},
    frozenset(State),
    frozenset(State),
    frozenset(State),
    dict.fromkeys(State, Severity.TERMINATE),
)
"""Several times as many situations: for a soak."""


def situation(policy: Policy, memory: Memory, now_ns: int) -> Hashable:
    """Equal for memories that the explorer need not tell apart."""
    return tuple(part(policy, memory, now_ns) for part, _ in parts(USUAL))


def _machine(apart: ToldApart, policy: Policy, memory: Memory, now_ns: int) -> Hashable:
    state = memory.state
    severities = [policy.severities[name] for name in memory.counted_conditions]
    worst = apart.worst.get(state, Severity.RETURN)
    return (
        state,
        memory.control,
        min(max(severities, default=Severity.CAUTION), worst),
        memory.operator_lost,
        memory.back_to,
        memory.verifier is not None,
        memory.grace_until_ns is not None,
    )


def _reported(apart: ToldApart, policy: Policy, memory: Memory, now_ns: int) -> Hashable:
    state, flies = memory.state, memory.flown_state
    return (
        (memory.heard_before, memory.lost_in_flight) if state is State.NO_VEHICLE else None,
        memory.pos_ned is None,
        memory.armed,
        memory.mode if memory.mode in apart.modes.get(flies, ()) else None,
        _leaves_guided_to_arm(memory) if flies is State.GROUNDED else None,
        memory.climbed if flies is State.TAKING_OFF else None,
        memory.lifted if flies in (State.TAKING_OFF, State.FLYING_MISSION) else None,
        memory.mission_over if flies is State.FLYING_MISSION else None,
    )


def _leaves_guided_to_arm(memory: Memory) -> bool:
    return memory.guided_used and not memory.armed and memory.autopilot == "ardupilot"


def _position(apart: ToldApart, policy: Policy, memory: Memory, now_ns: int) -> Hashable:
    climbs = memory.flown_state is State.TAKING_OFF
    flown = memory.goal is not None
    return (
        memory.pos_ned in (TOP, LOW, ABOVE) and memory.pos_ned if climbs else None,
        memory.state in apart.places and memory.pos_ned == EDGE,
        memory.goal is not None and memory.pos_ned == memory.goal.pos_ned,
        flown and memory.within_since_ns is not None,
    )


def _requests(apart: ToldApart, policy: Policy, memory: Memory, now_ns: int) -> Hashable:
    task = memory.task
    return (
        None if task is None else (ALIKE.get(task.kind, task.kind), task.waiting),
        None if memory.pending is None else (memory.pending.request, memory.pending.source),
        memory.hold is not None,
        memory.comes_back,
        memory.goal is not None,
    )


def _commands(apart: ToldApart, policy: Policy, memory: Memory, now_ns: int) -> Hashable:
    unanswered = [kind for _, kind in memory.outstanding if kind is not CommandKind.HOLD]
    hold_again = memory.hold_again_ns is not None
    awaited = not hold_again and memory.asked_mode is not None
    return (
        tuple(unanswered),
        memory.asked_mode if awaited else None,
        memory.ask_control_ns is not None,
        hold_again and memory.hold_requested,
        hold_again,
    )


def _clocks(apart: ToldApart, policy: Policy, memory: Memory, now_ns: int) -> Hashable:
    """All that changes by time alone; no other part looks at the time."""
    state = memory.state
    age_ns = memory.position_age_ns(now_ns)
    told_ns = memory.landed_ns
    aged = told_ns is not None and now_ns - told_ns >= policy.heartbeat_age_s * SECOND_NS
    # Told to stand, and seen higher: it stands once it is seen lower.
    stands = memory.armed and memory.landed is LandedState.ON_GROUND
    force_ns = memory.force_asked_ns
    awaited = memory.hold_again_ns is None and memory.asked_mode is not None
    return (
        age_ns is None or age_ns > policy.position_age_s * SECOND_NS,
        (memory.airborne, memory.on_ground, stands) if not aged else memory.armed,
        awaited and now_ns < memory.asked_until_ns,
        state in apart.late_guided and now_ns < memory.guided_until_ns,
        state in apart.late_take_off and now_ns < memory.takeoff_until_ns,
        force_ns is not None and now_ns - force_ns <= FORCE_WINDOW_NS,
        _stream_clocks(policy, memory, now_ns) if state is State.STREAMING else None,
        _pace_clock(policy, memory, now_ns),
    )


def _pace_clock(policy: Policy, memory: Memory, now_ns: int) -> Hashable:
    """May it be as fast as it was asked to, though it is not reported so?"""
    react_ns = round(policy.braking_of(memory.autopilot).react_s * SECOND_NS)
    if memory.paced is None or memory.v_ned is None or now_ns >= memory.paced_ns + react_ns:
        return False
    return math.hypot(*memory.paced.v_ned) > math.hypot(*memory.v_ned)


def _stream_clocks(policy: Policy, memory: Memory, now_ns: int) -> Hashable:
    rules, since_ns = policy.stream, memory.good_since_ns
    age_ns = memory.position_age_ns(now_ns)
    return (
        memory.flown is not None and now_ns - memory.sample_ns >= rules.deadman_s * SECOND_NS,
        age_ns is None or age_ns > rules.position_age_s * SECOND_NS,
        since_ns is not None and now_ns - since_ns >= rules.good_again_s * SECOND_NS,
    )


def _stream(apart: ToldApart, policy: Policy, memory: Memory, now_ns: int) -> Hashable:
    if memory.flown_state is not State.STREAMING:
        return None
    flown = memory.flown
    return (
        None if flown is None else flown.sample.pos_ned is not None,
        memory.stream_refused,
        memory.good_since_ns is not None,
    )


Part: TypeAlias = Callable[[Policy, Memory, int], Hashable]

_PARTS: Final = (
    (_machine, 11),
    (_reported, 10),
    (_position, 7),
    (_requests, 7),
    (_commands, 9),
    (_stream, 6),
    (_clocks, 13),
)
"""Each with the bits that number what it may be: together they fit one number."""


def parts(apart: ToldApart) -> tuple[tuple[Part, int], ...]:
    """The parts of a situation, each with the bits for its number.

    Apart, as each looks at a few fields only: the explorer asks anew for those that may differ.
    """
    return tuple((partial(part, apart), bits) for part, bits in _PARTS)
