"""A client and the station on both sides of the plan server: what is said, and what it answers.

A line is an event, and all that comes of it but texts, of which only what stands in quotes is
looked for:

    count 2 fence -> gives up SUPERSEDED, ack OPERATION_CANCELLED, fence ask 0; "by another upload"

Events of the client are messages, of the type MISSION where none is named, `by another` component
of its link; `float` is an item in degrees, `collect 3` an upload up to its last item.  Of the
station: `accepted`, `refused CODE sentence`, `ended`, `aborted CODE sentence`, `finds sentence`.
`wait 100 ms` is time without the client; `is idle` says that nothing is waited for.  Answers are
questions (`ask`, `old` in the form of MISSION_REQUEST), MISSION_ACK, and what is asked of the
station; several that are the same have a number: `ask 4 x5`, and `asking` is any questions.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from gcs import ipc
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import Reply
from gcs.bridge.plans.effects import (
    Clear,
    Pass,
    PlanEffect,
    Refused,
    SetCurrent,
    Upload,
    Withdraw,
)
from gcs.bridge.plans.server import PlanServer
from gcs.gate.refusal import Code
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd, MavFrame, MissionResult, MissionType
from gcs.wire.messages import (
    Message,
    MissionAck,
    MissionClearAll,
    MissionCount,
    MissionItem,
    MissionItemInt,
    MissionRequest,
    MissionRequestInt,
    MissionRequestList,
    MissionSetCurrent,
    MissionWritePartialList,
    Statustext,
)

MS = 1_000_000
S = 1_000 * MS
VEHICLE = Address(1, 1)
BY = From(3, Address(245, 190), VEHICLE)
ANOTHER = From(3, Address(246, 190), VEHICLE)
TO = {"target_system": 1, "target_component": 1}


def item(seq: int, kind: int = MissionType.MISSION, z: float = 10.0) -> MissionItemInt:
    return MissionItemInt(
        0.0, 0.0, 0.0, 0.0, 473977000 + seq, 85455000, z, seq, Cmd.NAV_WAYPOINT, 1, 1,
        MavFrame.GLOBAL_RELATIVE_ALT_INT, 0, 1, kind,
    )  # fmt: skip


def float_item(seq: int, lat_deg: float = 47.3977) -> MissionItem:
    return MissionItem(
        0.0, 0.0, 0.0, 0.0, lat_deg, 8.5455, 10.0, seq, Cmd.NAV_WAYPOINT, 1, 1,
        MavFrame.GLOBAL_RELATIVE_ALT, 0, 1,
    )  # fmt: skip


def count(many: int, kind: int = MissionType.MISSION, opaque_id: int = 0) -> MissionCount:
    return MissionCount(count=many, mission_type=kind, opaque_id=opaque_id, **TO)


class Script:
    """A server, and the time."""

    def __init__(self) -> None:
        self.server = PlanServer()
        self.now_ns = 0

    def say(self, message: Message, by: From = BY) -> list[PlanEffect]:
        return self.server.handle(message, by, self.now_ns)

    def verdict(self, outcome: str, code: str = "", sentence: str = "") -> list[PlanEffect]:
        event = ipc.VerdictEvent(1, "mission_upload", outcome, code, sentence)
        return self.server.decided(event, self.now_ns)

    def ended(self, how: str = "complete", code: str = "", sentence: str = "") -> list[PlanEffect]:
        event = ipc.EndingEvent(1, "mission_upload", how, code, sentence)
        return self.server.ended(event, self.now_ns)

    def wait(self, span_ns: int) -> list[PlanEffect]:
        """All that happens in that time, with nothing from the client."""
        until_ns, effects = self.now_ns + span_ns, []
        while (due_ns := self.server.deadline_ns) is not None and due_ns <= until_ns:
            self.now_ns = due_ns
            effects += self.server.wake(due_ns)
        self.now_ns = until_ns
        return effects

    def collected(self, many: int, kind: int = MissionType.MISSION) -> list[PlanEffect]:
        """An upload of so many items, up to the last one."""
        effects = self.say(count(many, kind))
        for seq in range(many):
            self.now_ns += 5 * MS
            effects = self.say(item(seq, kind))
        return effects

    def play(self, script: str) -> None:
        """Each line as it says."""
        for line in map(str.strip, script.replace(";\n", ";").splitlines()):
            if not line or line.startswith("#"):
                continue
            event, _, expected = line.partition(" -> ")
            try:
                self._is(self._does(event), expected)
            except Exception as failed:
                failed.add_note(line)
                raise

    def _does(self, event: str) -> list[PlanEffect]:
        by = ANOTHER if event.endswith(" by another") else BY
        match event.removesuffix(" by another").split():
            case ["is", "idle"]:
                assert self.server.deadline_ns is None
                assert not self.server.busy
                return []
            case ["wait", many, unit]:
                return self.wait(int(many) * {"ns": 1, "ms": MS, "s": S}[unit])
            case ["accepted"]:
                return self.verdict("accepted")
            case ["refused", code, *sentence]:
                return self.verdict("refused", Code(code).value, " ".join(sentence))
            case ["ended"]:
                return self.ended()
            case ["aborted", code, *sentence]:
                return self.ended("aborted", code, " ".join(sentence))
            case ["finds", *sentence]:
                return self.server.finding(" ".join(sentence), self.now_ns)
            case ["collect", many, *kind]:
                return self.collected(int(many), _type(kind))
            case words:
                return self.say(_message(words), by)

    @staticmethod
    def _is(effects: Sequence[PlanEffect], expected: str) -> None:
        answers, _, texts = expected.partition(";")
        told = answers_of(effects)
        if answers.startswith("asking"):
            assert any(_is_question(each) for each in told)
            told = ["asking", *(each for each in told if not _is_question(each))]
        assert ", ".join(_numbered(told)) == answers.strip(), told
        said = texts_of(effects)
        for text in texts.split('"')[1::2]:
            assert (text in said) if text else not said, said


def _message(words: list[str]) -> Message:
    match words:
        case ["count", many, *kind]:
            return count(int(many), _type(kind))
        case ["item", seq, "at", z]:
            return item(int(seq), z=float(z))
        case ["item", seq, *kind]:
            return item(int(seq), _type(kind))
        case ["float", seq, *lat_deg]:
            return float_item(int(seq), *map(float, lat_deg))
        case ["ack", result, *kind]:
            return MissionAck(type=MissionResult[result], mission_type=_type(kind), **TO)
        case ["clear", *kind]:
            return MissionClearAll(mission_type=_type(kind), **TO)
        case ["list"]:
            return MissionRequestList(**TO)
        case ["request", seq]:
            return MissionRequestInt(seq=int(seq), **TO)
        case ["old_request", seq]:
            return MissionRequest(seq=int(seq), **TO)
        case ["write_partial"]:
            return MissionWritePartialList(start_index=1, end_index=1, **TO)
        case ["set_current", seq]:
            return MissionSetCurrent(seq=int(seq), **TO)
    raise AssertionError(words)


def _type(kind: Sequence[str]) -> int:
    (name,) = kind or ["MISSION"]
    return int(name) if name.isdecimal() else MissionType[name.upper()]


def _named(kind: int) -> str:
    """Before an answer."""
    known = kind in tuple(MissionType)
    name = MissionType(kind).name.lower() if known else str(kind)
    return "" if name == "mission" else f"{name} "


def answers_of(effects: Sequence[PlanEffect]) -> list[str]:
    """But for texts."""
    found: list[str] = []
    for effect in effects:
        match effect:
            case Reply(message=Statustext()):
                pass
            case Reply(message=MissionRequestInt(seq=seq, mission_type=kind)):
                found.append(f"{_named(kind)}ask {seq}")
            case Reply(message=MissionRequest(seq=seq, mission_type=kind)):
                found.append(f"{_named(kind)}old {seq}")
            case Reply(message=MissionAck(type=result, mission_type=kind)):
                found.append(f"{_named(kind)}ack {MissionResult(result).name}")
            case Upload(plan=plan):
                found.append(f"{_named(plan.kind)}upload {len(plan.items)}")
            case Clear(kind=kind):
                found.append(f"{_named(kind)}clear")
            case Withdraw():
                found.append("withdraw")
            case Pass():
                found.append("pass")
            case SetCurrent(seq):
                found.append(f"set current {seq}")
            case Refused(refusal=refusal, earlier=earlier):
                found.append(f"{'gives up' if earlier else 'refuses'} {refusal.code}")
            case _:
                raise AssertionError(effect)
    return found


def _is_question(answer: str) -> bool:
    return answer.startswith(("ask ", "old "))


def _numbered(answers: Sequence[str]) -> list[str]:
    runs = [(answer, len([*run])) for answer, run in groupby(answers)]
    return [answer if many == 1 else f"{answer} x{many}" for answer, many in runs]


def texts_of(effects: Sequence[PlanEffect]) -> str:
    said = [effect.message for effect in effects if isinstance(effect, Reply)]
    return "".join(each.text for each in said if isinstance(each, Statustext))
