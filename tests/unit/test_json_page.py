"""docs/json.md says what `gcs/ipc.py` is, to the last field."""

from __future__ import annotations

import msgspec

from gcs import ipc
from tests.unit.json_page import PAGE, page_with, tables


def test_the_page_is_the_structs() -> None:
    """`python -m tests.unit.json_page` writes it anew."""
    assert PAGE.read_text(encoding="utf-8") == page_with(tables())


def test_every_line_in_the_page_decodes() -> None:
    """Its examples: `>` lines go to the station, `<` lines come from it."""
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    said = [line[2:].encode() for line in lines if line.startswith('> {"')]
    told = [line[2:].encode() for line in lines if line.startswith('< {"')]
    assert {type(ipc.decode_command(line)) for line in said} >= {ipc.Join, ipc.Ask, ipc.Leave}
    assert {type(ipc.decode_event(line)) for line in told} >= {ipc.Hello, ipc.VerdictEvent}


def test_a_hello_tells_the_version_of_all_this() -> None:
    hello = msgspec.json.decode(ipc.encode(ipc.Hello("0.1.0", "", [], "default")))
    assert hello["schema"] == ipc.SCHEMA


def test_fields_that_a_reader_does_not_know_are_passed_over() -> None:
    line = b'{"type":"leave","reason":"done","of_a_later_version":[1,2]}'
    assert ipc.decode_command(line) == ipc.Leave("done")
