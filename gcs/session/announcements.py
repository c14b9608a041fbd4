"""What was decided and what stands, as the record keeps it and as the operator is told it.

Each fact is made once, as a struct of `gcs/report.py`.  What the operator gets of it is made from
that struct, here.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from gcs import ipc
from gcs.bridge.bridge import FIRST_NUMBER
from gcs.frames import Vec3
from gcs.gate import effects
from gcs.gate.airspace.projection import Origin
from gcs.gate.airspace.zones import Zone
from gcs.gate.effects import Level
from gcs.gate.geometry import Circle
from gcs.gate.machine.gate import Gate
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Refusal
from gcs.gate.requests import GoTo, Request
from gcs.report import (
    ConditionItem,
    DecisionItem,
    FenceItem,
    FenceShape,
    FsaItem,
    LogEvent,
    OriginItem,
    PointEnu,
)
from gcs.session.effects import Effect, Emit, Record
from gcs.session.requests import Asked
from gcs.session.work import GiveVerdict, Log, ToScreens, Work

NODE = "state_and_safety"


def log(line: Log, now_ns: int, prefix: str = "") -> list[Effect]:
    """One line, to the screen and to the record; `prefix` names the vehicle that it is of."""
    event = LogEvent(now_ns, int(line.level), line.node, prefix + line.text)
    return [Emit(event), Record(event)] if line.recorded else [Emit(event)]


def requested(asked: Asked, request: Request) -> Log:
    """A request arrived; for a goal the gate adds the lab's `Requested Position`."""
    if isinstance(request, GoTo):
        return Log(Level.INFO, "keyboard_manager", "Sending Position")
    return Log(Level.INFO, NODE, f"Requested: {asked.word}")


def verdict(told: GiveVerdict, asked: Asked, name: str, sysid: int, now_ns: int) -> list[Effect]:
    """Accepted, refused or superseded; with the numbers it was decided on.  `name` is the
    operator's, if it is a MAVLink client: then whoever watches the bridge is told as well."""
    code, sentence, zone = _reason(told.refusal)
    item = DecisionItem(
        vehicle=sysid,
        request_id=told.request_id,
        source=asked.source,
        word=asked.word,
        phase="verdict",
        outcome=told.ruling.value,
        code=code,
        sentence=sentence,
        zone=zone,
        goal=_point(told.goal_ned),
        numbers=dict(told.refusal.numbers if told.refusal else told.evidence),
    )
    event = ipc.VerdictEvent(
        asked.ask.id,
        item.word,
        item.outcome,
        item.code,
        item.sentence,
        item.zone,
        item.numbers,
        item.goal.enu if item.goal else None,
        told.request_id,
    )
    return [
        *(Emit(each, asked.operator) for each in asked.verdict(sysid, event)),
        Record(item),
        *_for_bridge(item, asked.operator, name, now_ns),
    ]


def checked(
    asked: ipc.Ask, told: effects.Verdict | Refusal | None, goal: Refusal | None = None
) -> ipc.Checked:
    """What a request would be answered with now; `goal` refuses what it is to fly to."""
    verdict = told if isinstance(told, effects.Verdict) else None
    refusal = told if isinstance(told, Refusal) else verdict.refusal if verdict else None
    outcome = "refused" if refusal else "accepted" if verdict else "waits"
    return ipc.Checked(
        asked.id,
        asked.word,
        outcome,
        code=refusal.code.value if refusal else "",
        sentence=refusal.sentence if refusal else "",
        zone=refusal.zone if refusal else "",
        numbers=dict(refusal.numbers if refusal else verdict.evidence if verdict else ()),
        goal_code=goal.code.value if goal else "",
        goal_sentence=goal.sentence if goal else "",
        goal_zone=goal.zone if goal else "",
    )


def stream_verdict(
    told: effects.StreamVerdict, operator: int, name: str, sysid: int, now_ns: int
) -> list[Effect]:
    """Samples of a stream are refused from now on, or flown."""
    outcome = "refused" if told.refusal else "accepted"
    item = _of_stream(told.source, sysid, outcome, *_reason(told.refusal), dict(told.evidence))
    event = ipc.StreamVerdictEvent(
        item.outcome, item.code, item.sentence, item.zone, item.numbers, sysid
    )
    return [Emit(event, operator), Record(item), *_for_bridge(item, operator, name, now_ns)]


def stream_ended(source: str, sysid: int, code: str, sentence: str, samples: float) -> Record:
    """Samples of a stream were refused until it ended; `code` is the last reason."""
    numbers: dict[str, float | None] = {"refused_samples": samples}
    return Record(_of_stream(source, sysid, "ended", code, sentence, "", numbers))


def outcome(told: effects.Outcome, asked: Asked, sysid: int) -> list[Effect]:
    """How an accepted request ended."""
    item = DecisionItem(
        vehicle=sysid,
        request_id=told.request_id,
        source=asked.source,
        word=asked.word,
        phase="ending",
        outcome=told.kind.value,
        code=told.code.value if told.code else "",
        sentence=told.sentence,
        zone="",
        goal=None,
        numbers={},
    )
    event = ipc.EndingEvent(
        asked.ask.id, item.word, item.outcome, item.code, item.sentence, dict(told.numbers)
    )
    return [*(Emit(each, asked.operator) for each in asked.ending(sysid, event)), Record(item)]


def _of_stream(
    source: str,
    sysid: int,
    outcome: str,
    code: str,
    sentence: str,
    zone: str,
    numbers: dict[str, float | None],
) -> DecisionItem:
    """What becomes of a stream, which is no request: it has no number."""
    return DecisionItem(
        vehicle=sysid,
        request_id=0,
        source=source,
        word="stream",
        phase="stream",
        outcome=outcome,
        code=code,
        sentence=sentence,
        zone=zone,
        goal=None,
        numbers=numbers,
    )


def _reason(refusal: Refusal | None) -> tuple[str, str, str]:
    """Code, sentence and zone; empty where nothing is refused."""
    return (refusal.code.value, refusal.sentence, refusal.zone) if refusal else ("", "", "")


def _for_bridge(item: DecisionItem, operator: int, name: str, now_ns: int) -> list[Emit]:
    """What becomes of what a MAVLink client has asked for, or streams."""
    if operator < FIRST_NUMBER:
        return []
    return [
        Emit(
            ipc.BridgeDecision(
                time_ns=now_ns,
                client=operator,
                name=name,
                what=item.word,
                outcome=item.outcome,
                code=item.code,
                sentence=item.sentence,
                vehicle=item.vehicle,
            )
        )
    ]


def transition(
    told: effects.Transition,
    goal_ned: Vec3 | None,
    wrong: tuple[ConditionItem, ...],
    sysid: int,
) -> list[Work]:
    """The gate's state machine went to another state."""
    item = FsaItem(
        sysid,
        state=told.after.name,
        state_id=int(told.after),
        before=told.before.name,
        event=told.event,
        control=told.control.name,
        severity=told.severity.name,
        goal=_point(goal_ned),
        conditions=wrong,
    )
    event = ipc.StateEvent(item.before, item.state, item.event, item.control, item.severity)
    return [ToScreens(event), Record(item)]


def reminder(gate: Gate, sysid: int) -> list[Effect]:
    """The state once more, for the record: a state bar in a viewer ends at its last message."""
    item = FsaItem(
        sysid,
        state=gate.state.name,
        state_id=int(gate.state),
        before=gate.state.name,
        event="reminder",
        control=gate.control.name,
        severity=gate.severity.name,
        goal=_point(gate.active_goal_ned),
        conditions=conditions(gate),
    )
    return [Record(item)]


def origin(sysid: int, at: Origin | None) -> list[Effect]:
    """Where the vehicle's local frame begins; nothing while it is not known."""
    return [] if at is None else [Record(OriginItem(sysid, at.lat_deg, at.lon_deg, at.alt_amsl_m))]


def fence(zones: Iterable[Zone], origin: Origin | None, policy: Policy) -> list[Work]:
    """The fence as the verifier stands on it, zones in the local tangent plane."""
    where = None if origin is None else (origin.lat_deg, origin.lon_deg, origin.alt_amsl_m)
    shown = [_shape(zone) for zone in zones]
    item = FenceItem(shown, where, policy.margin_h_m, policy.margin_v_m)
    return [Record(item), ToScreens(ipc.Fences(item.zones))]


def shapes(zones: Iterable[Zone]) -> list[FenceShape]:
    """The zones as an operator that has just joined is told of them."""
    return [_shape(zone) for zone in zones]


def conditions(gate: Gate) -> tuple[ConditionItem, ...]:
    """What is wrong, the worst first."""
    active = [(gate.severity_of(name), name, text) for name, text in gate.reasons]
    active.sort(key=lambda one: -one[0])
    return tuple(ConditionItem(name.value, worth.name, text) for worth, name, text in active)


def _point(pos_ned: Vec3 | None) -> PointEnu | None:
    return None if pos_ned is None else PointEnu.of(pos_ned)


def _shape(zone: Zone) -> FenceShape:
    """A polygon has no centre and a circle no corners; an infinite bound is none."""
    floor_up_m = zone.floor_up_m if math.isfinite(zone.floor_up_m) else None
    ceiling_up_m = zone.ceiling_up_m if math.isfinite(zone.ceiling_up_m) else None
    if isinstance(zone.shape, Circle):
        corners_en, centre_en, radius_m = [], zone.shape.centre_en, zone.shape.radius_m
    else:
        corners_en, centre_en, radius_m = list(zone.shape.corners_en), None, 0.0
    return FenceShape(
        zone.name, zone.inclusion, corners_en, centre_en, radius_m, floor_up_m, ceiling_up_m
    )
