"""Verdicts by number: what was checked, for whom it holds, and how long.

An agent acts with the number of a verdict alone.  So what is asked of the station is what was
checked, down to the last digit, and only while the vehicle is as it was then.  The gate verifies
the request again: a verdict promises nothing, it narrows what can be asked.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from gcs import ipc
from gcs.frames import Vec3

VALID_NS: Final = 10_000_000_000
ASKED_VALID_NS: Final = 60_000_000_000
"""Of a request that a person is asked about: people take longer to answer."""
MOVED_M: Final = 1.0
"""How far the vehicle may have moved since."""
KEPT: Final = 100
"""Verdicts that are remembered, so that a used or expired one is called so."""


@dataclass(frozen=True, slots=True)
class Situation:
    """What a verdict depends on, as the station tells it."""

    policy: str
    """The digest of the policy's file, with the fence that stands."""
    vehicle: str
    state: str
    mode: str
    armed: bool | None
    pos_enu: Vec3 | None

    @classmethod
    def of(cls, policy: str, seen: ipc.Snapshot) -> Situation:
        return cls(policy, seen.vehicle, seen.state, seen.mode, seen.armed, seen.pos_enu)


@dataclass(frozen=True, slots=True)
class Denied:
    """Why an agent's call is refused before the station is asked."""

    code: str
    sentence: str


USED: Final = Denied("USED_VERDICT", "that verdict was used: each is for one act")


@dataclass(frozen=True, slots=True)
class Verdict:
    """One accepted check: `ask` is the request that it is for, whole."""

    number: str
    ask: ipc.Ask
    label: str
    situation: Situation
    made_ns: int
    valid_ns: int
    plan_digest: str = ""
    """Of the bytes of a mission's file; empty for other requests."""


class Verdicts:
    """The verdicts of one session of one agent."""

    def __init__(self, session: str) -> None:
        """`session`: letters that no other session has, so that a number of theirs is unknown."""
        self._session = session
        self._count = 0
        self._all: dict[str, Verdict] = {}
        self._unused: set[str] = set()

    def keep(
        self,
        ask: ipc.Ask,
        label: str,
        situation: Situation,
        now_ns: int,
        *,
        valid_ns: int = VALID_NS,
        plan_digest: str = "",
    ) -> Verdict:
        """The check was answered with accepted."""
        self._count += 1
        number = f"v{self._count}-{self._session}"
        made = Verdict(number, ask, label, situation, now_ns, valid_ns, plan_digest=plan_digest)
        self._all[number] = made
        self._unused.add(number)
        while len(self._all) > KEPT:
            oldest = next(iter(self._all))
            del self._all[oldest]
            self._unused.discard(oldest)
        return made

    def look(self, number: str, word: str, now: Situation, now_ns: int) -> Verdict | Denied:
        """The verdict of that number, if `word` may be asked for with it now."""
        found = self._all.get(number)
        if found is None:
            return Denied("UNKNOWN_VERDICT", "no verdict of this session has that number")
        if found.ask.word != word:
            return Denied("WRONG_VERDICT", f"that verdict is for {found.label}, not for {word}")
        if number not in self._unused:
            return USED
        age_ns = now_ns - found.made_ns
        if not 0 <= age_ns <= found.valid_ns:
            text = f"that verdict is {age_ns / 1e9:.1f} s old; it held {found.valid_ns / 1e9:g} s"
            return Denied("EXPIRED_VERDICT", text)
        changed = _changed(found.situation, now)
        return Denied("CHANGED_SITUATION", f"{changed}: check again") if changed else found

    def take(self, number: str, word: str, now: Situation, now_ns: int) -> Verdict | Denied:
        """The same, and it is used from now on, whatever becomes of the act."""
        found = self.look(number, word, now, now_ns)
        if isinstance(found, Verdict):
            try:
                self._unused.remove(number)
            except KeyError:  # another thread was faster
                return USED
        return found


def _changed(then: Situation, now: Situation) -> str:
    """What is otherwise than when it was checked; empty: nothing."""
    if then.policy != now.policy:
        return "the policy or the fence has changed"
    for name in ("vehicle", "state", "mode", "armed"):
        before, after = getattr(then, name), getattr(now, name)
        if before != after:
            return f"the vehicle's {name} was {before} and is {after}"
    if then.pos_enu is None or now.pos_enu is None:
        return "" if then.pos_enu == now.pos_enu else "the position is known or unknown since"
    moved_m = math.dist(then.pos_enu, now.pos_enu)
    return f"the vehicle has moved {moved_m:.1f} m" if moved_m > MOVED_M else ""
