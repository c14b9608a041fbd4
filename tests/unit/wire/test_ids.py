"""The ids and enums are MAVLink's, and using them loads no more than it must."""

from __future__ import annotations

import sys
from enum import IntEnum
from subprocess import run

import pytest
from pymavlink.dialects.v20 import all as pymavlink_dialect

from gcs.wire import ids, supplement
from gcs.wire.selection import ENUMS, EnumChoice


@pytest.mark.parametrize("choice", ENUMS, ids=lambda choice: choice.class_name)
def test_an_enum_has_pymavlinks_numbers(choice: EnumChoice) -> None:
    enum: type[IntEnum] = getattr(ids, choice.class_name)
    known = supplement.ENTRIES.get(choice.name, {})
    lacking = {name: value for value, name in known.items()}
    for member in enum:
        name = choice.prefix + member.name
        assert member.value == getattr(pymavlink_dialect, name, lacking.get(name)), name


def test_message_ids_are_pymavlinks() -> None:
    names = {message.msgid: message.name for message in supplement.messages()}
    names |= {number: kind.msgname for number, kind in pymavlink_dialect.mavlink_map.items()}
    for member in ids.MsgId:
        assert names[member.value] == member.name


@pytest.mark.slow
@pytest.mark.parametrize(
    ("modules", "absent"),
    [
        ("gcs.wire.codec, gcs.shell.sockets, gcs.protocol.mission", "pymavlink.mavutil"),
        ("gcs.wire.messages, gcs.protocol.mission", "pymavlink"),
        ("gcs.wire.ids, gcs.protocol.autopilot, gcs.protocol.command", "pymavlink"),
    ],
)
def test_importing_loads_no_more_than_it_must(modules: str, absent: str) -> None:
    program = f"import sys, {modules}; sys.exit({absent!r} in sys.modules)"
    assert run([sys.executable, "-c", program], check=False).returncode == 0
