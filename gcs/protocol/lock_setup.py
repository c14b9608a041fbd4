"""Sets the parameters of `lock_parameters.py` on a vehicle: read, set where they differ, read back.

Everything is signed with the vehicle's key, which it must have already; or nothing, where it has
none.  Pure.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from gcs.protocol.autopilot import Autopilot, autopilot_of
from gcs.protocol.lock_parameters import PORTS, Locking, Wanted, open_ports, wanted_of
from gcs.protocol.parameter_names import names_of
from gcs.protocol.parameters import BY_NAME, decode_value, encode_value
from gcs.protocol.signing_setup import HEARTBEAT, LINK_ID, SENDER
from gcs.wire import messages as m
from gcs.wire.codec import FrameWriter, decode
from gcs.wire.frame import Frame
from gcs.wire.ids import Component, MavType, ModeFlag, ParamType
from gcs.wire.signing import GOOD, Checker, SecretKey, Signer, SigningClock

EVERY_NS: Final = 700_000_000
TRIES: Final = 12
LOOK_TRIES: Final = 4
"""Of what is only looked at."""

_TYPES: Final = frozenset(int(kind) for kind in ParamType)


class Ending(StrEnum):
    """How it ended."""

    DONE = "done"
    NO_VEHICLE = "no vehicle"
    ARMED = "armed"
    INCOMPLETE = "incomplete"
    """A parameter is not there, or does not take its value."""


@dataclass(frozen=True, slots=True)
class Change:
    """One parameter; `before` and `after` are the same where it was right already."""

    name: str
    before: float
    after: float


class LockSetup:
    """One vehicle's parameters.  `ending` is None until it is over; `changes` are in order."""

    def __init__(
        self, key: SecretKey | None, lock: Locking, target_sysid: int, deadline_ns: int
    ) -> None:
        """`target_sysid` 0 is the first vehicle that is heard.  It speaks in the bridge's own
        number: a vehicle that is locked already may hear no other one."""
        clock = SigningClock()
        self._signer = None if key is None else Signer(key, LINK_ID, clock)
        self._checker = None if key is None else Checker(key, clock)
        self._writer = FrameWriter(lock.own_sysid, SENDER.compid)
        self._lock, self._sysid = lock, target_sysid
        self._deadline_ns = deadline_ns
        self._autopilot: Autopilot | None = None
        self._open: list[Wanted] = []
        self._looks: list[list[str]] = []
        """What is only looked at, when all is set: rows of `PORTS`."""
        self._values: dict[str, float] = {}
        self._set: m.ParamSet | None = None
        """What is asked to be set, until it is read back; None: it is read."""
        self._before = 0.0
        self._tries = 0
        self._next_ns = 0
        self.vehicle = ""
        """`1/1` once it is heard."""
        self.others: set[int] = set()
        """System ids of other vehicles that were heard meanwhile, and are as they were."""
        self.changes: list[Change] = []
        self.open_ports: list[str] = []
        """Where it takes unsigned frames all the same, a sentence each; without a key nothing."""
        self.missing = ""
        """The parameter at which it ended INCOMPLETE."""
        self.ending: Ending | None = None

    def handle(self, frame: Frame, now_ns: int) -> list[bytes]:
        """A frame came in; what is to be sent."""
        if self.ending is not None or frame.compid != Component.AUTOPILOT1:
            return []
        if self._sysid not in (0, frame.sysid):
            self.others.add(frame.sysid)
            return []
        if self._checker is not None and self._checker.check(frame, now_ns) != GOOD:
            return []
        message = decode(frame)
        if isinstance(message, m.Heartbeat) and self._autopilot is None:
            return self._met(frame.sysid, message, now_ns)
        if isinstance(message, m.ParamValue) and message.param_type in _TYPES:
            return self._value(message, now_ns)
        if isinstance(message, m.ParamError) and message.param_id == self._looked_at:
            self._looks.pop(0)
            self._tries = 0
            return self._ask(now_ns)
        return []

    @property
    def _looked_at(self) -> str:
        """Empty before all is set, and after all is looked at."""
        return self._looks[0][0] if self._looks and not self._open else ""

    def wake(self, now_ns: int) -> list[bytes]:
        """Call it a few times a second."""
        if self.ending is not None or now_ns < self._next_ns:
            return []
        if self._autopilot is None:
            if now_ns >= self._deadline_ns:
                self.ending = Ending.NO_VEHICLE
            self._next_ns = now_ns + EVERY_NS
            return [self._signed(HEARTBEAT, now_ns)]
        return self._ask(now_ns)

    def _met(self, sysid: int, beat: m.Heartbeat, now_ns: int) -> list[bytes]:
        if beat.type == MavType.GCS:
            return []
        self.vehicle = f"{sysid}/{Component.AUTOPILOT1.value}"
        if beat.base_mode & ModeFlag.SAFETY_ARMED:
            self.ending = Ending.ARMED
            return []
        self._sysid = sysid
        self._autopilot = autopilot_of(beat.autopilot, beat.type)
        self._open = list(wanted_of(self._autopilot.name, self._lock))
        if self._signer is not None:
            self._looks = [list(row) for row in PORTS.get(self._autopilot.name, ())]
        return self._ask(now_ns)

    def _ask(self, now_ns: int) -> list[bytes]:
        """Read the next parameter, or set it once more."""
        if not self._open:
            return self._look(now_ns)
        name = self._open[0].name
        if self._tries >= TRIES:
            self.ending, self.missing = Ending.INCOMPLETE, name
            return []
        self._tries += 1
        self._next_ns = now_ns + EVERY_NS
        if self._set is not None:
            return [self._signed(self._set, now_ns)]
        target = self._sysid, Component.AUTOPILOT1
        return [
            self._signed(m.ParamRequestRead(BY_NAME, *target, each.name), now_ns)
            for each in names_of(name)
        ]

    def _look(self, now_ns: int) -> list[bytes]:
        """Read the next one that is only looked at; where a row ends here, that of the next row."""
        if self._looks and self._tries >= LOOK_TRIES:
            self._looks.pop(0)
            self._tries = 0
        if not self._looks:
            if self._signer is not None and self._autopilot is not None:
                self.open_ports = open_ports(self._autopilot.name, self._values)
            self.ending = Ending.DONE
            return []
        self._tries += 1
        self._next_ns = now_ns + EVERY_NS
        target = self._sysid, Component.AUTOPILOT1
        return [self._signed(m.ParamRequestRead(BY_NAME, *target, self._looked_at), now_ns)]

    def _value(self, told: m.ParamValue, now_ns: int) -> list[bytes]:
        if self._autopilot is not None and told.param_id == self._looked_at:
            kind = ParamType(told.param_type)
            value = decode_value(told.param_value, kind, self._autopilot.param_encoding)
            self._values[told.param_id] = float(value)
            self._looks[0].pop(0)
            self._looks = [row for row in self._looks if row]
            self._tries = 0
            return self._ask(now_ns)
        if not self._open or self._autopilot is None:
            return []
        wanted = self._open[0]
        if told.param_id not in {each.name for each in names_of(wanted.name)}:
            return []
        kind = ParamType(told.param_type)
        encoding = self._autopilot.param_encoding
        value = float(decode_value(told.param_value, kind, encoding))
        if self._set is None:
            self._before = value
        becomes = wanted.becomes(value)
        if value == becomes:
            self.changes.append(Change(told.param_id, self._before, value))
            self._open.pop(0)
            self._set, self._tries = None, 0
            return self._ask(now_ns)
        if self._set is None:
            wire = encode_value(becomes, kind, encoding)
            target = self._sysid, Component.AUTOPILOT1
            self._set, self._tries = m.ParamSet(wire, *target, told.param_id, kind), 0
            return self._ask(now_ns)
        return []

    def _signed(self, message: m.Message, now_ns: int) -> bytes:
        raw = self._writer.write(message)
        return raw if self._signer is None else self._signer.sign(raw, now_ns)
