"""Every message class against the dialect, and over the wire with pymavlink at the other end."""

from __future__ import annotations

from typing import Any, get_type_hints

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import all as pymavlink_dialect

from gcs.wire.codec import FrameWriter, Layout, decode, encode
from gcs.wire.dialect import MESSAGES, FieldDef, MessageDef
from gcs.wire.frame import Frame, split
from gcs.wire.messages import CLASSES, Message
from tests.each import each
from tests.shares import examples

BITS = {"int8": 8, "int16": 16, "int32": 32, "int64": 64}
BITS |= {f"u{name}": bits for name, bits in BITS.items()}


def scalars(type_: str) -> st.SearchStrategy[int | float]:
    if type_ == "float":
        return st.floats(width=32, allow_nan=False)
    if type_ == "double":
        return st.floats(allow_nan=False)
    bits = BITS[type_]
    if type_.startswith("u"):
        return st.integers(0, 2**bits - 1)
    return st.integers(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)


def values(field: FieldDef) -> st.SearchStrategy[Any]:
    """What one field can hold and gets back unchanged."""
    if field.type == "char":
        letters = st.characters(min_codepoint=32, max_codepoint=126)
        return st.text(letters, max_size=max(1, field.array_length))
    if field.array_length:
        size = field.array_length
        return st.lists(scalars(field.type), min_size=size, max_size=size).map(tuple)
    return scalars(field.type)


def fields_of(definition: MessageDef) -> st.SearchStrategy[dict[str, Any]]:
    return st.fixed_dictionaries({field.name: values(field) for field in definition.fields})


def only(raw: bytes) -> Frame:
    (frame,) = split(raw)
    assert isinstance(frame, Frame)
    return frame


def heard_by_pymavlink(raw: bytes) -> Any:
    receiver = pymavlink_dialect.MAVLink(None)
    return receiver.decode(bytearray(raw))


def as_pymavlink_says(value: Any) -> Any:
    """pymavlink gives lists for arrays."""
    return tuple(value) if isinstance(value, list) else value


@each("cls", CLASSES.values(), said=lambda cls: cls.__name__)
def test_a_class_has_the_dialects_fields(cls: type[Message]) -> None:
    definition = MESSAGES[cls.MSG_ID]
    assert cls.__name__.upper() == definition.name.replace("_", "")
    assert cls.__struct_fields__ == tuple(field.name for field in definition.fields)
    hints = get_type_hints(cls)
    for field in definition.fields:
        scalar = float if field.type in ("float", "double") else int
        expected: object = str if field.type == "char" else scalar
        if field.type != "char" and field.array_length:
            expected = tuple[scalar, ...]  # type: ignore[valid-type]  # made at run time
        assert hints[field.name] == expected, field.name


@each("cls", CLASSES.values(), said=lambda cls: cls.__name__)
def test_extensions_that_did_not_come_read_as_the_defaults(cls: type[Message]) -> None:
    definition = MESSAGES[cls.MSG_ID]
    zeros = decode(zero_frame(definition))
    base = {f.name: getattr(zeros, f.name) for f in definition.fields if not f.extension}
    assert cls(**base) == zeros


def zero_frame(definition: MessageDef) -> Frame:
    return only(FrameWriter(1, 1).write_payload(definition.msgid, bytes(definition.max_len)))


@pytest.mark.parametrize("cls", CLASSES.values(), ids=lambda cls: cls.__name__)
@settings(max_examples=examples(15))
@given(data=st.data())
def test_what_we_write_pymavlink_reads(cls: type[Message], data: st.DataObject) -> None:
    definition = MESSAGES[cls.MSG_ID]
    fields = data.draw(fields_of(definition))
    message = cls(**fields)
    raw = FrameWriter(7, 42).write(message)
    assert decode(only(raw)) == message
    if definition.msgid not in pymavlink_dialect.mavlink_map:
        return
    theirs = heard_by_pymavlink(raw)
    assert (theirs.get_srcSystem(), theirs.get_srcComponent()) == (7, 42)
    for name in theirs.get_fieldnames():
        assert as_pymavlink_says(getattr(theirs, name)) == fields[name], name


@pytest.mark.parametrize("cls", CLASSES.values(), ids=lambda cls: cls.__name__)
@pytest.mark.parametrize("mavlink1", [False, True], ids=["mavlink2", "mavlink1"])
@settings(max_examples=examples(10))
@given(data=st.data())
def test_what_pymavlink_writes_we_read(
    cls: type[Message], mavlink1: bool, data: st.DataObject
) -> None:
    definition = MESSAGES[cls.MSG_ID]
    theirs = pymavlink_dialect.mavlink_map.get(definition.msgid)
    if theirs is None or (mavlink1 and definition.msgid > 255):
        return
    fields = data.draw(fields_of(definition))
    given_fields = [fields[name] for name in theirs.fieldnames]
    packed = [v.encode() if isinstance(v, str) else v for v in given_fields]
    sender = pymavlink_dialect.MAVLink(None, srcSystem=9, srcComponent=8)
    raw = bytes(theirs(*packed).pack(sender, force_mavlink1=mavlink1))
    frame = only(raw)
    assert (frame.sysid, frame.compid, frame.msgid) == (9, 8, definition.msgid)
    decoded = decode(frame)
    assert decoded is not None
    for field in definition.fields:
        if field.name in theirs.fieldnames:
            assert getattr(decoded, field.name) == fields[field.name]
        elif field.type != "char":
            zeros = getattr(decoded, field.name)
            assert not any(zeros if isinstance(zeros, tuple) else (zeros,))


def payload_of(definition: MessageDef) -> bytes:
    """The full length of printable letters: text would end at a zero, and is shown without what a
    terminal obeys."""
    return bytes(17 * i % 0x5F + 0x20 for i in range(definition.max_len))


@each("cls", CLASSES.values(), said=lambda cls: cls.__name__)
def test_every_byte_of_a_payload_is_in_a_field(cls: type[Message]) -> None:
    definition = MESSAGES[cls.MSG_ID]
    payload = payload_of(definition)
    decoded = decode(only(FrameWriter(1, 1).write_payload(definition.msgid, payload)))
    assert decoded is not None
    assert encode(decoded) == payload


@each("cls", CLASSES.values(), said=lambda cls: cls.__name__)
def test_a_class_may_be_older_than_the_dialect(cls: type[Message]) -> None:
    """A newer pymavlink may know another extension; fields never change otherwise."""
    ours = MESSAGES[cls.MSG_ID]
    added = FieldDef("added", "uint32", 0, ours.max_len, True, "", "")
    newer = ours._replace(fields=(*ours.fields, added), max_len=ours.max_len + 4)
    payload = payload_of(ours)
    decoded = Layout(cls, newer).decode(payload + b"\1\2\3\4")
    assert decoded == Layout(cls, ours).decode(payload)
    assert Layout(cls, newer).encode(decoded) == payload
