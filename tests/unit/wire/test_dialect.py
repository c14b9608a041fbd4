"""The derived tables are pymavlink's dialect, plus what upstream has and it lacks."""

from __future__ import annotations

import json

from fastcrc import crc16
from pymavlink.dialects.v20 import all as pymavlink_dialect
from pymavlink.generator.mavcrc import x25crc

from gcs.wire import supplement
from gcs.wire.dialect import (
    ENUMS,
    MESSAGES,
    MESSAGES_BY_NAME,
    TYPE_CODES,
    FieldDef,
    MessageDef,
)
from tests.each import each
from tests.sample_files import elsewhere


def crc_extra_by_the_spec(message: MessageDef) -> int:
    """https://mavlink.io/en/guide/serialization.html#crc_extra, over the base fields."""
    text = f"{message.name} ".encode()
    for field in message.fields:
        if field.extension:
            break
        plain = field.type in ("char", "float", "double")
        text += f"{field.type}{'' if plain else '_t'} {field.name} ".encode()
        if field.array_length:
            text += bytes((field.array_length,))
    crc = crc16.mcrf4xx(text)
    return (crc & 0xFF) ^ (crc >> 8)


@each("message", MESSAGES.values(), said=lambda message: message.name)
def test_the_crc_extra_follows_from_the_base_fields(message: MessageDef) -> None:
    assert message.crc_extra == crc_extra_by_the_spec(message)


@each("message", MESSAGES.values(), said=lambda message: message.name)
def test_fields_lie_packed_and_extensions_last(message: MessageDef) -> None:
    offset = 0
    for field in message.fields:
        assert field.offset == offset
        offset += field.size
    assert message.max_len == offset <= 255
    extensions = [field.extension for field in message.fields]
    assert extensions == sorted(extensions)
    assert message.min_len == sum(f.size for f in message.fields if not f.extension)
    assert all(field.enum in ENUMS for field in message.fields if field.enum)


def test_every_message_of_pymavlink_is_there_in_full() -> None:
    for msgid, theirs in pymavlink_dialect.mavlink_map.items():
        ours = MESSAGES[msgid]
        assert ours.name == theirs.msgname
        assert ours.crc_extra == theirs.crc_extra
        assert ours.max_len >= theirs.unpacker.size
        names = [field.name for field in ours.fields]
        assert names[: len(theirs.ordered_fieldnames)] == theirs.ordered_fieldnames
    assert len(MESSAGES) == len(pymavlink_dialect.mavlink_map) + 22


def struct_format(fields: tuple[FieldDef, ...]) -> str:
    """As pymavlink writes it: only `char` arrays are strings."""
    codes = (
        "s" if field.type == "char" and field.array_length else TYPE_CODES[field.type]
        for field in fields
    )
    pairs = zip(fields, codes, strict=True)
    return "<" + "".join(f"{field.array_length or ''}{code}" for field, code in pairs)


def test_payloads_are_laid_out_as_pymavlink_packs_them() -> None:
    for msgid, theirs in pymavlink_dialect.mavlink_map.items():
        known = MESSAGES[msgid].fields[: len(theirs.ordered_fieldnames)]
        assert struct_format(known) == theirs.unpacker.format, theirs.msgname


def test_known_lengths_of_the_specification() -> None:
    lengths = {
        "HEARTBEAT": (9, 9),
        "GPS_RAW_INT": (30, 52),
        "COMMAND_ACK": (3, 10),
        "MISSION_ITEM_INT": (37, 38),
        "MISSION_COUNT": (4, 9),
        "STATUSTEXT": (51, 54),
    }
    found = {name: MESSAGES_BY_NAME[name][3:5] for name in lengths}
    assert found == lengths


def test_a_longer_version_keeps_what_pymavlink_knows_of_the_shorter() -> None:
    count = MESSAGES_BY_NAME["MISSION_COUNT"]
    fields = {field.name: field for field in count.fields}
    assert fields["mission_type"].enum == "MAV_MISSION_TYPE"
    assert fields["opaque_id"].extension


def test_enums_have_no_end_marks_and_all_results() -> None:
    names = [entry.name for enum in ENUMS.values() for entry in enum.entries]
    assert not [name for name in names if name.endswith("_ENUM_END")]
    assert [entry.value for entry in ENUMS["MAV_RESULT"].entries] == list(range(11))
    assert ENUMS["MAV_RESULT"].entries[9].name == "MAV_RESULT_COMMAND_UNSUPPORTED_MAV_FRAME"


def test_the_supplement_is_what_upstream_has() -> None:
    facts = json.loads(elsewhere("dialect_supplement.json").read_text())
    listed = {message.msgid: message for message in supplement.messages()}
    common = {fact["id"] for fact in facts["messages"]}
    assert listed.keys() == common | supplement.DEVELOPMENT
    assert not common & supplement.DEVELOPMENT
    for fact in facts["messages"]:
        ours = MESSAGES[fact["id"]]
        assert (ours.name, ours.crc_extra) == (fact["name"], fact["crc_extra"])
        assert (ours.min_len, ours.max_len) == (fact["min_len"], fact["len"])
        assert {(f.name, f.type, f.array_length, f.offset, f.extension) for f in ours.fields} == {
            (f["name"], f["type"].removesuffix("_t"), f["array"], f["offset"], f["extension"])
            for f in fact["fields"]
        }
    results = {int(value): name for value, name in facts["mav_result"].items()}
    assert supplement.RESULTS.items() <= results.items()


def test_the_crc_extra_of_what_is_in_development_is_that_of_its_fields() -> None:
    """MAVLink guide, "CRC_EXTRA calculation": over name, types and names of the fields."""
    for msgid in supplement.DEVELOPMENT:
        message = MESSAGES[msgid]
        crc = x25crc(f"{message.name} ".encode())
        for field in message.fields:
            crc.accumulate(f"{field.type}_t {field.name} ".encode())
            if field.array_length:
                crc.accumulate(bytes((field.array_length,)))
        assert (crc.crc & 0xFF) ^ (crc.crc >> 8) == message.crc_extra
