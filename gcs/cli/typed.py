"""Operator words read from text: a line or a list of arguments becomes what it asks for."""

from __future__ import annotations

import difflib
import math
import shlex
from collections.abc import Sequence
from dataclasses import dataclass, replace

from gcs.cli.words import BY_NAME, Action, Kind, Param, Values, Word


@dataclass(frozen=True, slots=True)
class Line:
    """One line that was understood.  `wait` is False where it ended in `&`."""

    text: str
    action: Action
    wait: bool


class WordError(Exception):
    """A line that cannot be understood: what is wrong, and what would be right."""

    def __init__(self, sentence: str, hint: str) -> None:
        super().__init__(sentence)
        self.sentence = sentence
        self.hint = hint


def parse_line(text: str) -> Line | None:
    """One typed line; None for an empty one or a comment (`# ...`).  Raises WordError."""
    lexer = shlex.shlex(text, posix=True)
    lexer.whitespace_split = True
    lexer.escape = ""  # a Windows path keeps its backslashes
    try:
        tokens = list(lexer)
    except ValueError as error:
        raise WordError(f"cannot read the line: {error}", "check the quotes") from None
    wait = True
    if tokens and tokens[-1].endswith("&"):
        wait = False
        tokens[-1] = tokens[-1][:-1]
        tokens = [token for token in tokens if token]
    if not tokens:
        return None
    word, arguments = _find(tokens)
    return Line(" ".join(tokens), parse_arguments(word, arguments), wait)


def parse_arguments(word: Word, arguments: Sequence[str], *, finite: bool = False) -> Action:
    """What `word` means with these arguments.  Raises WordError.

    `finite`: refuse nan and inf here already, where nothing must be started for them.
    """
    required = sum(not param.optional for param in word.params)
    if not required <= len(arguments) <= len(word.params):
        raise _wrong(word, f"expected {_expectation(word)}, got {len(arguments) or 'nothing'}")
    numbers: list[float] = []
    text, switch, flagged = "", True, False
    for param, argument in zip(word.params, arguments, strict=False):
        match param.kind:
            case Kind.NUMBER | Kind.FINITE | Kind.SECONDS:
                plain = finite and param.kind is Kind.NUMBER
                kind = Kind.FINITE if plain else param.kind
                numbers.append(_number(word, replace(param, kind=kind), argument))
            case Kind.NAME | Kind.FILE:
                text = argument
            case Kind.SWITCH:
                if argument not in ("on", "off"):
                    raise _wrong(word, f"expected on or off, got {argument!r}")
                switch = argument == "on"
            case Kind.FLAG:
                if argument != param.name:
                    raise _wrong(word, f"expected {param.name} or nothing, got {argument!r}")
                flagged = True
    return word.build(Values(tuple(numbers), text, switch, flagged))


def _find(tokens: list[str]) -> tuple[Word, list[str]]:
    two = " ".join(tokens[:2])
    if two in BY_NAME:
        return BY_NAME[two], tokens[2:]
    if tokens[0] in BY_NAME:
        return BY_NAME[tokens[0]], tokens[1:]
    seconds = [name for name in BY_NAME if name.startswith(tokens[0] + " ")]
    if seconds:
        raise WordError(f"{tokens[0]}: expected one of: {', '.join(seconds)}", f"try {seconds[0]}")
    near = difflib.get_close_matches(tokens[0], BY_NAME, n=1)
    hint = f"did you mean {near[0]}?" if near else f"words: {', '.join(BY_NAME)}"
    raise WordError(f"{tokens[0]}: not a word of ours", hint)


def _number(word: Word, param: Param, argument: str) -> float:
    try:
        number = float(argument)
    except ValueError:
        comma = "," in argument
        raise _wrong(
            word,
            f"{param.name}: expected a {param.kind.value}, got {argument!r}"
            + (" (the decimal mark is a point)" if comma else ""),
        ) from None
    unfit = (param.kind is not Kind.NUMBER and not math.isfinite(number)) or (
        param.kind is Kind.SECONDS and number < 0
    )
    if unfit:
        raise _wrong(word, f"{param.name}: expected a {param.kind.value}, got {argument!r}")
    return number


def _expectation(word: Word) -> str:
    """`3 numbers EAST NORTH UP [YAW_DEG]`, `1 file FILE`, `no arguments`."""
    required = [param for param in word.params if not param.optional]
    if not word.params:
        return "no arguments"
    if not required:
        return f"at most {word.usage}"
    kind = required[0].kind.value.split(",")[0]
    if required[0].kind is Kind.SWITCH:
        return kind
    return f"{len(required)} {kind}{'s' if len(required) > 1 else ''} {word.usage}"


def _wrong(word: Word, what: str) -> WordError:
    return WordError(f"{word.name}: {what}", f"for example: {word.example}")
