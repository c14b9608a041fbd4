"""The parameter protocol: list, read, set.

Integers travel as their bytes (px4) or as a float of the same value (ardupilot).  PARAM_SET is
answered with the value that then holds.  PX4 tells a change twice, and is silent if the type or
the name is wrong; ArduPilot since 4.7 answers with PARAM_ERROR what it does not take.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import Final

from vehicle_sim.autopilot.parameters.parameters import ParameterError, Parameters
from vehicle_sim.effects import Client, Effect, Note, Send
from vehicle_sim.services.profile import Profile
from vehicle_sim.services.streams import NEVER
from vehicle_sim.storage.store import crc32_of
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import ParamType

NO_INDEX: Final = 0xFFFF
PACE_NS: Final = 1_000_000
"""One PARAM_VALUE of a list per millisecond: a full list stays within a client's buffers."""
BURST: Final = 8
HASH_CHECK: Final = "_HASH_CHECK"
DOES_NOT_EXIST: Final = 1  # MAV_PARAM_ERROR
VALUE_OUT_OF_RANGE: Final = 2
TOLD_AGAIN_NS: Final = 15_000_000
"""PX4 tells a change once more, 10 to 20 ms later."""

_FORMATS: Final = {ParamType.UINT32: "<I", ParamType.INT32: "<i", ParamType.REAL32: "<f"}


def encode(value: float, kind: ParamType, bytewise: bool) -> float:
    """The float that PARAM_VALUE carries."""
    if kind is ParamType.REAL32 or not bytewise:
        return value
    (carried,) = struct.unpack("<f", struct.pack(_FORMATS[kind], int(value)))
    return float(carried)


def decode(carried: float, kind: ParamType, bytewise: bool) -> float:
    """The value that a PARAM_SET means."""
    if kind is ParamType.REAL32:
        return carried
    if bytewise:
        return float(struct.unpack(_FORMATS[kind], struct.pack("<f", carried))[0])
    return carried


@dataclass(slots=True)
class _Listing:
    client: Client
    next_index: int
    due_ns: int


class ParameterServer:
    """One vehicle's parameters; wall time paces the list."""

    def __init__(self, parameters: Parameters, profile: Profile) -> None:
        self._parameters = parameters
        self._profile = profile
        self._names: Final = tuple(spec.name for spec in parameters.specs)
        self._index: Final = {name: index for index, name in enumerate(self._names)}
        self._listings: dict[int, _Listing] = {}
        self._told_again: dict[str, int] = {}  # when, by name

    @property
    def deadline_ns(self) -> int:
        due_ns = [listing.due_ns for listing in self._listings.values()]
        return min((*due_ns, *self._told_again.values()), default=NEVER)

    def request_list(self, client: Client, now_ns: int) -> list[Effect]:
        """PX4 leaves the hash out if it is asked again while a list is on its way."""
        again = client.channel in self._listings
        self._listings[client.channel] = _Listing(client, 0, now_ns)
        hashed = self._hashes and not again
        return [Send(client.channel, self._hash_value())] if hashed else []

    def tick(self, now_ns: int) -> list[Effect]:
        effects: list[Effect] = []
        for name, due_ns in list(self._told_again.items()):
            if now_ns >= due_ns:
                del self._told_again[name]
                effects.append(Send(None, self._value(name)))
        for channel, listing in list(self._listings.items()):
            burst = max(0, min(BURST, (now_ns - listing.due_ns) // PACE_NS + 1))
            chunk = self._names[listing.next_index : listing.next_index + burst]
            effects.extend(Send(channel, self._value(name)) for name in chunk)
            listing.next_index += burst
            listing.due_ns = max(listing.due_ns, now_ns + PACE_NS)
            if listing.next_index >= len(self._names):
                del self._listings[channel]
        return effects

    def forget(self, channel: int) -> None:
        self._listings.pop(channel, None)

    def read(self, client: Client, asked: m.ParamRequestRead) -> list[Effect]:
        name = _name(asked.param_id)
        if 0 <= asked.param_index < len(self._names):
            name = self._names[asked.param_index]
        elif asked.param_index >= 0:
            return self._unknown(client, asked.param_id, asked.param_index)
        elif name == HASH_CHECK and self._hashes:
            return [Send(client.channel, self._hash_value())]
        if name not in self._parameters:
            return self._unknown(client, asked.param_id, asked.param_index)
        return [Send(client.channel, self._value(name))]

    def set(self, client: Client, asked: m.ParamSet, now_ns: int) -> list[Effect]:
        name = _name(asked.param_id)
        if name == HASH_CHECK and self._hashes:
            # QGroundControl knows these values already and needs no list.
            self._listings.pop(client.channel, None)
            return []
        if name not in self._parameters:
            return self._unknown(client, asked.param_id, -1)
        kind = self._kind(name)
        bytewise = self._profile.bytewise_parameters
        if bytewise and asked.param_type != kind:
            text = f"{name} refused: its type is {kind.name}, not {asked.param_type}"
            return [Note("warning", text)]
        before = self._parameters.value(name)
        try:
            stored = self._parameters.set(name, decode(asked.param_value, kind, bytewise))
        except ParameterError as refusal:
            note = Note("warning", f"parameter {refusal}")
            if self._profile.parameter_errors:
                return [self._error(client, asked.param_id, -1, VALUE_OUT_OF_RANGE), note]
            return [Send(None, self._value(name, echo=True)), note]
        if bytewise and stored != before:
            self._told_again[name] = now_ns + TOLD_AGAIN_NS
        note = Note("info", f"parameter {name} = {stored:g}")
        return [Send(None, self._value(name, echo=True)), note]

    @property
    def _hashes(self) -> bool:
        return self._profile.hash_check and self._parameters.get("MAV_HASH_CHK_EN") != 0

    def _kind(self, name: str) -> ParamType:
        return ParamType(self._parameters.spec(name).stored_as)

    def _value(self, name: str, echo: bool = False) -> m.ParamValue:
        """`echo`: in answer to a PARAM_SET, where ArduPilot leaves the index out."""
        kind = self._kind(name)
        nameless = echo and not self._profile.bytewise_parameters
        value = self._parameters.value(name)
        return m.ParamValue(
            param_value=encode(value, kind, self._profile.bytewise_parameters),
            param_count=len(self._names),
            param_index=NO_INDEX if nameless else self._index[name],
            param_id=name.encode("ascii"),
            param_type=kind,
        )

    def _hash_value(self) -> m.ParamValue:
        """PX4's hash, which QGroundControl reckons from its cache: CRC-32 over names and values.

        In the order of the names' characters, as both sort them.  A hash that is a signalling
        NaN, one in 512, is quieted on its way through a float: then the list is loaded anew.
        """
        crc = 0
        for name in sorted(self._names):
            stored = _FORMATS[self._kind(name)]
            value = self._parameters.value(name)
            whole = self._parameters.spec(name).integer
            crc = crc32_of(name.encode("ascii"), crc)
            crc = crc32_of(struct.pack(stored, int(value) if whole else value), crc)
        return m.ParamValue(
            encode(crc, ParamType.UINT32, bytewise=True),
            len(self._names),
            NO_INDEX,
            HASH_CHECK.encode("ascii"),
            ParamType.UINT32,
        )

    def _unknown(self, client: Client, name: bytes, index: int) -> list[Effect]:
        shown = _name(name) or f"number {index}"
        effects: list[Effect] = [Note("warning", f"there is no parameter {shown}")]
        if self._profile.parameter_errors:
            effects.append(self._error(client, name, index, DOES_NOT_EXIST))
        return effects

    def _error(self, client: Client, name: bytes, index: int, error: int) -> Effect:
        message = m.ParamError(index, client.system, client.component, name, error)
        return Send(client.channel, message)


def _name(field: bytes) -> str:
    """Up to 16 characters; the NUL is missing at 16."""
    return field.split(b"\0", 1)[0].decode("ascii", "replace")
