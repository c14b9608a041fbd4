"""Jobs about the vehicle's parameters: all of them, one, and a new value for one.

List  (verdict) -> by FTP, where the vehicle has the file, else by messages -> done
Get   (verdict) -> READING -> done; a name that it does not have: LISTING, for those that are near
Set   READING -> (verdict) -> SETTING -> READ BACK -> done
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping, Sequence
from typing import Final

from gcs import ipc
from gcs.bridge.setup_policy.operator_rules import why_not_read_file, why_not_write
from gcs.bridge.setup_policy.safety_parameters import NAME
from gcs.float32 import float32, value_text
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.parameters import BY_NAME, Parameter, encode_value, why_not
from gcs.protocol.transfers.ftp import FileData, FileEnd, FileFailed, FileRead
from gcs.protocol.transfers.parameter_list import (
    ANSWER_NS,
    QUIET_NS,
    ListDone,
    ListFailed,
    ListProgress,
    ParameterList,
    parameter_of,
)
from gcs.protocol.transfers.parameter_pack import PATH, PackError, unpack
from gcs.report import ParamItem
from gcs.session.effects import Record
from gcs.session.work import Work
from gcs.vehicle.readers.job import AN_EVENT, Asked, Job
from gcs.wire.ids import ParamType
from gcs.wire.messages import ParamError, ParamRequestRead, ParamSet, ParamValue

ASK_AGAIN_NS: Final = 400_000_000
TRIES: Final = 6
"""How often a parameter is asked for, or written."""
UNKNOWN_TRIES: Final = 3
"""How often one is asked for that may not be there: a PX4 says nothing then."""
Then = Callable[[tuple[Parameter, ...] | str, int], list[Work]]
"""What to do with all parameters, or with why they could not be read."""


class Listing:
    """Reads all parameters, the fastest way that the vehicle has, for a job."""

    def __init__(self, job: Job) -> None:
        self._job = job
        self._data = bytearray()
        self._file: FileRead | None = None
        self._list: ParameterList | None = None

    @property
    def deadline_ns(self) -> int | None:
        machine = self._list or self._file
        return None if machine is None else machine.deadline_ns

    def start(self, now_ns: int, then: Then) -> list[Work]:
        self._then = then
        asked = self._job.asked
        if why_not_read_file(asked.policy.bridge, stands=asked.stands) is not None:
            return self._by_messages(now_ns)
        self._file = asked.file(PATH)
        return self._follow_file(self._file.start(now_ns), now_ns)

    def handle(self, event: Heard | Wake, now_ns: int) -> list[Work]:
        if self._list is not None:
            return self._follow_list(self._list.handle(event, now_ns), now_ns)
        if self._file is not None:
            return self._follow_file(self._file.handle(event, now_ns), now_ns)
        return []

    def stop(self) -> list[Work]:
        return [] if self._file is None else [w for w in self._file.stop() if isinstance(w, Send)]

    def _follow_file(self, effects: Sequence[object], now_ns: int) -> list[Work]:
        work: list[Work] = []
        for effect in effects:
            match effect:
                case Send():
                    work.append(effect)
                case FileData(data=data):
                    self._data += data
                case FileEnd():
                    self._file = None
                    try:
                        found = unpack(bytes(self._data))
                    except PackError:  # a firmware that packs otherwise
                        return work + self._by_messages(now_ns)
                    return work + self._then(found, now_ns)
                case FileFailed():
                    self._file = None
                    return work + self._by_messages(now_ns)
        return work

    def _by_messages(self, now_ns: int) -> list[Work]:
        asked, real_ns = self._job.asked, self._job.asked.times.real_ns
        encoding = asked.telemetry.autopilot.param_encoding
        self._list = ParameterList(asked.target, encoding, real_ns(QUIET_NS), real_ns(ANSWER_NS))
        return self._follow_list(self._list.start(now_ns), now_ns)

    def _follow_list(self, effects: Sequence[object], now_ns: int) -> list[Work]:
        work: list[Work] = []
        for effect in effects:
            match effect:
                case Send():
                    work.append(effect)
                case ListProgress(done, total):
                    work.append(self._job.progress(done, total, "parameters"))
                case ListDone(parameters):
                    self._list = None
                    work += self._then(parameters, now_ns)
                case ListFailed(text):
                    self._list = None
                    work += self._then(text, now_ns)
        return work


class ListParameters(Job):
    """All of them, at most 50 an event."""

    def __init__(self, asked: Asked) -> None:
        super().__init__(asked)
        self._listing = Listing(self)

    @property
    def deadline_ns(self) -> int | None:
        return self._listing.deadline_ns

    def start(self, now_ns: int) -> list[Work]:
        return [self.accept(), *self._listing.start(now_ns, self._listed)]

    def handle(self, event: Heard | Wake, now_ns: int) -> list[Work]:
        return self._listing.handle(event, now_ns)

    def stopped(self) -> list[Work]:
        return self._listing.stop()

    def _listed(self, found: tuple[Parameter, ...] | str, now_ns: int) -> list[Work]:
        if isinstance(found, str):
            return self.abort(Code.NO_ANSWER, found)
        parts = [found[at : at + AN_EVENT] for at in range(0, len(found), AN_EVENT)]
        told = [self.tell(told_of(self.asked, *part)) for part in parts]
        return [*told, *self.complete(f"{len(found)} parameters")]


class OneParameter(Job):
    """About one that is read by its name first; where the vehicle does not have it, all are read,
    to say which names are near."""

    def __init__(self, asked: Asked, known: Mapping[str, Parameter]) -> None:
        super().__init__(asked)
        self.name = asked.ask.name
        self.known = known.get(self.name)
        self._listing: Listing | None = None
        self._deadline_ns: int | None = None
        self._tries = 0

    @property
    def deadline_ns(self) -> int | None:
        return self._deadline_ns if self._listing is None else self._listing.deadline_ns

    def handle(self, event: Heard | Wake, now_ns: int) -> list[Work]:
        if self._listing is not None:
            return self._listing.handle(event, now_ns)
        if isinstance(event, Wake):
            due = self._deadline_ns is not None and now_ns >= self._deadline_ns
            return self.silent(now_ns) if due else []
        asked = self.asked
        if not asked.target.includes(event.sysid, event.compid):
            return []
        match event.message:
            case ParamValue(param_id=name) as message if name == self.name:
                encoding = asked.telemetry.autopilot.param_encoding
                parameter = parameter_of(message, encoding)
                return [] if parameter is None else self.read(parameter, now_ns)
            case ParamError(param_id=name, target_system=system, target_component=component):
                ours = Address(system, component).includes(asked.own.sysid, asked.own.compid)
                return self.denied(now_ns) if ours and name == self.name else []
        return []

    def stopped(self) -> list[Work]:
        return [] if self._listing is None else self._listing.stop()

    def read(self, parameter: Parameter, now_ns: int) -> list[Work]:
        """The vehicle tells what it holds."""
        raise NotImplementedError

    def denied(self, now_ns: int) -> list[Work]:
        """It says that it does not have it, or does not take a value."""
        return self.find_near(now_ns)

    def silent(self, now_ns: int) -> list[Work]:
        """It has not answered."""
        if self._tries >= UNKNOWN_TRIES:
            return self.find_near(now_ns)
        return self.ask(now_ns)

    def ask(self, now_ns: int) -> list[Work]:
        """For the value that it holds."""
        self.wait(now_ns)
        sysid, compid = self.asked.target.sysid, self.asked.target.compid
        return [Send(ParamRequestRead(BY_NAME, sysid, compid, self.name))]

    def wait(self, now_ns: int) -> None:
        self._tries += 1
        self._deadline_ns = now_ns + self.asked.times.real_ns(ASK_AGAIN_NS)

    @property
    def tries(self) -> int:
        return self._tries

    def begin_anew(self) -> None:
        """Another step, with tries of its own."""
        self._tries = 0

    def find_near(self, now_ns: int) -> list[Work]:
        self._listing = Listing(self)
        return self._listing.start(now_ns, self._listed)

    def _listed(self, found: tuple[Parameter, ...] | str, now_ns: int) -> list[Work]:
        self._listing = None
        if isinstance(found, str):
            return self.missing(Refusal(Code.NO_ANSWER, f"{self.name} is not told: {found}"))
        known = {each.name: each for each in found}
        if self.name in known:
            self.begin_anew()
            return self.read(known[self.name], now_ns)
        near = difflib.get_close_matches(self.name, [*known], n=3, cutoff=0.6)
        hint = f"; near: {', '.join(near)}" if near else ""
        sentence = f"the vehicle has no parameter {self.name}{hint}"
        return self.missing(Refusal(Code.BAD_PARAMETER, sentence))

    def missing(self, refusal: Refusal) -> list[Work]:
        """It is not there, or is not told."""
        return self.refuse(refusal)


class GetParameter(OneParameter):
    """What one is."""

    def start(self, now_ns: int) -> list[Work]:
        if not NAME.fullmatch(self.name):
            return self.refuse(Refusal(Code.BAD_PARAMETER, not_a_name(self.name)))
        return self.ask(now_ns)

    def read(self, parameter: Parameter, now_ns: int) -> list[Work]:
        told = self.tell(told_of(self.asked, parameter))
        text = f"{parameter.name} = {parameter.text} ({parameter.type.name.lower()})"
        return [self.accept(), told, *self.complete(text)]


class SetParameter(OneParameter):
    """A new value for one: judged by the policy, sent, and read back."""

    def __init__(self, asked: Asked, known: Mapping[str, Parameter]) -> None:
        super().__init__(asked, known)
        self._old: Parameter | None = None
        self._sent = False
        """What it holds is asked for, after the value was written."""
        self._value = 0.0
        """As the vehicle can hold it."""

    def start(self, now_ns: int) -> list[Work]:
        ask = self.asked.ask
        if not NAME.fullmatch(self.name):
            return self.refuse(Refusal(Code.BAD_PARAMETER, not_a_name(self.name)))
        if ask.value is None:
            return self.refuse(Refusal(Code.NON_FINITE, f"{self.name}: no finite number"))
        refusal = self._refusal()
        if refusal is not None:
            return self.refuse(refusal)
        return self.read(self.known, now_ns) if self.known else self.ask(now_ns)

    def _refusal(self) -> Refusal | None:
        asked = self.asked
        autopilot = asked.telemetry.autopilot.name
        return why_not_write(asked.policy.bridge, autopilot, self.name, stands=asked.stands)

    def read(self, parameter: Parameter, now_ns: int) -> list[Work]:
        if self._sent:
            return self._read_back(parameter, now_ns)
        if self.accepted:
            # The echo of the write, or what was on its way before: what it holds is asked for.
            return self._read(now_ns)
        self._old = parameter
        asked, kind = self.asked, parameter.type
        assert asked.ask.value is not None
        encoding = asked.telemetry.autopilot.param_encoding
        if why := why_not(self.name, asked.ask.value, kind, encoding):
            return self.refuse(Refusal(Code.BAD_PARAMETER, why))
        if refusal := self._refusal():  # it may have been armed meanwhile
            return self.refuse(refusal)
        real = kind is ParamType.REAL32
        self._value = float32(asked.ask.value) if real else int(asked.ask.value)
        self.begin_anew()
        return [self.accept(), *self._write(now_ns)]

    def _write(self, now_ns: int) -> list[Work]:
        assert self._old is not None
        if refusal := self._refusal():  # a write that was lost is not made up for in the air
            return self.abort(refusal.code, refusal.sentence)
        self.wait(now_ns)
        self._sent = False
        sysid, compid = self.asked.target.sysid, self.asked.target.compid
        encoding = self.asked.telemetry.autopilot.param_encoding
        wire = encode_value(self._value, self._old.type, encoding)
        return [Send(ParamSet(wire, sysid, compid, self.name, self._old.type))]

    def _read(self, now_ns: int) -> list[Work]:
        self._sent = True
        return self.ask(now_ns)

    def silent(self, now_ns: int) -> list[Work]:
        if not self.accepted:
            return super().silent(now_ns)
        if self.tries >= TRIES:
            return self.abort(Code.NO_ANSWER, f"{self.name} was written and does not come back")
        return self._write(now_ns) if self.tries % 2 == 0 else self._read(now_ns)

    def denied(self, now_ns: int) -> list[Work]:
        if not self.accepted:
            return super().denied(now_ns)
        text = f"the vehicle does not take {self.name} = {value_text(self._value)}"
        return self.abort(Code.VEHICLE_REFUSED, f"{text}: it stays {self._was}")

    @property
    def _was(self) -> str:
        assert self._old is not None
        return self._old.text

    def _read_back(self, parameter: Parameter, now_ns: int) -> list[Work]:
        assert self._old is not None
        held = parameter.value
        if held != self._value and self.tries < TRIES - 1 and held == self._old.value:
            return self._write(now_ns)  # the write was lost
        told: list[Work] = [
            self.tell(told_of(self.asked, parameter)),
            Record(ParamItem(self.asked.target.sysid, parameter.name, float(held))),
        ]
        if held == self._value:
            text = f"{self.name} = {parameter.text}; it was {self._was}"
            return [*told, *self.complete(text, logged=True)]
        text = f"{self.name} came back as {parameter.text}, not as {value_text(self._value)}"
        return [*told, *self.abort(Code.VEHICLE_REFUSED, text)]


def not_a_name(name: str) -> str:
    return f"{name!r} is no name of a parameter: up to 16 letters, digits and _"


def told_of(asked: Asked, *parameters: Parameter) -> ipc.ParametersEvent:
    """As an operator is told."""
    return ipc.ParametersEvent(
        asked.ask.id,
        [ipc.Parameter(each.name, each.value, each.type.name.lower()) for each in parameters],
    )
