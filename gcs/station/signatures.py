"""The signatures of a session's links: what is not rightly signed goes no further than here.

Links of the vehicle's side have one key, links of clients another, either or both may have none.
What leaves on a link with a key is signed, in our own link ids; what comes in unsigned, signed with
another key, or a second time is counted, told and refused, before anything else looks at it.

To whom a frame comes later than the next one of its link id, it is a replay.  Setpoints follow one
another every 50 ms, so they have a link id of their own: on a link that reorders they would make a
replay of the command that left beside them, and of its repetitions.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from gcs.gate.effects import Level
from gcs.session.work import Log
from gcs.wire.frame import Frame, msgid_in
from gcs.wire.ids import MsgId
from gcs.wire.signing import Bad, Checker, Key, Reason, Signer, SigningClock

NODE: Final = "signing"
LINK_ID_BASE: Final = 200
"""Link ids of ours count from here: autopilots and other stations use small ones."""
SETPOINTS_LINK_ID_BASE: Final = 100
"""So do those of the setpoints, to a vehicle."""
SETPOINTS: Final = frozenset(
    {
        MsgId.SET_POSITION_TARGET_LOCAL_NED,
        MsgId.SET_POSITION_TARGET_GLOBAL_INT,
        MsgId.SET_ATTITUDE_TARGET,
        MsgId.MANUAL_CONTROL,
        MsgId.RC_CHANNELS_OVERRIDE,
    }
)
TELL_EVERY_NS: Final = 10_000_000_000
SOURCES_TOLD: Final = 4
"""Senders that one line names; there may be many, with forged names."""
SOURCES_KEPT: Final = 64

_WHAT: Final = {
    Reason.UNSIGNED: "unsigned",
    Reason.WRONG_KEY: "signed with another key",
    Reason.REPLAYED: "sent a second time",
    Reason.TOO_OLD: "signed before this station began, or more than a minute ago",
    Reason.TOO_MANY: "of too many senders",
    Reason.AHEAD: "signed more than a day ahead of this station",
}
_HINTS: Final = {
    Reason.UNSIGNED: "has it the key? `gcs key install FILE --link URL` gives it one; "
    "without --sign-key the station takes unsigned frames",
    Reason.WRONG_KEY: "is the key right? `gcs key show FILE` prints its fingerprint",
    Reason.TOO_OLD: "is the clock of this computer right? it may be ahead of the vehicle's",
    Reason.AHEAD: "is the clock of this computer right? it may be behind the vehicle's",
}


@dataclass(frozen=True, slots=True)
class Keys:
    """What links are signed with; None: these are not."""

    vehicle: Key | None = None
    client: Key | None = None


NO_KEYS: Final = Keys()


@dataclass(slots=True)
class _Refused:
    """What came in wrong on one link, for one reason."""

    count: int = 0
    told: int = 0
    senders: Counter[str] = field(default_factory=Counter)
    """Since it was last told: `255/190 COMMAND_LONG`."""


class Signatures:
    """All links of a session.  `unsigned_taken`: what comes unsigned is counted and told only."""

    def __init__(
        self,
        keys: Keys,
        sysid: int,
        compid: int,
        vehicle_links: int,
        *,
        unsigned_taken: bool = False,
        since_ns: int = 0,
    ) -> None:
        """`since_ns` is when the session began."""
        self._vehicle_links = vehicle_links
        self._own = (sysid, compid)
        self._vehicle = _Side(keys.vehicle, since_ns) if keys.vehicle else None
        self._client = _Side(keys.client, since_ns) if keys.client else None
        self._unsigned_taken = unsigned_taken
        self._refused: dict[tuple[int, Reason], _Refused] = {}
        self._told_ns: dict[tuple[int, Reason], int] = {}
        """When it was told last, also of a client that has gone: who comes anew again and again on
        one link does not fill the log."""
        self._signs_to_us: set[tuple[int, int, int]] = set()
        self._news: list[Log] = []

    def _side(self, link: int) -> _Side | None:
        return self._vehicle if link < self._vehicle_links else self._client

    def signed(self, link: int) -> bool:
        """Whether the link has a key."""
        side = self._vehicle if link < self._vehicle_links else self._client
        return side is not None

    def outgoing(self, link: int, raw: bytes, now_ns: int) -> bytes:
        """The frame as it is to leave: signed with the link's key, or as it is where it has none.

        Raises UnsignableError for a MAVLink 1 frame of a message that the dialect lacks.
        """
        side = self._side(link)
        if side is None:
            return raw
        setpoint = side is self._vehicle and msgid_in(raw) in SETPOINTS
        signed = side.signer(link, self._own, setpoint=setpoint).sign(raw, now_ns)
        if side is self._client:
            # A peer without the key that sends us back what it was sent is not to be verified.
            side.checker.sent(signed)
        return signed

    def refused(
        self, link: int, frame: Frame, now_ns: int, *, verifying: bool = False
    ) -> Reason | None:
        """Why a frame that came in is not to be taken; None where it is.

        `verifying`: its sender is not verified yet, so no frame is taken without a signature, not
        even a radio's.
        """
        side = self._side(link)
        if side is None:
            if frame.signature:
                self._signed_without_key(link, frame)
            return None
        verdict = side.checker.check(frame, now_ns)
        if isinstance(verdict, Bad):
            reason = verdict.reason
        elif verifying and not frame.signature:
            reason = Reason.UNSIGNED
        else:
            return None
        self._count(link, frame, reason)
        taken = reason is Reason.UNSIGNED and self._unsigned_taken
        return None if taken else reason

    def counts(self, link: int) -> Mapping[Reason, int]:
        """What came in wrong on a link so far."""
        return {reason: r.count for (of, reason), r in self._refused.items() if of == link}

    def forget(self, link: int) -> None:
        """A client's link has gone: another one may get its number."""
        self._refused = {key: kept for key, kept in self._refused.items() if key[0] != link}

    def told(self, link: int, *, verified: bool = True) -> str:
        """In a few words, for a page: empty where the link has no key, or nothing came."""
        if not self.signed(link):
            return ""
        counts = self.counts(link)
        words = ", ".join(f"{count} {reason}" for reason, count in counts.items())
        return words or ("signed" if verified else "")

    def second(self, now_ns: int) -> list[Log]:
        """Once a second: what came in wrong since it was last told, at most every 10 s."""
        lines, self._news = self._news, []
        for (link, reason), refused in self._refused.items():
            told_ns = self._told_ns.get((link, reason))
            due = told_ns is None or now_ns - told_ns >= TELL_EVERY_NS
            if refused.count == refused.told or not due:
                continue
            names = [name for name, _ in refused.senders.most_common(SOURCES_TOLD)]
            more = ", ..." if len(refused.senders) > SOURCES_TOLD else ""
            new, plural = refused.count - refused.told, "s" if refused.count > 1 else ""
            since = f" ({new} new)" if refused.told else ""
            taken = reason is Reason.UNSIGNED and self._unsigned_taken
            done = "taken all the same" if taken else "refused"
            text = f"link {link}: {refused.count} frame{plural}{since} {_WHAT[reason]}, {done}: "
            lines.append(Log(Level.WARNING, NODE, text + ", ".join(names) + more))
            refused.told = refused.count
            self._told_ns[link, reason] = now_ns
            refused.senders.clear()
        return lines

    def why_no_vehicle(self) -> tuple[str, str]:
        """What a vehicle that is not heard does instead, and a hint; empty where nothing came.

        One whose clock is behind is brought on by what we send, and will be heard.
        """
        counts: Counter[Reason] = Counter()
        for (link, reason), refused in self._refused.items():
            if link < self._vehicle_links and reason in (Reason.UNSIGNED, Reason.WRONG_KEY):
                counts[reason] += refused.count
        for reason, count in counts.most_common(1):
            return f"{count} frames came, but {_WHAT[reason]}", _HINTS.get(reason, "")
        return "", ""

    def _count(self, link: int, frame: Frame, reason: Reason) -> None:
        refused = self._refused.setdefault((link, reason), _Refused())
        refused.count += 1
        sender = f"{frame.sysid}/{frame.compid} {frame.name}"
        if sender in refused.senders or len(refused.senders) < SOURCES_KEPT:
            refused.senders[sender] += 1

    def _signed_without_key(self, link: int, frame: Frame) -> None:
        """Said once: whoever signs may take nothing that is not signed."""
        sender = (link, frame.sysid, frame.compid)
        if frame.msgid != MsgId.HEARTBEAT or sender in self._signs_to_us:
            return
        if len(self._signs_to_us) >= SOURCES_KEPT:
            return
        self._signs_to_us.add(sender)
        option = "--sign-key" if link < self._vehicle_links else "--client-key"
        text = f"link {link}: {frame.sysid}/{frame.compid} signs its frames, and may take only "
        self._news.append(
            Log(Level.WARNING, NODE, f"{text}signed ones: give the key with {option}")
        )


class _Side:
    """The links that share a key."""

    def __init__(self, key: Key, since_ns: int) -> None:
        self._key = key
        self._clock = SigningClock()
        self._signers: dict[tuple[int, bool], Signer] = {}
        self.checker = Checker(key, self._clock, since_ns)

    def signer(self, link: int, own: tuple[int, int], *, setpoint: bool) -> Signer:
        signer = self._signers.get((link, setpoint))
        if signer is None:
            link_id = ((SETPOINTS_LINK_ID_BASE if setpoint else LINK_ID_BASE) + link) % 256
            signer = self._signers[link, setpoint] = Signer(self._key, link_id, self._clock)
            self.checker.never(*own, link_id)
        return signer
