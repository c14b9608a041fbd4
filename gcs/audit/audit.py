"""The audit of one session: every recorded input again, and what came of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from gcs.audit import describe
from gcs.audit.compare import Pair, Scope, differing
from gcs.audit.keys import forged
from gcs.audit.messages import Attachments, Stored
from gcs.audit.replay import Replay
from gcs.audit.seals import Altered, Missing
from gcs.audit.turns import RecorderTurn, Turn, Turns
from gcs.frames import Vec3
from gcs.gate.policy.policy import Policy
from gcs.session.effects import AskRule
from gcs.session.inputs import RuleSaid
from gcs.vehicle.record_items import Start

KEPT_DIFFERENCES = 1_000
"""So many are told; all are counted."""
SETUP = "the set-up"


@dataclass(frozen=True, slots=True)
class Difference:
    """One thing that was recorded, and what came of the same inputs now; both in words."""

    t_s: float
    """Since the beginning of the session."""
    log_time_ns: int
    kind: str
    after: str
    """The input that led to it."""
    recorded: str
    reproduced: str


@dataclass(slots=True)
class AuditResult:
    """The whole answer; `msgspec.json.encode` makes `--json` of it."""

    version: str = ""
    """Of the mavgate that recorded, and below the environment that it ran in."""
    environment: str = ""
    audited_by: str = ""
    audited_in: str = ""
    seconds: float = 0.0
    inputs: dict[str, int] = field(default_factory=dict)
    compared: dict[str, int] = field(default_factory=dict)
    """Messages by kind, every one byte for byte."""
    differences: int = 0
    first: list[Difference] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    """What else is to be known: another version, a file that breaks off, what was not compared."""
    whole: bool = True
    """False where a part of the record could not be audited: a note says which."""
    ended: bool = True
    """False where it has no end: its station was killed, or its end was cut off."""

    @property
    def good(self) -> bool:
        """All that is recorded was reproduced."""
        return self.whole and self.differences == 0


OwnRule: TypeAlias = Callable[[tuple[tuple[Vec3, Vec3], ...], Policy], tuple[str | None, bool]]
"""The auditor's own copy of the operator's rule: asked about the legs of a request (ENU, metres),
it says its sentence, or None where it permits; and whether it failed."""


def audit(
    messages: Iterable[Stored],
    attachments: Attachments,
    version: str,
    environment: str,
    rule: OwnRule | None = None,
) -> AuditResult:
    """`messages` are those of all files of one session, in order, `attachments` likewise;
    `version` and `environment` are the auditor's own.

    The answers of an operator's own rule are inputs, as the operator's lines are: nothing that is
    attached to a record is ever run.  `rule`, if given, is asked again and compared with them.
    Raises NoStartError where it is not the record of a session from its beginning.
    """
    result = AuditResult(audited_by=version, audited_in=environment)
    return _Audit(result, attachments, rule).run(messages)


class _Audit:
    def __init__(self, result: AuditResult, attachments: Attachments, rule: OwnRule | None) -> None:
        self._result = result
        self._attachments = attachments
        self._rule = rule
        self._rule_answers: list[int] = []
        """The requests on which the operator's own rule was asked, and has answered."""
        self._inputs: Counter[str] = Counter()
        self._compared: Counter[str] = Counter()
        self._scope = Scope()
        self._start_ns = 0
        self._end_ns = 0

    def run(self, messages: Iterable[Stored]) -> AuditResult:
        result = self._result
        turns = Turns(messages, self._attachments)
        replay: Replay | None = None
        for turn in turns:
            if turn.start is not None:
                replay = self._begin(turn.start)
            assert replay is not None, "the first turn has the set-up"
            self._turn(turn, replay)
        if replay is not None:
            self._attached(replay.attachments)
            self._rule_noted(replay)
        for altered in turns.altered:
            self._altered(altered)
        self._ending(turns)
        result.first.sort(key=lambda difference: difference.log_time_ns)
        result.seconds = (self._end_ns - self._start_ns) / 1e9
        result.inputs, result.compared = dict(self._inputs), dict(self._compared)
        return result

    def _begin(self, start: Start) -> Replay:
        result, setup = self._result, start.setup
        self._start_ns = self._end_ns = start.start_ns
        result.version, result.environment = setup.version, setup.environment
        same = result.version == result.audited_by
        if not same:
            result.notes.append(
                f"recorded by mavgate {result.version}, audited by {result.audited_by}: only what "
                "happened is compared, not the topics that are drawn from it"
            )
        if result.environment != result.audited_in:
            result.notes.append(
                f"recorded with {result.environment or 'an unknown Python'}, audited with "
                f"{result.audited_in}: the last digit of a number may differ"
            )
        self._scope = replace(
            scope_of(setup.environment, result.audited_in, same_version=same),
            signed=bool(setup.config.vehicle_key_path or setup.config.client_key_path),
        )
        if self._scope.signed:
            result.notes.append(
                "its frames were signed with a key that is in no record: their signatures are not "
                "compared, and that those that came in were right is taken from the record"
            )
        if not self._scope.log:
            result.notes.append("log lines are not compared: foxglove-sdk is only on one side")
        return Replay(start)

    def _turn(self, turn: Turn, replay: Replay) -> None:
        given, recorded = turn.given, turn.messages
        if isinstance(given, RuleSaid) and given.request_id in replay.rule_asked:
            self._rule_said(turn, given, replay.rule_asked[given.request_id], replay.policy)
        reproduced = replay.turn(given, turn.now_ns, forged(recorded) if self._scope.signed else ())
        self._inputs[describe.kind_of_input(given)] += 1
        self._end_ns = turn.now_ns
        if isinstance(given, RecorderTurn):
            # A seal counts and sums up what was before it; Turns has looked at it.
            recorded, reproduced = recorded[1:], reproduced[1:]
        self._compared.update(map(describe.kind_of_message, self._scope.of(recorded)))
        for surprise in replay.surprises:
            self._difference(turn, "course", surprise.recorded, surprise.reproduced)
        for pair in differing(recorded, reproduced, self._scope, cut=turn.cut):
            self._different(turn, pair)

    def _rule_said(self, turn: Turn, said: RuleSaid, asked: AskRule, policy: Policy) -> None:
        self._rule_answers.append(said.request_id)
        if self._rule is None:
            return
        anew, failed = self._rule(asked.legs_enu, policy)
        if anew != said.refusal and not (failed and said.failed):
            self._difference(turn, "own rule", said.refusal or "permits", anew or "permits")

    def _rule_noted(self, replay: Replay) -> None:
        """What of the own rule was done again, and what was not."""
        unanswered = sorted(set(replay.rule_asked) - set(self._rule_answers))
        if self._rule_answers and self._rule is None:
            self._result.notes.append(
                f"the answers of the operator's own rule on {_requests(self._rule_answers)} were "
                "taken from the record, and not reproduced: --verifier FILE asks it again"
            )
        elif self._rule is not None:
            asked = f"was asked again on {_requests(self._rule_answers)}"
            self._result.notes.append(f"the own rule {asked if self._rule_answers else 'had none'}")
        if unanswered:
            self._result.notes.append(f"the own rule never answered on {_requests(unanswered)}")

    def _different(self, turn: Turn, pair: Pair) -> None:
        one = pair[0] or pair[1]
        assert one is not None
        if self._result.differences >= KEPT_DIFFERENCES:
            self._result.differences += 1
            return
        self._difference(turn, describe.kind_of_message(one), *describe.told_pair(pair))

    def _difference(self, turn: Turn, kind: str, recorded: str, reproduced: str) -> None:
        after = describe.told_input(turn.given)
        self._note(
            Difference(self._t_s(turn.now_ns), turn.now_ns, kind, after, recorded, reproduced)
        )

    def _note(self, difference: Difference) -> None:
        self._result.differences += 1
        if len(self._result.first) < KEPT_DIFFERENCES:
            self._result.first.append(difference)

    def _t_s(self, time_ns: int) -> float:
        return (time_ns - self._start_ns) / 1e9

    def _attached(self, reproduced: Attachments) -> None:
        """Files that belong to the flight; more of them may be attached later by other tools."""
        for name, contents in reproduced.items():
            for data in contents:
                if self._scope.pictures and data not in self._attachments.get(name, ()):
                    there = "another content" if name in self._attachments else "not attached"
                    told = f"{len(data)} bytes"
                    self._note(
                        Difference(
                            0.0, self._start_ns, "attachment", SETUP, f"{name}: {there}", told
                        )
                    )

    def _altered(self, altered: Altered) -> None:
        since_s, until_s = self._t_s(altered.since_ns), self._t_s(altered.until_ns)
        between = f"a message between {since_s:.3f} s and {until_s:.3f} s"
        self._note(
            Difference(
                until_s,
                altered.until_ns,
                "checksum",
                "the recorder's clock",
                f"{between} is not as it was written",
                "its checksum is another one",
            )
        )

    def _ending(self, turns: Turns) -> None:
        notes = self._result.notes
        if turns.missing is not None:
            self._result.whole = False
            notes.append(self._hole(turns.missing))
        elif not turns.closed:
            self._result.ended = False
            lost = ", and in the middle of an input, which is left out" if turns.lost_input else ""
            notes.append(
                f"the record breaks off{lost}: audited as far as its inputs go; whether its "
                "station was killed or its end was cut off, nothing in it tells"
            )

    def _hole(self, hole: Missing) -> str:
        since_s, until_s = self._t_s(hole.since_ns), self._t_s(hole.until_ns)
        what = f"{hole.messages} messages are in no file"
        if hole.messages < 0:
            what = f"{-hole.messages} messages are too many"
        return (
            f"{what} between {since_s:.3f} s and {until_s:.3f} s: what comes after that cannot be "
            "audited"
        )


def _requests(numbers: Sequence[int]) -> str:
    return f"request{'s' if len(numbers) > 1 else ''} {', '.join(map(str, numbers))}"


def scope_of(recorded_in: str, audited_in: str, *, same_version: bool) -> Scope:
    """What two installations can compare; see `gcs.shell.station` for their environments."""
    without = [("without foxglove-sdk" in each) for each in (recorded_in, audited_in)]
    same_sdk = without[0] == without[1]
    return Scope(pictures=same_version and same_sdk, log=same_sdk)
