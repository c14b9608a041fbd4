"""Gives a vehicle a signing key, or takes it away: SETUP_SIGNING, and whether that had its effect.

MAVLink has no answer to SETUP_SIGNING.  So it is sent until the vehicle's frames are signed as they
should be, at most `TRIES` times; then one signed request must be answered, and an unsigned one must
not.  Pure: frames and times in, frames out.
"""

from __future__ import annotations

from enum import Enum, StrEnum
from typing import Final

from gcs.protocol.effects import Address
from gcs.wire import messages as m
from gcs.wire.codec import FrameWriter, decode
from gcs.wire.frame import Frame
from gcs.wire.ids import Cmd, Component, MavAutopilot, MavState, MavType, ModeFlag, MsgId
from gcs.wire.signing import (
    GOOD,
    Bad,
    Checker,
    Reason,
    SecretKey,
    Signer,
    SigningClock,
    timestamp_of,
)

LINK_ID: Final = 199
EVERY_NS: Final = 1_000_000_000
TRIES: Final = 5
ANSWER_TRIES: Final = 12
"""How often a signed request is sent: on a link that loses a third of all frames each way, one in
five thousand such set-ups has no answer then."""
UNSIGNED_TRIES: Final = 3
"""How often an unsigned request is sent before no answer counts: one may be lost."""
SENDER: Final = Address(254, 190)
"""Not a ground station's 255: no autopilot shall miss this one when it goes."""
HEARTBEAT: Final = m.Heartbeat(0, MavType.GENERIC, MavAutopilot.INVALID, 0, MavState.ACTIVE)
"""Of no ground station, for the same reason; for vehicles that send only to who speaks."""


class Ending(StrEnum):
    """How it ended."""

    DONE = "done"
    TAKES_UNSIGNED = "takes unsigned"
    """It has the key, and answers who does not sign as well."""
    NO_VEHICLE = "no vehicle"
    ARMED = "armed"
    OTHER_KEY = "other key"
    """It signs already, with a key that we were not given."""
    NO_EFFECT = "no effect"
    """It goes on as before, as firmware does that has no signing."""
    NO_ANSWER = "no answer"
    """It signs, and does not answer what we sign."""


class _Phase(Enum):
    LISTEN = "listen"
    ASK = "ask"
    SIGNED_REQUEST = "signed request"
    UNSIGNED_REQUEST = "unsigned request"


class SigningSetup:
    """One vehicle, one change of its key.  `ending` is None until it is over."""

    def __init__(
        self,
        new: SecretKey | None,
        old: SecretKey | None,
        target_sysid: int,
        deadline_ns: int,
        own_sysid: int = SENDER.sysid,
    ) -> None:
        """`new` is what it is to have from now on, None for no key; `old` what it has, if it has
        one; `target_sysid` 0 is the first that is heard, until `deadline_ns`; `own_sysid` is whom
        a vehicle hears that hears one number only."""
        self._new, self._old = new, old
        self._clock = SigningClock()
        self._checkers = {key: Checker(key, self._clock) for key in (new, old) if key is not None}
        self._writer = FrameWriter(own_sysid, SENDER.compid)
        self._sysid = target_sysid
        self._listen_until_ns = deadline_ns
        self._phase = _Phase.LISTEN
        self._tries = 0
        self._next_ns = 0
        self.vehicle = ""
        """`1/1` once it is heard."""
        self.had_it = False
        """It had the new key before."""
        self.ending: Ending | None = None

    def handle(self, frame: Frame, now_ns: int) -> list[bytes]:
        """A frame came in; what is to be sent."""
        if self.ending is not None or frame.compid != Component.AUTOPILOT1:
            return []
        signer, seen_before = self._signer_of(frame, now_ns)
        if seen_before:
            return []
        if self._phase is _Phase.ASK and frame.sysid == self._sysid:
            # Any frame shows it: on a bad link heartbeats are lost, or overtaken.
            return self._has_it(now_ns) if self._as_wanted(frame, signer) else []
        message = decode(frame)
        if isinstance(message, m.Heartbeat) and message.type != MavType.GCS:
            if self._sysid in (0, frame.sysid):
                self._sysid = frame.sysid
                self.vehicle = f"{frame.sysid}/{frame.compid}"
                return self._beat(frame, message, signer, now_ns)
        elif isinstance(message, m.CommandAck) and frame.sysid == self._sysid:
            return self._ack(message, now_ns)
        return []

    def wake(self, now_ns: int) -> list[bytes]:
        """Call it a few times a second."""
        if self.ending is not None or now_ns < self._next_ns:
            return []
        self._next_ns = now_ns + EVERY_NS
        match self._phase:
            case _Phase.LISTEN:
                if now_ns >= self._listen_until_ns:
                    self.ending = Ending.NO_VEHICLE
                return [self._writer.write(HEARTBEAT)]
            case _Phase.ASK:
                if self._tries >= TRIES:
                    self.ending = Ending.NO_EFFECT
                    return []
                return [self._setup(now_ns)]
            case _Phase.SIGNED_REQUEST:
                if self._tries >= ANSWER_TRIES:
                    self.ending = Ending.NO_ANSWER
                    return []
                self._tries += 1
                return [self._signed(self._request(), self._new, now_ns)]
            case _Phase.UNSIGNED_REQUEST:
                if self._tries >= UNSIGNED_TRIES:
                    self.ending = Ending.DONE
                    return []
                self._tries += 1
                return [self._unsigned_request()]

    # ----------------------------------------------------------------------------- what comes

    def _signer_of(self, frame: Frame, now_ns: int) -> tuple[SecretKey | None, bool]:
        """Which key signed the frame, of those that we know; and whether it was overtaken by a
        later one, or came before.

        The clock of a vehicle that has just started may be behind: what we send moves it on.
        """
        for key, checker in self._checkers.items():
            verdict = checker.check(frame, now_ns) if frame.signature else Bad(Reason.UNSIGNED)
            if verdict in (GOOD, Bad(Reason.TOO_OLD), Bad(Reason.REPLAYED)):
                return key, verdict == Bad(Reason.REPLAYED)
        return None, False

    def _beat(
        self, frame: Frame, beat: m.Heartbeat, signer: SecretKey | None, now_ns: int
    ) -> list[bytes]:
        match self._phase:
            case _Phase.LISTEN if self._as_wanted(frame, signer):
                self.had_it = True
                return self._has_it(now_ns)
            case _Phase.LISTEN if beat.base_mode & ModeFlag.SAFETY_ARMED:
                self.ending = Ending.ARMED
                return []
            case _Phase.LISTEN if frame.signature and signer is None:
                self.ending = Ending.OTHER_KEY
                return []
            case _Phase.LISTEN:
                self._phase, self._next_ns = _Phase.ASK, now_ns + EVERY_NS
                return [self._setup(now_ns)]
            case _:
                return []

    def _as_wanted(self, frame: Frame, signer: SecretKey | None) -> bool:
        """Whether it is signed with the new key, or not at all where there is to be none."""
        return signer == self._new and bool(frame.signature) == (self._new is not None)

    def _has_it(self, now_ns: int) -> list[bytes]:
        if self._new is None:
            self.ending = Ending.DONE
            return []
        self._phase, self._tries, self._next_ns = _Phase.SIGNED_REQUEST, 1, now_ns + EVERY_NS
        return [self._signed(self._request(), self._new, now_ns)]

    def _ack(self, ack: m.CommandAck, now_ns: int) -> list[bytes]:
        """Each of the two requests is another command: an answer may come late, and twice."""
        if self._phase is _Phase.SIGNED_REQUEST and ack.command == Cmd.REQUEST_MESSAGE:
            self._phase, self._tries = _Phase.UNSIGNED_REQUEST, 1
            self._next_ns = now_ns + EVERY_NS
            return [self._unsigned_request()]
        unsigned = ack.command == Cmd.REQUEST_AUTOPILOT_CAPABILITIES
        if self._phase is _Phase.UNSIGNED_REQUEST and unsigned:
            self.ending = Ending.TAKES_UNSIGNED
        return []

    # ------------------------------------------------------------------------- what is sent

    def _setup(self, now_ns: int) -> bytes:
        self._tries += 1
        # A key of zeros with a timestamp of 0 turns signing off.
        secret = bytes(32) if self._new is None else self._new.secret
        since = 0 if self._new is None else max(timestamp_of(now_ns), self._clock.latest)
        target = self._sysid, Component.AUTOPILOT1
        setup = m.SetupSigning(since, *target, tuple(secret))
        return self._signed(self._writer.write(setup), self._old, now_ns)

    def _request(self) -> bytes:
        """REQUEST_MESSAGE of AUTOPILOT_VERSION: every autopilot answers it, and nothing moves."""
        return self._command(Cmd.REQUEST_MESSAGE, float(MsgId.AUTOPILOT_VERSION))

    def _unsigned_request(self) -> bytes:
        """The same in an older form, which is answered, too, if only as unknown."""
        return self._command(Cmd.REQUEST_AUTOPILOT_CAPABILITIES, 1.0)

    def _command(self, command: Cmd, param1: float) -> bytes:
        target = self._sysid, Component.AUTOPILOT1
        params = (param1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        return self._writer.write(m.CommandLong(*params, command, *target, 0))

    def _signed(self, raw: bytes, key: SecretKey | None, now_ns: int) -> bytes:
        return raw if key is None else Signer(key, LINK_ID, self._clock).sign(raw, now_ns)
