"""Each fact is made once: the line that the operator gets of it, and the message in the record."""

from __future__ import annotations

import math
from collections.abc import Sequence

from gcs import ipc
from gcs.gate.airspace.projection import Origin
from gcs.gate.airspace.zones import Zone
from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import Level, Outcome, OutcomeKind, Ruling, Transition
from gcs.gate.geometry import Circle, Polygon
from gcs.gate.inputs import ConditionChanged
from gcs.gate.machine.gate import Gate
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import Control, State
from gcs.record.derived.gate_json import GateJson
from gcs.record.derived.vehicle_json import VehicleJson
from gcs.report import ConditionItem, FenceItem, FsaItem, LogEvent
from gcs.session import announcements
from gcs.session.effects import Emit, Record
from gcs.session.requests import Asked
from gcs.session.work import GiveVerdict, Log, ToScreens, Work

ASKED = Asked(ipc.Ask(3, "goto"))
WRONG = (ConditionItem("battery_low", "CAUTION", "14 % are left"),)
NOW_NS = 1_700_000_000_000_000_000


def told(effects: Sequence[Work]) -> tuple[list[str], list[str]]:
    """The operator's lines, and the messages of the JSON topics."""
    lines, messages, topics = [], [], (GateJson(), VehicleJson())
    for effect in effects:
        if isinstance(effect, Emit | ToScreens):
            lines.append(ipc.encode(effect.event).decode().rstrip("\n"))
        elif isinstance(effect, Record):
            made = [out for part in topics for out in part.handle(effect.item, NOW_NS)]
            messages += [m.message.decode() for m in made if m.channel.topic != "/gate/requests"]
    return lines, messages


def test_a_refusal_is_told_with_its_numbers_in_the_operators_frame() -> None:
    refusal = Refusal(Code.OUTSIDE_FENCE, "350 m outside", (("distance_m", 350.0),), "home")
    goal_ned = (0.0, 500.0, -2.0)
    decide = GiveVerdict(7, Ruling.REFUSED, refusal, goal_ned=goal_ned)
    assert told(announcements.verdict(decide, ASKED, "", 1, NOW_NS)) == (
        [
            '{"type":"verdict","id":3,"word":"goto","outcome":"refused","code":"OUTSIDE_FENCE",'
            '"sentence":"350 m outside","zone":"home","numbers":{"distance_m":350.0},'
            '"goal_enu":[500.0,0.0,2.0],"operation":7}'
        ],
        [
            '{"vehicle":1,"request_id":7,"source":"operator","word":"goto","phase":"verdict",'
            '"outcome":"refused","code":"OUTSIDE_FENCE","sentence":"350 m outside","zone":"home",'
            '"goal":{"east_m":500.0,"north_m":0.0,"up_m":2.0},"numbers":{"distance_m":350.0}}'
        ],
    )


def test_a_goal_that_is_no_number_is_null() -> None:
    goal_ned = (math.nan, 1.0, -math.inf)
    refusal = Refusal(Code.NON_FINITE, "north is no number")
    decide = GiveVerdict(7, Ruling.REFUSED, refusal, goal_ned=goal_ned)
    (line,), (message,) = told(announcements.verdict(decide, ASKED, "", 1, NOW_NS))
    assert '"goal_enu":[1.0,null,null]' in line
    assert '"goal":{"east_m":1.0,"north_m":null,"up_m":null}' in message


def test_an_acceptance_has_its_evidence_and_a_request_without_a_goal_none() -> None:
    decide = GiveVerdict(7, Ruling.ACCEPTED, evidence=(("stop_m", 1.5),))
    (line,), (message,) = told(announcements.verdict(decide, ASKED, "", 1, NOW_NS))
    assert '"numbers":{"stop_m":1.5},"goal_enu":null,"operation":7}' in line
    assert '"outcome":"accepted","numbers":{"stop_m":1.5}}' in message
    assert "goal" not in message


def test_an_ending_is_a_decision_of_the_record() -> None:
    ended = Outcome(7, OutcomeKind.ABORTED, Code.STALE, "no position")
    assert told(announcements.outcome(ended, ASKED, 1)) == (
        [
            '{"type":"ending","id":3,"word":"goto","ended":"aborted","code":"STALE",'
            '"sentence":"no position","numbers":{}}'
        ],
        [
            '{"vehicle":1,"request_id":7,"source":"operator","word":"goto","phase":"ending",'
            '"outcome":"aborted","code":"STALE","sentence":"no position","numbers":{}}'
        ],
    )


def test_a_transition_and_its_goal() -> None:
    moved = Transition(
        State.HOVERING, State.MOVING, "goal verified", Control.OURS, Severity.CAUTION
    )
    assert told(announcements.transition(moved, (1.0, 2.0, -3.0), WRONG, 1)) == (
        [
            '{"type":"state","before":"HOVERING","after":"MOVING","event":"goal verified",'
            '"control":"OURS","severity":"CAUTION"}'
        ],
        [
            '{"state":"MOVING","state_id":3,"before":"HOVERING","event":"goal verified",'
            '"control":"OURS","severity":"CAUTION",'
            '"goal":{"east_m":2.0,"north_m":1.0,"up_m":3.0},'
            '"conditions":[{"name":"battery_low","severity":"CAUTION","text":"14 % are left"}]}'
        ],
    )


def test_a_reminder_is_for_the_record_only() -> None:
    assert told(announcements.reminder(Gate(DEFAULT, "px4", NOW_NS), 1)) == (
        [],
        [
            '{"state":"NO_VEHICLE","state_id":4,"before":"NO_VEHICLE","event":"reminder",'
            '"control":"NONE","severity":"NOMINAL","conditions":[]}'
        ],
    )


def test_what_is_wrong_is_told_in_words_the_worst_first() -> None:
    gate = Gate(DEFAULT, "px4", NOW_NS)
    gate.handle(ConditionChanged(Condition.BATTERY_LOW, True, "14 % are left"), NOW_NS)
    gate.handle(ConditionChanged(Condition.GPS_LOST, True, "no 3D fix"), NOW_NS)
    assert announcements.conditions(gate) == (
        ConditionItem("gps_lost", "HOLD", "no 3D fix"),
        ConditionItem("battery_low", "CAUTION", "14 % are left"),
    )
    gate.handle(ConditionChanged(Condition.GPS_LOST, False, "3D fix"), NOW_NS)
    (effect,) = announcements.reminder(gate, 1)
    assert isinstance(effect, Record)
    assert isinstance(effect.item, FsaItem)
    assert [one.name for one in effect.item.conditions] == ["battery_low"]


def test_the_fence_is_one_list_of_zones_for_both() -> None:
    circle = Zone("home", True, Circle((1.0, 2.0), 150.0), 0.0, 50.0)
    corners = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0))
    open_above = Zone("tower", False, Polygon(corners))
    record, emit = announcements.fence([circle, open_above], Origin(47.4, 8.5, 488.0), DEFAULT)
    assert isinstance(record, Record)
    assert isinstance(record.item, FenceItem)
    assert record.item.origin == (47.4, 8.5, 488.0)
    assert (record.item.margin_h_m, record.item.margin_v_m) == (2.0, 0.3)  # default.toml
    assert isinstance(emit, ToScreens)
    assert isinstance(emit.event, ipc.Fences)
    assert emit.event.zones is record.item.zones
    assert ipc.encode(emit.event) == (
        b'{"type":"fences","zones":[{"name":"home","inclusion":true,"corners_en":[],'
        b'"centre_en":[1.0,2.0],"radius_m":150.0,"floor_up_m":0.0,"ceiling_up_m":50.0},'
        b'{"name":"tower","inclusion":false,"corners_en":[[0.0,0.0],[10.0,0.0],[10.0,10.0]],'
        b'"centre_en":null,"radius_m":0.0,"floor_up_m":null,"ceiling_up_m":null}]}\n'
    )


def test_a_log_line_is_the_same_object_for_both() -> None:
    emit, record = announcements.log(Log(Level.WARNING, "gate", "too far"), NOW_NS)
    assert isinstance(emit, Emit)
    assert isinstance(record, Record)
    assert emit.event is record.item
    assert record.item == LogEvent(NOW_NS, 3, "gate", "too far")
    assert ipc.encode(emit.event) == (
        b'{"type":"log","time_ns":1700000000000000000,"level":3,"node":"gate","text":"too far"}\n'
    )
