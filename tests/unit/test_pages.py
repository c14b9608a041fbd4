"""What the pages name is there: files, modules, links, words of the code, commands."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from gcs.cli.main import COMMANDS

ROOT = Path(__file__).parents[2]
PAGES = [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("missions/**/*.md")]
ABOUT_THE_CODE = ("ARCHITECTURE.md", "CONTRIBUTING.md", "decisions.md")
MADE_BY_A_READER = {"PID.json", "results.json", "layout.json", "lab.json", "mavgate.toml"}
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


def missing(page: Path) -> list[str]:
    text = page.read_text(encoding="utf-8")
    links = re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text)
    prose = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    spans = re.findall(r"`([^`\n]+)`", prose)
    about_the_code = page.name in ABOUT_THE_CODE
    return [
        *(link for link in links if not (page.parent / link).exists()),
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
