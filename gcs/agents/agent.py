"""What an agent may ask of a station, and what it is answered: a dictionary, made for JSON.

Everything that moves the vehicle is checked first and then asked for by the verdict's number alone
(`verdicts.py`); what makes it safer is always free.  What takes long has a lease, which the station
keeps (`gcs/station/leases.py`).  Every call and its answer is told to the station, which records
them.  Calls may come from several threads.
"""

from __future__ import annotations

import contextlib
import hashlib
import math
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias

import msgspec

from gcs import ipc, request_words
from gcs.agents.untrusted import sentence, untrusted, vehicle_texts
from gcs.agents.verdicts import ASKED_VALID_NS, VALID_NS, Denied, Situation, Verdict, Verdicts
from gcs.operator.failures import Disconnected, GcsError, NotCompleted, Refused
from gcs.operator.operation import Operation
from gcs.operator.station import Station

Answer: TypeAlias = dict[str, object]
LEASE_S: Final = 15.0
ANSWER_WAIT_S: Final = 10.0
MISSION_WAIT_S: Final = 60.0
KEPT_DECISIONS: Final = 50
KEPT_TEXTS: Final = 20
NOTED_LETTERS: Final = 80

STOPS: Final = ("hold", "land", "rtl", "abort")
"""Free at any time, without a verdict."""
ASKS_A_PERSON: Final = frozenset({"arm", "takeoff", "mission_start", "control", "resume"})
"""The last two take over from a pilot, or go on after somebody's hold."""
LOOKS: Final = frozenset({"status", "operation", "renew"})
"""Calls that are recorded, and are no decisions."""
LEASED: Final = frozenset({"goto", "takeoff", "mission_start"})
ACTS: Final = (
    *("goto", "takeoff", "arm", "disarm", "control", "resume"),
    *("photo", "mission_upload", "mission_start"),
)
"""What can be checked and then done, as words of requests."""


@dataclass(frozen=True, slots=True)
class PlanFile:
    """A mission's file as it was checked without the vehicle: a code where it is refused."""

    path: str
    digest: str
    code: str = ""
    sentence: str = ""
    findings: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Around:
    """What an agent needs and the station does not tell.

    `session`: letters that no other session has.  `same_clock`: the station's clock runs as fast as
    `now_ns`, both from 1970.  `policy`: its name, digest and text.  `read_plan`
    reads and checks a mission's file by the name that an agent may give it.
    """

    session: str
    same_clock: bool
    policy: str
    policy_digest: str
    policy_text: str
    now_ns: Callable[[], int]
    read_plan: Callable[[str], PlanFile | Denied]


class Agent:
    """One agent at one station, as one operator of it."""

    def __init__(self, station: Station, around: Around) -> None:
        self._station = station
        self._around = around
        self._verdicts = Verdicts(around.session)
        self._operations: dict[int, Operation] = {}
        self._decisions: deque[Answer] = deque(maxlen=KEPT_DECISIONS)

    # ------------------------------------------------------------------------------ looks

    def state(self) -> Answer:
        """Everything that is known of the vehicle, with the age of what may be old."""
        seen = self._station.snapshot
        told = msgspec.to_builtins(seen)
        age_s = max(0.0, (self._around.now_ns() - seen.time_ns) / 1e9)
        told["age_s"] = age_s if self._around.same_clock else None
        told["in_control"] = "nobody"
        if seen.in_control is not None:
            mine = self._station.in_control
            name = untrusted("another program", seen.in_control.name)
            told["in_control"] = "you" if mine else {"client": seen.in_control.client, **name}
        told["vehicle_texts"] = vehicle_texts([*self._station.talk.lines], KEPT_TEXTS)
        return {"outcome": "ok", "state": told}

    def status(self) -> Answer:
        """The same, as a call."""
        return self._noted("status", {}, self.state())

    def note_read(self, resource: str) -> None:
        """For the record: a resource was read."""
        self._station.tell(ipc.Note(f"read {resource}"))

    def policy(self) -> Answer:
        """What the gate judges by: the policy's file, and the fence as it stands."""
        return {
            "name": self._around.policy,
            "digest": self._situation().policy,
            "toml": self._around.policy_text,
            "fence": msgspec.to_builtins(self._station.talk.fence),
        }

    def decisions(self) -> Answer:
        """The latest calls of this agent with their answers, and how its operations stand."""
        ids = [*self._operations]
        return {"calls": [*self._decisions], "operations": [self._stands(one) for one in ids]}

    # ----------------------------------------------------------------------------- checks

    def check(self, action: str, arguments: Mapping[str, object]) -> Answer:
        """Would this be accepted now?  Where it would: the number of a verdict to do it with."""
        return self._noted("check", {"action": action, **arguments}, self._check(action, arguments))

    def why_not(self, action: str, arguments: Mapping[str, object]) -> Answer:
        """The same without a verdict."""
        answer = self._check(action, arguments, issues=False)
        return self._noted("why_not", {"action": action, **arguments}, answer)

    def _check(
        self, action: str, arguments: Mapping[str, object], *, issues: bool = True
    ) -> Answer:
        given = {name: value for name, value in arguments.items() if value is not None}
        ask = _ask_of(action, given)
        if isinstance(ask, Denied):
            return _denied(ask)
        digest = ""
        situation = self._situation()
        try:
            if action == "mission_upload":
                plan = self._around.read_plan(ask.path)
                if isinstance(plan, Denied):
                    return _denied(plan)
                if plan.code:
                    findings = [untrusted("a check that quotes the file", x) for x in plan.findings]
                    return {**_refused(plan.code, plan.sentence), "findings": findings}
                digest, ask = plan.digest, msgspec.structs.replace(ask, path=plan.path)
            elif action == "mission_start":
                self._station.request(ipc.Ask(0, "mission_check"), timeout_s=MISSION_WAIT_S)
            else:
                told = self._station.check(ask, ANSWER_WAIT_S)
                if told.outcome != "accepted":
                    return _of_check(told)
        except GcsError as error:
            return failed(error)
        if not issues:
            return {"outcome": "accepted"}
        asks = action in ASKS_A_PERSON
        label = request_words.label(ask)
        verdict = self._verdicts.keep(
            ask,
            label,
            situation,
            self._around.now_ns(),
            valid_ns=ASKED_VALID_NS if asks else VALID_NS,
            plan_digest=digest,
        )
        return {
            "outcome": "accepted",
            "verdict": verdict.number,
            "for": label,
            "valid_s": verdict.valid_ns / 1e9,
            "bound_to": {
                "policy": situation.policy,
                "state": situation.state,
                "position_enu": situation.pos_enu,
            },
            "asks_a_person": asks,
        }

    # ------------------------------------------------------------------------------- acts

    def question(self, word: str, verdict: str) -> str | Denied:
        """What a person is asked before `word` is done; Denied where it would be refused anyway."""
        found = self._verdicts.look(verdict, word, self._situation(), self._around.now_ns())
        if isinstance(found, Denied):
            return found
        vehicle = self._station.snapshot.vehicle or "the vehicle"
        return f"An agent asks for: {found.label} ({vehicle}, verdict {verdict}). Allow it?"

    def not_allowed(self, word: str, verdict: str, why: str) -> Answer:
        """Nobody could be asked, or who was asked has not allowed it."""
        self._verdicts.take(verdict, word, self._situation(), self._around.now_ns())
        answer = _refused("NOT_ALLOWED", f"{word} is for a person to allow: {why}")
        return self._noted(word, {"verdict": verdict}, answer)

    def act(self, word: str, verdict: str) -> Answer:
        """Do what was checked, and nothing else.  Returns when it is accepted or refused."""
        return self._noted(word, {"verdict": verdict}, self._act(word, verdict))

    def _act(self, word: str, given: str) -> Answer:
        verdict = self._verdicts.take(given, word, self._situation(), self._around.now_ns())
        if isinstance(verdict, Denied):
            return _denied(verdict)
        if verdict.plan_digest and not self._is_same_plan(verdict):
            return _refused("CHANGED_SITUATION", "the file has changed since it was checked")
        lease_s = LEASE_S if word in LEASED else None
        ask = msgspec.structs.replace(verdict.ask, lease_s=lease_s)
        return self._ask(ask, {} if lease_s is None else {"lease_s": lease_s})

    def _is_same_plan(self, verdict: Verdict) -> bool:
        plan = self._around.read_plan(verdict.ask.path)
        return isinstance(plan, PlanFile) and plan.digest == verdict.plan_digest

    def stop(self, word: str) -> Answer:
        """One of `STOPS`, at once.  The answer says which operations it has cut off, and where."""
        running = [each for each in self._operations.values() if each.state == "running"]
        cut_off = [self._stands(each.id) for each in running]
        answer = self._ask(ipc.Ask(0, word), {"cut_off": cut_off} if cut_off else {})
        return self._noted(word, {}, answer)

    def _ask(self, ask: ipc.Ask, more: Answer) -> Answer:
        try:
            operation = self._station.request(ask, wait=False, timeout_s=ANSWER_WAIT_S)
        except GcsError as error:
            return {**failed(error), **more}
        self._operations[operation.id] = operation
        return {
            "outcome": "accepted",
            "operation": operation.id,
            "doing": request_words.label(operation.asked),
            **more,
        }

    # ------------------------------------------------------------------------- operations

    def operation(self, operation: int) -> Answer:
        """How an operation of this agent stands; this does not renew its lease."""
        return self._noted("operation", {"operation": operation}, self._stands(operation))

    def renew(self, operation: int) -> Answer:
        """It is still watched: its lease begins anew.  And how it stands."""
        if operation in self._operations:
            self._station.tell(ipc.Renew(operation))
        return self._noted("renew", {"operation": operation}, self._stands(operation))

    def _stands(self, operation_id: int) -> Answer:
        operation = self._operations.get(operation_id)
        if operation is None:
            return _refused("UNKNOWN_OPERATION", "no operation of this session has that number")
        asked = operation.asked
        answer: Answer = {
            "outcome": "ok",
            "operation": operation_id,
            "doing": request_words.label(asked),
            "operation_state": operation.state,
        }
        ending = operation.ending
        if ending is not None and ending.ended != "complete":
            answer |= {"code": ending.code, **sentence(ending.code, ending.sentence)}
        position = self._station.snapshot.pos_enu
        goal = asked.goal_enu
        if goal is not None and position is not None and None not in goal:
            answer["to_goal_m"] = round(math.dist(position, [metres or 0.0 for metres in goal]), 2)
        return answer

    # -------------------------------------------------------------------------- internals

    def _situation(self) -> Situation:
        fence = hashlib.sha256(msgspec.json.encode(self._station.talk.fence)).hexdigest()[:16]
        policy = f"{self._around.policy_digest}-{fence}"
        return Situation.of(policy, self._station.snapshot)

    def _noted(self, call: str, arguments: Mapping[str, object], answer: Answer) -> Answer:
        """The call and what was answered, for the record and for `decisions`."""
        given = {
            name: value[:NOTED_LETTERS] if isinstance(value, str) else value
            for name, value in arguments.items()
            if value is not None
        }
        names = ("outcome", "code", "verdict", "operation", "operation_state")
        said = {name: answer[name] for name in names if name in answer}
        if call not in LOOKS:
            now_ns = self._around.now_ns()
            self._decisions.append({"time_ns": now_ns, "call": call, **given, **said})
        words = [msgspec.json.encode(part).decode() for part in (given, said)]
        with contextlib.suppress(Disconnected):  # the answer says so
            self._station.tell(ipc.Note(f"{call} {words[0]} -> {words[1]}"))
        return answer


def _ask_of(action: str, given: Mapping[str, object]) -> ipc.Ask | Denied:
    """The request, with exactly the arguments that the action has."""
    if action not in ACTS:
        return Denied("UNKNOWN_ACTION", f"no such action; there are: {', '.join(ACTS)}")
    needed = {
        "goto": ("east_m", "north_m", "up_m"),
        "takeoff": ("up_m",),
        "mission_upload": ("plan",),
    }.get(action, ())
    allowed = {*needed, "yaw_deg"} if action == "goto" else {*needed}
    missing = [name for name in needed if name not in given]
    excess = sorted(given.keys() - allowed)
    if missing or excess:
        wrong = f"needs {', '.join(missing)}" if missing else f"has no {', '.join(excess)}"
        return Denied("BAD_REQUEST", f"{action} {wrong}")
    if action == "mission_upload":
        return ipc.Ask(0, action, path=str(given["plan"]))
    # What is not finite travels as null, and is refused by the gate.
    numbers = {name: _finite(float(str(value))) for name, value in given.items()}
    if action == "goto":
        goal = (numbers["east_m"], numbers["north_m"], numbers["up_m"])
        return ipc.Ask(0, action, goal_enu=goal, yaw_deg=numbers.get("yaw_deg"))
    return ipc.Ask(0, action, up_m=numbers.get("up_m"))


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _refused(code: str, text: str, numbers: Mapping[str, float | None] | None = None) -> Answer:
    answer: Answer = {"outcome": "refused", "code": code, **sentence(code, text)}
    return {**answer, "numbers": dict(numbers)} if numbers else answer


def _denied(denied: Denied) -> Answer:
    return _refused(denied.code, denied.sentence)


def _of_check(told: ipc.Checked) -> Answer:
    """A check that was not accepted; of a goal that cannot be flown to yet, what is against it."""
    if told.outcome == "waits":
        return _refused("BUSY", "it would be decided later: check again when what flies has ended")
    answer = _refused(told.code, told.sentence, told.numbers)
    if told.goal_code and told.goal_code != told.code:
        answer["goal"] = {"code": told.goal_code, "sentence": told.goal_sentence}
    return answer


def failed(error: GcsError) -> Answer:
    match error:
        case Refused():
            return _refused(error.code, error.sentence, error.numbers)
        case NotCompleted():
            return _refused(error.code or "NOT_COMPLETED", f"{error.state}: {error.sentence}")
        case _:
            return _refused(error.code, error.sentence)
