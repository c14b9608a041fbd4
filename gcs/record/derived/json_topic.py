"""A topic of JSON messages with a schema, both made of the fields of structs.

A value that is not known is left out rather than null, and so is an empty text: viewers read
`type` as one plain type.  They take no arrays of arrays either, so a topic that would have one
cannot be made.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from math import isfinite
from typing import TypeAlias

import msgspec
from msgspec import inspect

from gcs.mcap_file.writer import Channel
from gcs.record.topics import Out

encode = msgspec.json.Encoder().encode

Json: TypeAlias = "str | dict[str, Json]"
_TYPES: dict[type[inspect.Type], str] = {
    inspect.FloatType: "number",
    inspect.IntType: "integer",
    inspect.BoolType: "boolean",
    inspect.StrType: "string",
    inspect.LiteralType: "string",
}


class JsonTopic:
    """A topic whose messages are the fields of a struct, or of several structs in a row.

    `without` names fields that are left out: `sysid` is in the topic's name.
    """

    def __init__(
        self,
        topic: str,
        title: str,
        *kinds: type[msgspec.Struct],
        without: Collection[str] = ("sysid",),
    ) -> None:
        self._names = {
            kind: [name for name in kind.__struct_fields__ if name not in without] for kind in kinds
        }
        schema: dict[str, Json] = {"title": title, **_object(kinds, without)}
        self.channel = Channel(topic, "json", title, "jsonschema", encode(schema))

    def out(self, *facts: msgspec.Struct | None, latch: str = "") -> Out:
        """Without what is None, empty text, NaN or infinite; deeper inside, NaN becomes null."""
        values = {}
        for fact in facts:
            for name in self._names[type(fact)] if fact is not None else ():
                value = getattr(fact, name)
                if value is None or value == "":
                    continue
                if not (isinstance(value, float) and not isfinite(value)):
                    values[name] = value
        return Out(self.channel, encode(values), latch)


def _object(kinds: Iterable[type[msgspec.Struct]], without: Collection[str]) -> dict[str, Json]:
    fields = [one for kind in kinds for one in msgspec.structs.fields(kind)]
    properties: dict[str, Json] = {
        one.name: _schema(inspect.type_info(one.type)) for one in fields if one.name not in without
    }
    return {"type": "object", "properties": properties}


def _schema(kind: inspect.Type) -> dict[str, Json]:
    """One plain type; an object's properties only where they are always the same."""
    match kind:
        case inspect.UnionType(types):
            (kind,) = (each for each in types if not isinstance(each, inspect.NoneType))
            return _schema(kind)
        case inspect.StructType(cls):
            return _object([cls], ())
        case inspect.DictType() | inspect.RawType():
            return {"type": "object", "properties": {}}
        case inspect.ListType(item_type=item) | inspect.VarTupleType(item_type=item):
            return _array(item)
        case inspect.TupleType(item_types):
            return _array(item_types[0])
        case _:
            return {"type": _TYPES[type(kind)]}


def _array(kind: inspect.Type) -> dict[str, Json]:
    items = _schema(kind)
    if items["type"] == "array":
        raise TypeError("viewers take no array of arrays")
    return {"type": "array", "items": items}
