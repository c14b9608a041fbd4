"""The operator's own rule, run in a process of its own: `python -m gcs.shell.rule_child`.

The first line of standard input is `{"path", "source", "policy"}`, each line after it a question;
every line has one answer on standard output, the first one too.  The rule is a file with

    def verify(start, goal, policy):
        ...

`start` and `goal` are `Place`s, `policy` is the station's policy as a dict, with the keys of its
file.  It is asked for one leg after the other.  What it returns permits (None) or refuses (a
sentence).  Whatever else happens refuses.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import signal
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import PurePath
from typing import Any, NamedTuple, TypeAlias

LIMIT_S = 0.3
"""How long `verify` may take for all legs of a way, where the system has timers for a process; the
station itself waits a little longer."""
MOST_LETTERS = 2_000
"""Of a refusal, and of what is printed at one question."""


class Place(NamedTuple):
    """A position in metres east, north and up of the origin of the vehicle's local frame."""

    east_m: float
    north_m: float
    up_m: float


class Answer(NamedTuple):
    """None permits.  `failed`: the rule went wrong, and `refusal` says how."""

    refusal: str | None
    failed: bool = False
    printed: str = ""


Leg: TypeAlias = tuple[Place, Place]
Verify: TypeAlias = Callable[[Place, Place, dict[str, Any]], object]


class BadRuleError(Exception):
    """The file is no rule: `file:line: what is wrong`."""


def legs_of(legs_enu: Iterable[tuple[Iterable[float], Iterable[float]]]) -> list[Leg]:
    """Each with its two ends as places."""
    return [(Place(*start), Place(*goal)) for start, goal in legs_enu]


def load(path: str, source: str) -> Verify:
    """Run the file, and find its `verify`.  Raises BadRuleError."""
    names: dict[str, Any] = {"__name__": "own_rule", "__file__": path}
    try:
        exec(compile(source, path, "exec"), names)
    except SyntaxError as error:
        raise BadRuleError(f"{path}:{error.lineno}: {error.msg}") from error
    except (Exception, SystemExit) as error:
        raise BadRuleError(_where(error, path, path)) from error
    verify = names.get("verify")
    if not callable(verify):
        raise BadRuleError(f"{path}: has no function verify(start, goal, policy)")
    found: Verify = verify
    return found


def judge(verify: Verify, path: str, legs: Sequence[Leg], policy: dict[str, Any]) -> Answer:
    """The rule's answer to one question, the first leg that it does not permit; an exception, or
    anything but a sentence, refuses."""
    printed = io.StringIO()
    failed, refusal = False, None
    try:
        with _limited(), contextlib.redirect_stdout(printed):
            answers = (verify(start, goal, policy) for start, goal in legs)
            number, said = next(
                (one for one in enumerate(answers, 1) if one[1] is not None), (0, None)
            )
        if said is not None:
            failed = not (isinstance(said, str) and said.strip())
            name = PurePath(path).name
            wrong = f"{name}: verify returned {said!r}, neither None nor a sentence"
            which = f"leg {number} of {len(legs)}: " if len(legs) > 1 else ""
            refusal = wrong if failed else f"{which}{said}"
    except BaseException as error:  # noqa: BLE001 - whatever it raises, SystemExit too, refuses
        failed, refusal = True, _where(error, path, PurePath(path).name)
    shortened = None if refusal is None else " ".join(refusal.split())[:MOST_LETTERS]
    return Answer(shortened, failed, printed.getvalue()[:MOST_LETTERS])


class _TooSlowError(BaseException):
    """No `except Exception` of a rule keeps it."""


@contextlib.contextmanager
def _limited() -> Iterator[None]:
    if sys.platform == "win32":
        yield
        return

    told = False

    def late(_signal: int, _frame: object) -> None:
        nonlocal told
        if told:  # a bare `except` in a loop keeps even that
            os.write(sys.stderr.fileno(), b"the rule does not end\n")
            os._exit(1)
        told = True
        raise _TooSlowError(f"took longer than {LIMIT_S:g} s")

    handler = signal.signal(signal.SIGALRM, late)
    timer = signal.setitimer(signal.ITIMER_REAL, LIMIT_S, LIMIT_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, *timer)
        signal.signal(signal.SIGALRM, handler)


def _where(error: BaseException, path: str, name: str) -> str:
    """`my_rule.py:7: ZeroDivisionError: division by zero`, by the last line of the file itself."""
    lines = [at.lineno for at in traceback.extract_tb(error.__traceback__) if at.filename == path]
    place = f"{name}:{lines[-1]}" if lines else name
    kind = "" if isinstance(error, _TooSlowError) else f"{type(error).__name__}: "
    return f"{place}: {kind}{error}"


def main() -> None:
    """Until standard input ends, as it does with the station."""
    answers, sys.stdout = sys.stdout, sys.stderr

    def answer(said: dict[str, Any]) -> None:
        answers.write(json.dumps(said) + "\n")
        answers.flush()

    begin = json.loads(sys.stdin.readline())
    path, policy = begin["path"], begin["policy"]
    try:
        verify = load(path, begin["source"])
    except BadRuleError as error:
        answer({"wrong": str(error)})
        return
    answer({"wrong": ""})
    for line in sys.stdin:
        asked = json.loads(line)
        said = judge(verify, path, legs_of(asked["legs_enu"]), policy)
        answer({"request_id": asked["request_id"], **said._asdict()})


if __name__ == "__main__":
    main()
