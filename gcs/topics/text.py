"""A message as a person reads it: one field a line, enum values with their names."""

from __future__ import annotations

from gcs.topics.describe import enum_name
from gcs.topics.topic import Fields, Topic, Value

FLOAT_DIGITS = 9
"""As many as tell every float32 apart."""


def message_lines(topic: Topic, fields: Fields) -> list[str]:
    """`name: value`; what is nested is indented; `# NAME` behind the value of an enum."""
    lines = []
    for name, value in fields.items():
        if isinstance(value, dict):
            lines += [f"{name}:", *_indented(value)]
            continue
        meaning = enum_name(topic.message, name, value) if topic.is_mavlink else ""
        lines.append(f"{name}: {value_text(value)}" + (f"  # {meaning}" if meaning else ""))
    return lines


def value_text(value: Value) -> str:
    """One value on one line."""
    match value:
        case None:
            return "-"
        case bool():
            return "true" if value else "false"
        case float():
            return f"{value:.{FLOAT_DIGITS}g}"
        case str():
            return repr(value)
        case list():
            return f"[{', '.join(value_text(each) for each in value)}]"
        case dict():
            inner = ", ".join(f"{name}: {value_text(each)}" for name, each in value.items())
            return f"{{{inner}}}"
        case _:
            return str(value)


def _indented(value: Fields) -> list[str]:
    lines = []
    for name, inner in value.items():
        if isinstance(inner, dict):
            lines += [f"  {name}:", *(f"  {line}" for line in _indented(inner))]
        else:
            lines.append(f"  {name}: {value_text(inner)}")
    return lines
