"""Pages of the documentation site that are made from the program: commands, policy, topics, Python.

Nothing is written here that the program does not say itself: helps are the commands' own, the
policy's keys are the comments of `default.toml`, the topics are what the record's derivers make of
one item of each kind.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path

import click

import gcs
from gcs.cli.main import COMMANDS
from gcs.cli.main import gcs as gcs_command
from gcs.mcap_file.writer import Channel
from gcs.record.derived import Derived
from gcs.report import (
    DecisionItem,
    FenceItem,
    FenceShape,
    FsaItem,
    GeodeticItem,
    InputItem,
    LegItem,
    LogEvent,
    MissionItem,
    ParamItem,
    PointEnu,
    PoseItem,
    RecordItem,
    SetpointItem,
    StatusItem,
    StopItem,
)

POLICY = Path(gcs.__file__).parent / "gate" / "policy" / "default.toml"
HELP_WIDTH = 96


def write(folder: Path) -> None:
    """All pages, anew; what is left of an earlier version goes."""
    folder.mkdir(exist_ok=True)
    made = {**dict(commands()), "policy": policy(), "topics": topics(), "python": python()}
    for old in folder.glob("*.md"):
        if old.stem not in made:
            old.unlink()
    for name, text in made.items():
        page = folder / f"{name}.md"
        if not page.exists() or page.read_text(encoding="utf-8") != text:
            page.write_text(text, encoding="utf-8")


def commands() -> Iterator[tuple[str, str]]:
    """A page for each section of `gcs --help`, and one for each command that is a group."""
    context = click.Context(gcs_command, info_name="gcs")
    for section, words in COMMANDS.items():
        lines = [f"# {section}", ""]
        for word in words:
            command = gcs_command.get_command(context, word)
            assert command is not None
            if isinstance(command, click.Group):
                page = f"commands-{word}"
                lines += [f"- [gcs {word}]({page}.md): {words[word].help}", ""]
                yield page, "\n".join(_help(command, word, context, "#")) + "\n"
            else:
                lines += _help(command, word, context, "##")
        yield "commands-" + re.sub(r"\W+", "-", section.lower()), "\n".join(lines) + "\n"


def _help(command: click.Command, word: str, parent: click.Context, head: str) -> Iterator[str]:
    context = click.Context(
        command, info_name=word, parent=parent, terminal_width=HELP_WIDTH, max_content_width=120
    )
    yield from (f"{head} {context.command_path}", "", "```text", command.get_help(context), "```")
    yield ""
    if isinstance(command, click.Group):
        for inner in command.list_commands(context):
            below = command.get_command(context, inner)
            if below is not None:
                yield from _help(below, inner, context, head + "#")


def policy() -> str:
    """`default.toml`, a heading for each of its parts."""
    text = POLICY.read_text(encoding="utf-8")
    start, *parts = re.split(r"^# -{4} (.*?) -+$", text, flags=re.MULTILINE)
    lines = ["# Every key of a policy", "", _prose(start), "```toml", 'name = "default"', "```", ""]
    for title, body in zip(parts[::2], parts[1::2], strict=True):
        lines += [f"## {title[0].upper()}{title[1:]}", "", "```toml", body.strip(), "```", ""]
    return "\n".join(lines)


def _prose(comment: str) -> str:
    found = (line.removeprefix("#").strip() for line in comment.splitlines() if line[:1] == "#")
    return "\n".join(found) + "\n"


def topics() -> str:
    """The derived topics: those whose messages are JSON with their fields."""
    derived = Derived()
    outs = [out for item in _ITEMS for out in derived.handle(item, 1)]
    channels = {out.channel.topic: out.channel for out in [*outs, *derived.close(2)]}
    lines = [
        "# Topics of a record",
        "",
        "Beside these stands every frame: `/mavlink/SYSTEM/COMPONENT/MESSAGE` with the bytes of",
        "the wire as a ROS 1 message whose fields are those of the MAVLink message, and",
        "`/link/N/garbage` with what was no frame. N is a vehicle's system id.",
        "",
        "| topic | schema | encoding |",
        "|---|---|---|",
    ]
    lines += [
        f"| `{topic.replace('/1/', '/N/')}` | {one.schema_name} | {one.message_encoding} |"
        for topic, one in sorted(channels.items())
    ]
    for topic, one in sorted(channels.items()):
        if one.message_encoding == "json":
            lines += ["", f"## {topic.replace('/1/', '/N/')}", "", *_fields(one)]
    return "\n".join(lines) + "\n"


def _fields(channel: Channel) -> Iterator[str]:
    yield from ("| field | type |", "|---|---|")
    yield from _rows("", json.loads(channel.schema))


def _rows(prefix: str, schema: dict[str, object]) -> Iterator[str]:
    properties = schema.get("properties")
    assert isinstance(properties, dict)
    for name, kind in properties.items():
        items = kind.get("items")
        inner = items if isinstance(items, dict) else kind
        many = " of " + inner["type"] if items else ""
        yield f"| `{prefix}{name}` | {kind['type']}{many} |"
        if inner.get("properties"):
            yield from _rows(f"{prefix}{name}.", inner)


def python() -> str:
    """The library: what `import gcs` gives, with docstrings."""
    lines = ["# Python", "", "```python", "import gcs", "```", ""]
    for name in ("connect", "aconnect", "columns"):
        lines += _directive("autofunction", name)
    for name in ("Station", "Operation", "AsyncStation", "AsyncOperation"):
        lines += _directive("autoclass", name, "   :members:", "   :inherited-members:")
    errors = sorted(name for name in gcs.__all__ if _is_error(name))
    lines += ["## Errors", ""]
    for name in ("GcsError", *(one for one in errors if one != "GcsError")):
        lines += _directive("autoexception", name, "   :show-inheritance:")
    return "\n".join(lines)


def _is_error(name: str) -> bool:
    value = getattr(gcs, name)
    return isinstance(value, type) and issubclass(value, Exception)


def _directive(kind: str, name: str, *options: str) -> list[str]:
    return ["```{eval-rst}", f".. {kind}:: gcs.{name}", *options, "```", ""]


_UPRIGHT = (1.0, 0.0, 0.0, 0.0)
_ORIGIN = (0.0, 0.0, 0.0)
_ITEMS: tuple[RecordItem, ...] = (
    PoseItem(1, _ORIGIN, _ORIGIN, _UPRIGHT),
    GeodeticItem(1, 47.0, 8.0, 490.0, 2.0),
    StatusItem(1, True, "HOLD", "IN_AIR", 90.0, 16.0, 30.0, 0.0),
    SetpointItem(1, _ORIGIN, None),
    StopItem(1, _ORIGIN, (1.0, 0.0, 0.0)),
    LegItem(1, (_ORIGIN, (1.0, 0.0, 0.0)), (1.0, 0.0)),
    ParamItem(1, "NAME", 1.0),
    FsaItem(1, "HOVERING", 1, "", "", "", "nominal", None),
    DecisionItem(1, 1, "", "goto", "verdict", "accepted", "", "", "", PointEnu(1, 2, 3), {}),
    DecisionItem(1, 1, "", "goto", "ending", "complete", "", "", "", None, {}),
    FenceItem([FenceShape("yard", True, [(0, 0), (1, 0), (1, 1)])], (47.0, 8.0, 488.0), 1.0, 1.0),
    MissionItem(1, "mission", (_ORIGIN,)),
    LogEvent(0, 2, "gate", "a line"),
    InputItem.of("tick", 1),
)
"""One of each kind, so that every topic is there."""
