"""Every command there is, by a walk through them all: its help has an example that click takes, and
what its --json prints is a row of docs/json.md."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path

import click
import pytest

from gcs.cli.main import gcs as program
from tests.unit.cli.command_line import gcs
from tests.unit.test_pages import ROOT, why_not


def walked(command: click.Command, words: tuple[str, ...]) -> Iterator[tuple[str, click.Command]]:
    """What can be typed: commands, and groups that do something by themselves."""
    if isinstance(command, click.Group):
        context = click.Context(command)
        for name in command.list_commands(context):
            below = command.get_command(context, name)
            assert below is not None
            yield from walked(below, (*words, name))
        if not command.invoke_without_command:
            return
    yield " ".join(words), command


COMMANDS = dict(walked(program, ("gcs",)))
ROWS = re.findall(
    r"^\| (`gcs [^|]*`) \| (?:an? \w+|a line each) \| ([^|]+) \|$",
    (ROOT / "docs" / "json.md").read_text(encoding="utf-8"),
    re.MULTILINE,
)


def examples(command: click.Command) -> list[str]:
    """The lines after `Example:`, as they are typed; two blanks come before what they do."""
    text = f"{command.help or ''}\n\n{command.epilog or ''}".replace("\b", "")
    blocks = re.findall(r"Examples?:\s+(.*?)(?:\n\n|\Z)", text, re.DOTALL)
    lines = (line.strip() for block in blocks for line in re.split(r"\n|  \|  ", block))
    return [re.split(r"\s{2,}", line)[0] for line in lines if line.startswith("gcs ")]


def test_every_command_has_an_example_that_click_takes() -> None:
    wrong = {}
    for name, command in COMMANDS.items():
        given = examples(command)
        ours = [line for line in given if f"{line} ".startswith(f"{name} ")]
        told = [f"{line}: {why}" for line in given if (why := why_not(line))]
        if told or not ours:
            wrong[name] = told or given
    assert wrong == {}


def fields_of() -> dict[str, str]:
    """Of each command that has a row: `gcs mission upload` `download` are two."""
    rows: dict[str, str] = {}
    for names, fields in ROWS:
        first, *others = re.findall(r"`([^`]+)`", names)
        before = first.rpartition(" ")[0]
        rows |= dict.fromkeys((first, *(f"{before} {other}" for other in others)), fields)
    return rows


def test_what_json_prints_of_each_command_is_a_row_of_the_page() -> None:
    has_json = {
        name
        for name, command in COMMANDS.items()
        if any("--json" in option.opts for option in command.params)
    }
    assert set(fields_of()) == has_json


def test_what_needs_no_vehicle_prints_the_fields_that_the_page_names(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    typed = {
        "mission check": ("demo",),
        "mission show": ("demo",),
        "mission convert": ("demo", "-o", "demo.plan", "--home", "47.397742,8.545594,488"),
        "mission new survey": ("lab3/square", "-o", "a.plan", "--footprint", "4x3", "--height", 3),
        "fence check": ("fence",),
        "fence show": ("fence",),
        "rally check": ("rally",),
        "rally show": ("rally",),
        "config show": (),
    }
    told, named = {}, {}
    for name, words in typed.items():
        told[name] = list(json.loads(gcs(*name.split(), *words, "--json").output))
        named[name] = fields_of()[f"gcs {name}"].split()
    assert told == named
