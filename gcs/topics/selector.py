"""Which topics, and which field of their messages, somebody means.

ATTITUDE                      every component's ATTITUDE
ATTITUDE.roll                 one field of it
/mavlink/1/1/ATTITUDE.roll    of this component only; /mavlink/1/1/ATTITUDE/roll is the same
1/1/ATTITUDE                  the end of a topic's name
/vehicle/*/state.up_m         * and ? stand for any characters
GPS_STATUS.satellite_snr[3]   an element of an array
"""

from __future__ import annotations

import difflib
import re
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TypeAlias

from gcs.topics.topic import Fields, Value

Path: TypeAlias = "tuple[str | int, ...]"
"""Names of fields, and numbers of elements."""

MAX_TEXT = 300
_STEP = re.compile(r"\.?([A-Za-z_][A-Za-z0-9_]*)|\[(-?\d{1,9})\]")


class SelectorError(ValueError):
    """The text names no topic or field; `hint` says what would."""

    def __init__(self, text: str, why: str, hint: str = "") -> None:
        super().__init__(f"{text}: {why}")
        self.hint = hint


@dataclass(frozen=True, slots=True)
class Selector:
    """What was typed, taken apart."""

    text: str
    topic: str
    """A topic's whole name if it begins with a slash, else the end of one; with * and ?."""
    path: Path

    @classmethod
    def parse(cls, text: str) -> Selector:
        """Raises SelectorError."""
        if len(text) > MAX_TEXT:
            raise SelectorError(text[:20] + "...", f"is longer than {MAX_TEXT} characters")
        slash = text.rfind("/")
        ends = [at for at in (text.find(".", slash + 1), text.find("[", slash + 1)) if at >= 0]
        end = min(ends, default=len(text))
        topic = text[:end]
        if not topic.strip("/") or topic.endswith("/"):
            raise SelectorError(text, "names no topic", "such as ATTITUDE.roll")
        return cls(text, topic, parse_path(text[end:], text))

    def path_in(self, name: str) -> Path | None:
        """The path in the messages of the topic called `name`; None if it is not meant."""
        if _matches(name, self.topic):
            return self.path
        # rostopic's way to name a field: behind a slash.
        head, _, field = self.topic.rpartition("/")
        if head.strip("/") and not self.path and field.isidentifier() and _matches(name, head):
            return (field,)
        return None


def parse_path(text: str, whole: str) -> Path:
    """`.a.b[3]` as names and numbers.  Raises SelectorError."""
    path: list[str | int] = []
    at = 0
    while at < len(text):
        step = _STEP.match(text, at)
        if step is None:
            raise SelectorError(
                whole, f"{text[at:]!r} is no path of fields", "such as .roll or [3]"
            )
        name, index = step.groups()
        path.append(name if name is not None else int(index))
        at = step.end()
    return tuple(path)


def path_text(path: Path) -> str:
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path)


def value_at(fields: Fields, path: Path, message: str) -> Value:
    """The value there; None where an element or an optional part is not there.

    Raises SelectorError for a field that a message has not.
    """
    value: Value = fields
    for step in path:
        if isinstance(step, int):
            if not isinstance(value, list | str):
                raise SelectorError(message, f"what is before [{step}] is no array")
            if not -len(value) <= step < len(value):
                return None
            value = value[step]
        elif isinstance(value, dict):
            if step not in value:
                raise no_such_field(message, step, list(value))
            value = value[step]
        elif value is None:
            return None
        else:
            raise SelectorError(message, f"what is before .{step} has no fields")
    return value


def no_such_field(message: str, name: str, known: list[str]) -> SelectorError:
    near = difflib.get_close_matches(name, known, n=1)
    hint = f"did you mean {near[0]!r}?" if near else f"it has: {', '.join(known)}"
    return SelectorError(message, f"has no field {name!r}", hint)


def _matches(name: str, pattern: str) -> bool:
    if pattern.startswith("/"):
        return fnmatchcase(name, pattern)
    folded = name.lower()
    pattern = pattern.lower()
    tail = folded.split("/")[-(pattern.count("/") + 1) :]
    return fnmatchcase("/".join(tail), pattern)
