"""What the pages name is there: files, modules, links, words of the code, commands and options."""

from __future__ import annotations

import re
import shlex
from itertools import takewhile
from pathlib import Path

import click
import pytest

from gcs.cli.main import COMMANDS
from gcs.cli.main import gcs as gcs_command
from gcs.exit_codes import ExitCode
from gcs.gate.condition import Condition
from gcs.gate.machine.memory import Goal, Memory
from gcs.gate.machine.sentences import REFUSED, refusal_of
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.refusal import Code
from gcs.gate.requests import TakePhoto
from gcs.gate.states import State
from gcs.operator.errors import ExitError

ROOT = Path(__file__).parents[2]
PAGES = [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("missions/**/*.md")]
ABOUT_THE_CODE = ("ARCHITECTURE.md", "CONTRIBUTING.md", "decisions.md")
MADE_BY_A_READER = {
    *("PID.json", "results.json", "layout.json", "lab.json"),
    *("mavgate.toml", "ask.py", "wind.toml"),
}
NOT_OURS = {"grep"}

SOURCES = [
    path
    for room in ("gcs", "vehicle_sim", "tests", "docs", "missions", "tools", "logs")
    for path in (ROOT / room).rglob("*.*")
    if path.suffix not in (".pyc", ".mcap")
]
FILES = {path.relative_to(ROOT).as_posix() for path in (*SOURCES, *ROOT.glob("*.*"))}
WORDS = {
    word
    for path in (*SOURCES, ROOT / "pyproject.toml", ROOT / "Makefile")
    if path.suffix in (".py", ".toml", "") or path.name == "Makefile"
    for word in re.findall(r"\w+", path.read_text(encoding="utf-8"))
}
TARGETS = set(re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
GCS_WORDS = {name for section in COMMANDS.values() for name in section} | {"help"}


def is_file(name: str) -> bool:
    """`guards.py` beside something that was named is a file of that name somewhere."""
    return any(file == name or file.endswith(f"/{name}") for file in FILES)


def headings(linked: Path, page: Path) -> set[str]:
    """What a link may lead to within a page; a link without a file is to the page itself."""
    target = linked if linked.suffix == ".md" else page
    lines = re.findall(r"^#+ (.*)$", target.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", line.lower()).replace(" ", "-") for line in lines}


def missing(page: Path) -> list[str]:
    text = page.read_text(encoding="utf-8")
    links = re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text)
    anchors = re.findall(r"\]\(([^)#:]*)#([^)]*)\)", text)
    prose = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    spans = re.findall(r"`([^`\n]+)`", prose)
    about_the_code = page.name in ABOUT_THE_CODE
    return [
        *(link for link in links if not (page.parent / link).exists()),
        *(anchor for link, anchor in anchors if anchor not in headings(page.parent / link, page)),
        *(line for line in (*text.split("\n"), *spans) if is_no_command(line)),
        *(
            token
            for span in spans
            for token in re.split(r"[ ,;]", span)
            if is_wrong(token, about_the_code)
        ),
    ]


def is_no_command(line: str) -> bool:
    """`gcs WORD ...` or `make WORD`, as a line of its own or as a piece of code."""
    found = re.match(r"(gcs|make) ([a-z][a-z-]*)\b", line)
    return found is not None and found[2] not in {"gcs": GCS_WORDS, "make": TARGETS}[found[1]]


def is_wrong(token: str, about_the_code: bool) -> bool:
    if re.fullmatch(r"[\w./-]+\.(py|toml|md|json|jsonl|text)", token):
        return Path(token).name not in MADE_BY_A_READER and not is_file(token)
    if re.fullmatch(r"(gcs|vehicle_sim|tests|docs|tools)/[\w/]+", token):
        return not (ROOT / token).is_dir()
    if re.fullmatch(r"(tests|tools)(\.\w+)+", token):
        place = ROOT / token.replace(".", "/")
        return not (place.is_dir() or place.with_suffix(".py").exists())
    if about_the_code and re.fullmatch(r"[A-Za-z_][\w.()]*", token):
        return not set(re.findall(r"\w+", token)) <= WORDS | NOT_OURS
    return False


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_what_a_page_names_is_there(page: Path) -> None:
    assert missing(page) == []


def commands_of(page: Path) -> list[str]:
    """Lines of a shell that begin with `gcs`."""
    blocks = re.findall(r"```sh\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    lines = (line.partition(" #")[0] for block in blocks for line in block.splitlines())
    return [line.strip() for line in lines if line.startswith("gcs ")]


def why_not(line: str) -> str | None:
    """What click says of it; files, ports and names of one's own need not be there."""
    command: click.Command = gcs_command
    context = click.Context(gcs_command)
    split = shlex.shlex(line, posix=True, punctuation_chars=True)
    split.whitespace_split = True
    words = list(takewhile(lambda word: not set(word) <= set("|>&;"), split))[1:]
    while isinstance(command, click.Group) and words and not words[0].startswith("-"):
        found = command.get_command(context, words.pop(0))
        if found is None:
            return "no such command"
        command = found
    try:
        command.make_context("gcs", words, parent=context, resilient_parsing="--help" in words)
    except click.UsageError as wrong:
        return None if re.search("does not exist|no such .* file", str(wrong)) else str(wrong)
    except ExitError as wrong:
        return None if wrong.exit_code == ExitCode.BAD_FILE else str(wrong)
    return None


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_the_commands_of_a_page_are_as_click_knows_them(page: Path) -> None:
    wrong = {line: why for line in commands_of(page) if (why := why_not(line))}
    assert wrong == {}


def test_a_command_with_an_option_that_is_not_there_is_found() -> None:
    assert why_not("gcs fly --nonsense") is not None
    assert why_not("gcs mission chek x.plan") is not None


def test_every_code_condition_and_exit_code_is_explained() -> None:
    text = (ROOT / "docs" / "troubleshooting.md").read_text(encoding="utf-8")
    codes, conditions, exits = (part.split("\n## ")[0] for part in text.split("\n## ")[1:4])
    assert set(re.findall(r"^\| ([A-Z_]+) \|", codes, re.MULTILINE)) == {*Code, "BAD_REQUEST"}
    assert set(re.findall(r"^\| `(\w+)` \|", conditions, re.MULTILINE)) == set(Condition)
    assert {int(n) for n in re.findall(r"^\| (\d+) \|", exits, re.MULTILINE)} == set(ExitCode)


def test_the_codes_that_the_page_says_have_no_numbers_are_those_of_the_gate_s_states() -> None:
    """Where the state alone is the reason; a flight goes on, so that there is something to tell."""
    text = (ROOT / "docs" / "troubleshooting.md").read_text(encoding="utf-8")
    named = text.partition("`numbers` is empty: ")[2].partition(". The state")[0]
    without = set(re.findall(r"[A-Z_]+", named))
    memory = Memory("px4", State.MOVING, goal=Goal((1.0, 2.0, -3.0), None, ()), pos_ned=(0, 0, 0))
    memory.pos_ns = 0
    told = {code: refusal_of(code, TakePhoto(), memory, DEFAULT, 10**10) for code in REFUSED}
    elsewhere = {Code.POLICY, Code.UNSUPPORTED, Code.RTL_BLOCKED, Code.CANNOT_STOP}
    by_state = {code for code, refusal in told.items() if not refusal.numbers} - elsewhere
    assert without - {Code.NOT_ARMED} == by_state - {Code.OTHER_OPERATOR}


def test_the_policy_of_the_page_is_one() -> None:
    text = (ROOT / "docs" / "policy.md").read_text(encoding="utf-8")
    _, _, rest = text.partition("<!-- example: yard.toml -->\n```toml\n")
    policy = parse_policy(rest.partition("```")[0], "yard.toml")
    assert [zone.name for zone in policy.fence] == ["yard", "mast"]
