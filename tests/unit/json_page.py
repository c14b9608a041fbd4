"""The part of docs/json.md that is made of `gcs/ipc.py`: a table for each struct.

Run: python -m tests.unit.json_page, which writes it anew.
"""

from __future__ import annotations

import typing
from collections.abc import Iterator
from pathlib import Path

import msgspec

from gcs import ipc, report
from gcs.shell.stations import Description

PAGE = Path(__file__).parents[2] / "docs" / "json.md"
BEGIN, END = "<!-- from gcs/ipc.py: begin -->\n", "<!-- from gcs/ipc.py: end -->\n"
PARTS = (
    ipc.Circle,
    ipc.OperatorInfo,
    report.FenceShape,
    ipc.BridgeLink,
    ipc.BridgeClient,
    ipc.BridgeVehicle,
    ipc.PreflightRow,
)
"""Structs inside of others."""


def tables() -> str:
    """The page's middle."""
    lines = [f"Schema version {ipc.SCHEMA}.", "", "## What an operator's program writes", ""]
    for command in typing.get_args(ipc.Command):
        lines += _table(command)
    lines += ["## What the station writes", ""]
    for event in typing.get_args(ipc.Event):
        lines += _table(event)
    lines += ["## Parts of these", ""]
    for part in PARTS:
        lines += _table(part)
    lines += ["## A station's description", ""]
    lines += _table(Description)
    return "\n".join(lines)


def _table(struct: type[msgspec.Struct]) -> Iterator[str]:
    tag = struct.__struct_config__.tag
    yield f"### `{tag}`" if tag else f"### {struct.__name__}"
    yield ""
    yield " ".join((struct.__doc__ or "").split())
    yield ""
    yield "| field | type | default |"
    yield "|---|---|---|"
    for field in msgspec.structs.fields(struct):
        yield f"| {field.encode_name} | {_type(field.type)} | {_default(field)} |"
    yield ""


def _type(kind: object) -> str:
    """As JSON has it."""
    plain = {int: "integer", float: "number", str: "text", bool: "true or false"}
    plain[bytes] = "text, base64"
    if kind in plain:
        return plain[kind]
    origin, inner = typing.get_origin(kind), typing.get_args(kind)
    if kind is type(None):
        return "null"
    if origin is typing.Annotated:
        return _type(inner[0])  # its limits are told in words
    if origin is list:
        return f"[{_type(inner[0])}, ...]"
    if origin is tuple:
        return f"[{', '.join(map(_type, inner))}]"
    if origin is dict:
        return f"object of {_type(inner[1])}"
    if inner:
        return " or ".join(dict.fromkeys(map(_type, inner)))
    assert isinstance(kind, type), kind
    tag = kind.__struct_config__.tag if issubclass(kind, msgspec.Struct) else None
    return f"`{tag}`" if tag else kind.__name__


def _default(field: msgspec.structs.FieldInfo) -> str:
    if field.default_factory is not msgspec.NODEFAULT:
        return msgspec.json.encode(field.default_factory()).decode()
    if field.default is msgspec.NODEFAULT:
        return "always there"
    return msgspec.json.encode(field.default).decode()


def page_with(middle: str) -> str:
    """The page, its middle replaced."""
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}{middle}{END}{after}"


if __name__ == "__main__":
    PAGE.write_text(page_with(tables()), encoding="utf-8")
