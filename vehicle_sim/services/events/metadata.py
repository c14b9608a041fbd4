"""What a ground station reads about a px4 vehicle (MAVLink Component Metadata).

JSON files by the schemas of the protocol: the general one says where the others are, one describes
the parameters, one the events (`event_definitions.py`).  The parameters' texts come from the
parameter tables, which write a unit as `[m/s]`, choices as `0 warn 2 land when critical`, and bits
as `bit 0 this, bit 1 that` or as `1 this 2 that; added up`.  Of a parameter that does nothing here
they say so, without bounds.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Final

from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.tables import TABLES, ParameterSpec
from vehicle_sim.storage.store import crc32_of
from vehicle_sim.storage.virtual_files import Virtual, VirtualFiles

if TYPE_CHECKING:
    from vehicle_sim.services.events.event_definitions import Json

GENERAL_PATH: Final = "etc/extras/component_general.json"
PARAMETERS_PATH: Final = "etc/extras/parameters.json"
EVENTS_PATH: Final = "etc/extras/all_events.json"
"""PX4's own places, without its compression."""

PARAMETER_METADATA: Final = 1  # COMP_METADATA_TYPE_PARAMETER
EVENTS_METADATA: Final = 4  # COMP_METADATA_TYPE_EVENTS
_UNIT: Final = re.compile(r" ?\[([^]]+)\]")
_BIT: Final = re.compile(r"bit (\d+) ([^,]+)")
_CHOICE: Final = re.compile(r"(?:^|(?<=[ :]))(\d+) ([A-Za-z][A-Za-z, -]*?)(?=,? \d+ |$)")


@dataclass(frozen=True, slots=True)
class Metadata:
    """The files, and what COMPONENT_METADATA says about the general one."""

    files: VirtualFiles
    uri: str
    personality: Personality

    @property
    def crc(self) -> int:
        return crc32_of(_texts(self.personality)[GENERAL_PATH])


def metadata_of(personality: Personality) -> Metadata:
    """The same for all vehicles of a personality: values do not enter.

    The texts are made when somebody asks for one.
    """

    def read(path: str) -> Virtual:
        return Virtual(lambda query: _texts(personality)[path])

    files = {path: read(path) for path in (GENERAL_PATH, PARAMETERS_PATH, EVENTS_PATH)}
    return Metadata(files, _uri(GENERAL_PATH), personality)


@cache
def _texts(personality: Personality) -> dict[str, bytes]:
    """By path."""
    from vehicle_sim.services.events.event_definitions import definitions

    specs = TABLES[personality]
    described = _json({"version": 1, "parameters": [_described(spec) for spec in specs]})
    events = _json(definitions())
    entries = [
        _entry(PARAMETER_METADATA, PARAMETERS_PATH, described),
        _entry(EVENTS_METADATA, EVENTS_PATH, events),
    ]
    general = _json({"version": 1, "metadataTypes": entries})
    return {GENERAL_PATH: general, PARAMETERS_PATH: described, EVENTS_PATH: events}


def _entry(kind: int, path: str, data: bytes) -> Json:
    return {"type": kind, "uri": _uri(path), "fileCrc": crc32_of(data)}


def _uri(path: str) -> str:
    return f"mftp://{path}"


def _json(value: Json) -> bytes:
    import json  # only when somebody asks for a file

    return json.dumps(value, separators=(",", ":")).encode("ascii")


def _described(spec: ParameterSpec) -> Json:
    """One parameter by parameter.schema.json."""
    unit = _UNIT.search(spec.what)
    text = _UNIT.sub("", spec.what)
    described: Json = {
        "name": spec.name,
        "type": "Int32" if spec.integer else "Float",
        "shortDesc": text[:1].upper() + text[1:],
        "units": unit[1] if unit else "",
        "default": spec.default,
        "group": spec.name.partition("_")[0],
        "rebootRequired": spec.reboot,
    }
    if spec.inert:
        return described
    described |= {"min": spec.low, "max": spec.high}
    if not spec.integer:
        described["decimalPlaces"] = 2
        return described
    return described | _choices(spec.what)


def _choices(what: str) -> Json:
    """What the numbers mean, or the bits of one number; none if the text names fewer than two."""
    text, _, rest = what.partition(";")
    bits = [(int(bit), meaning) for bit, meaning in _BIT.findall(text)]
    found = [(int(value), meaning.strip(" ,")) for value, meaning in _CHOICE.findall(text)]
    if "added up" in rest:
        bits = [(value.bit_length() - 1, meaning) for value, meaning in found]
    if len(bits) > 1:
        return {"bitmask": [{"index": bit, "description": meaning} for bit, meaning in bits]}
    if len(found) > 1:
        return {"values": [{"value": value, "description": text} for value, text in found]}
    return {}
