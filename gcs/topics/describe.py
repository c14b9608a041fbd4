"""What the messages of a topic consist of: fields, units, and the names of enum values."""

from __future__ import annotations

import msgspec

from gcs.topics.topic import Topic, Value
from gcs.wire.dialect import ENUMS, MESSAGES_BY_NAME, MessageDef


class EnumValue(msgspec.Struct, frozen=True):
    value: int
    name: str


class FieldInfo(msgspec.Struct, frozen=True):
    """One field; `type` is the dialect's, with [n] for an array."""

    name: str
    type: str
    units: str = ""
    enum: str = ""
    extension: bool = False
    values: list[EnumValue] = []


class MessageInfo(msgspec.Struct, frozen=True):
    """A type of messages; `msgid` None: none of MAVLink's."""

    name: str
    msgid: int | None
    fields: list[FieldInfo]


def message_info(name: str) -> MessageInfo | None:
    """The dialect's message of this name, in whatever case; None if it has none."""
    definition = MESSAGES_BY_NAME.get(name.upper())
    return None if definition is None else _of_definition(definition)


def topic_info(topic: Topic) -> MessageInfo:
    """From the dialect, or from the schema that the record has."""
    known = message_info(topic.message) if topic.is_mavlink else None
    return known or MessageInfo(topic.schema, None, _of_json_schema(topic.schema_text))


def enum_name(message: str, field: str, value: Value) -> str:
    """The name of an enum's entry that a field has as its value, or ""."""
    enum = _enum_fields(message).get(field)
    return _names(enum).get(value, "") if enum and isinstance(value, int) else ""


def _of_definition(definition: MessageDef) -> MessageInfo:
    fields = []
    for field in definition.fields:
        array = f"[{field.array_length}]" if field.array_length else ""
        values = [EnumValue(value, name) for value, name in _names(field.enum).items()]
        fields.append(
            FieldInfo(
                field.name, f"{field.type}{array}", field.units, field.enum, field.extension, values
            )
        )
    return MessageInfo(definition.name, definition.msgid, fields)


class _Schema(msgspec.Struct):
    """What is looked at in a JSON schema."""

    type: str = ""
    properties: dict[str, _Schema] = {}


def _of_json_schema(text: str) -> list[FieldInfo]:
    try:
        schema = msgspec.json.decode(text, type=_Schema)
    except (msgspec.DecodeError, RecursionError):
        return []
    return _nested("", schema)


def _nested(prefix: str, schema: _Schema) -> list[FieldInfo]:
    fields = []
    for name, inner in schema.properties.items():
        fields.append(FieldInfo(prefix + name, inner.type))
        fields += _nested(f"{prefix}{name}.", inner)
    return fields


def _enum_fields(message: str) -> dict[str, str]:
    definition = MESSAGES_BY_NAME.get(message)
    return {field.name: field.enum for field in definition.fields} if definition else {}


def _names(enum: str) -> dict[int, str]:
    definition = ENUMS.get(enum)
    return {entry.value: entry.name for entry in definition.entries} if definition else {}
