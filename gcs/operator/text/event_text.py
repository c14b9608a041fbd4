"""How a station's events are written: one exact line each, that can be searched for."""

from __future__ import annotations

from gcs import ipc, request_words
from gcs.enu_text import signed_enu
from gcs.gate.condition import Condition
from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.operator.client import StationEnded
from gcs.operator.conversation import TrackedRequest
from gcs.operator.errors import error_lines
from gcs.operator.text.control_text import control_words

LEVELS = ("", "DEBUG", "INFO", "WARN", "ERROR", "FATAL")


def verdict_line(label: str, event: ipc.VerdictEvent) -> str:
    """`goto 500 0 2: refused OUTSIDE_FENCE: the goal is ...`, `arm: accepted`."""
    sentence = refused_by_rule(event) or event.sentence
    return answer_line(label, event.outcome, event.code, sentence)


def refused_by_rule(event: ipc.VerdictEvent) -> str:
    """The sentence with the rule that a policy's refusal rests on; empty if it rests on none."""
    rule = _RULES.get(event.word, "") if event.code == Code.POLICY else ""
    return f"{event.sentence}: {rule}" if rule else ""


_RULES = {
    "fence": "its key fence_switchable is false",
    "disarm": "its key allow_force_disarm is false",
    "mode": "only modes that hold, land, return, are guided or fly the mission may be asked for",
}
"""What a policy's refusal of a word rests on."""


def outcome_line(label: str, event: ipc.EndingEvent) -> str:
    """`goto 3 0 2: complete`, `goto 3 0 2: aborted OPERATOR: ...`."""
    return answer_line(label, event.ended, event.code, event.sentence)


def answer_line(label: str, what: str, code: str, sentence: str) -> str:
    """Label, what became of the request, and the reason if there is one."""
    coded = f"{what} {code}" if code else what
    why = reason(what, code, sentence)
    return f"{label}: {coded}: {why}" if why else f"{label}: {coded}"


def reason(what: str, code: str, sentence: str) -> str:
    """The sentence; empty if it only repeats `what`.

    Whoever can still read that the operator is lost is the operator, who left in good order.
    """
    if code == Code.OPERATOR_LOST:
        return sentence.replace("the operator is lost", "the operator left")
    return "" if sentence.lower() == what else sentence


def log_line(event: ipc.LogEvent) -> str:
    """`INFO  gate: HOVERING -> MOVING`."""
    return f"{LEVELS[event.level]:<5} {event.node}: {event.text}"


def trouble_lines(event: ipc.Trouble) -> list[str]:
    return error_lines(event.text, event.hint)


def bye_lines(bye: ipc.Bye, *, simulated: bool = False) -> list[str]:
    """Where the vehicle is, and where the record.  `simulated`: it was the station's own."""
    lines = [f"gcs: {bye.sentence}"] if bye.sentence else []
    if simulated:
        lines.append("gcs: the simulation has ended with it, and its vehicle")
    return [*lines, f"log: {bye.log_path}"] if bye.log_path else lines


def end_lines(ended: StationEnded, *, simulated: bool = False) -> list[str]:
    """The same, and that there was no good-bye, with what the process said last."""
    if ended.bye is None:
        return [f"gcs: the link ended without a good-bye\n{ended.stderr_tail}".rstrip()]
    return bye_lines(ended.bye, simulated=simulated)


def whole_degrees(yaw_deg: float) -> int:
    """A heading in whole degrees clockwise from north, 0 to 359."""
    return round(yaw_deg) % 360


def state_line(seen: ipc.Snapshot | None, number: int, name: str = "state") -> str:
    """One line that begins with `name`: state, control, severity, position in m, mode, motors,
    battery, and who is in control as operator `number` is told it.

    `state: HOVERING, control OURS, severity NOMINAL, at E +0.00 N +0.00 U +2.00 m, ...`
    """
    if seen is None or not seen.vehicle:
        return f"{name}: nothing heard yet"
    return f"{name}: {vehicle_words(seen)}, in control: {control_words(seen, number)}"


def vehicle_words(seen: ipc.Snapshot) -> str:
    """The vehicle in a line.  Of a lost one the mode is not told: it may be in another by now."""
    armed = {None: "armed unknown", True: "armed", False: "disarmed"}[seen.armed]
    battery = "-" if seen.battery_pct is None else f"{seen.battery_pct:.0f} %"
    told = f"{seen.state}, control {seen.control}, severity {seen.severity}"
    place = f"at {signed_enu(seen.pos_enu)} m"
    if seen.vehicle and seen.state == State.NO_VEHICLE.name:
        return (
            f"{told}, {lost_words(seen.heartbeat_age_s)}, last {place}, {armed}, battery {battery}"
        )
    return f"{told}, {place}, mode {seen.mode or '-'}, {armed}, battery {battery}"


def lost_words(silent_s: float | None) -> str:
    """Of a vehicle that was heard and is not any more: `lost for 12 s`."""
    return "lost" if silent_s is None else f"lost for {silent_s:.0f} s"


def operation_line(operation: ipc.Operation, now_ns: int) -> str:
    """`7  goto 3 0 2: running for 12 s, asked by operator 1 (gcs fly, pid 4711)`."""
    who = f"operator {operation.client} ({operation.operator})"
    until_ns = now_ns if operation.ended_ns is None else operation.ended_ns
    how = f"{operation.state} {operation.code}".rstrip()
    why = reason(operation.state, operation.code, operation.sentence)
    text = f"{how}: {why}" if why else how
    lasted_s = max(0.0, (until_ns - operation.since_ns) / 1e9)
    told = "for" if operation.ended_ns is None else "after"
    label = request_words.label(operation.asked)
    if operation.asked.vehicle:
        label += f" of vehicle {operation.asked.vehicle}"
    return f"{operation.id:>3}  {label}: {text}, {told} {lasted_s:.0f} s, asked by {who}"


WARNING = 3
"""The level of `ipc.LogEvent`."""
STANDING_CAUTION = Condition.VEHICLE_FAILSAFE_WEAK.value


class WarningFilter:
    """Is given every event, in order.

    A request of one's own that is refused or fails is in the log as well: the answer has said it
    already.  And that the vehicle's own failsafes are weak is as true before each of a hundred
    commands: `cautions` says whether it is shown.
    """

    def __init__(self, *, cautions: bool) -> None:
        self._cautions = cautions
        self._answered: set[str] = set()

    def hides(self, event: ipc.Event, request: TrackedRequest | None) -> bool:
        if isinstance(event, ipc.VerdictEvent | ipc.EndingEvent):
            if request is not None and event.sentence:
                self._answered.add(event.sentence)
            return False
        if not isinstance(event, ipc.LogEvent) or event.level != WARNING:
            return False
        if not self._cautions and STANDING_CAUTION in event.text:
            return True
        return any(event.text.endswith(sentence) for sentence in self._answered)
