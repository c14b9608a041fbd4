"""Reads what an operator types: a line, or a word with its arguments, becomes what it does."""

from __future__ import annotations

import difflib
import re
import shlex
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from gcs.operator.text.number_text import read_number
from gcs.request_words import (
    OTHER_NAMES,
    WORD_BY_NAME,
    WORDS,
    Action,
    ActsAtOnce,
    Argument,
    ArgumentKind,
    BadAskError,
    Word,
)


@dataclass(frozen=True, slots=True)
class Line:
    """One line that was understood.

    `wait` is False if it ended in `&`: the next line does not wait for its ending.  `marked` is
    True if it began with `!`: it does not wait for the line before it.
    """

    text: str
    action: Action
    wait: bool
    at_once: ActsAtOnce = ActsAtOnce.NEVER
    marked: bool = False

    def overtakes(self, *, typed: bool) -> bool:
        """Whether it acts at once; `typed`: on a terminal, not in a script."""
        match self.at_once:
            case ActsAtOnce.ALWAYS:
                return True
            case ActsAtOnce.TYPED:
                return typed or self.marked
            case ActsAtOnce.MARKED | ActsAtOnce.NEVER:
                return self.marked


class LineError(Exception):
    """A line that cannot be understood: what is wrong, and what would be right."""

    def __init__(self, sentence: str, hint: str) -> None:
        super().__init__(sentence)
        self.sentence = sentence
        self.hint = hint


def parse_line(text: str) -> Line | None:
    """One typed line; None for an empty one or a comment (`# ...`).  Raises LineError."""
    lexer = shlex.shlex(text, posix=True)
    lexer.whitespace_split = True
    lexer.escape = ""  # a Windows path keeps its backslashes
    try:
        tokens = list(lexer)
    except ValueError as error:
        raise LineError(f"cannot read the line: {error}", "check the quotes") from None
    marked = bool(tokens) and tokens[0].startswith("!")
    if marked:
        tokens[0] = tokens[0][1:]
        tokens = [token for token in tokens if token]
    wait = True
    if tokens and tokens[-1].endswith("&"):
        wait = False
        tokens[-1] = tokens[-1][:-1]
        tokens = [token for token in tokens if token]
    if not tokens:
        return None
    word, arguments = _find(tokens)
    if marked and word.at_once is ActsAtOnce.NEVER:
        others = [each.name for each in WORDS if each.at_once is not ActsAtOnce.NEVER]
        raise LineError(f"{word.name}: waits for its turn", f"! is for: {', '.join(others)}")
    action = parse_arguments(word, arguments)
    return Line(" ".join(tokens), action, wait, word.at_once, marked)


def parse_arguments(word: Word, typed: Sequence[str]) -> Action:
    """What `word` does with what was typed after it.  Raises LineError."""
    flags = {each.name for each in word.arguments if each.kind is ArgumentKind.FLAG}
    texts = [text for text in typed if text not in flags]
    if unknown := next(filter(_OPTION.fullmatch, texts), ""):
        raise _wrong(word, f"no option {unknown}")
    if "all" in texts and not word.arguments:
        of_all = ", ".join(each.name for each in WORDS if each.stops)
        raise LineError(f"{word.name}: is for one vehicle at a time", f"all is for: {of_all}")
    required = sum(not argument.optional for argument in word.arguments)
    if not required <= len(texts) <= len(word.arguments) - len(flags):
        raise _wrong(word, f"expected {_expectation(word)}, got {len(texts) or 'nothing'}")
    left = iter(texts)
    values: list[float | str | bool] = []
    for argument in word.arguments:
        if argument.name in flags:
            values.append(argument.name in typed)
        elif (text := next(left, None)) is not None:
            values.append(_value(word, argument, text))
    try:
        return word.action(*values)
    except BadAskError as error:
        raise _wrong(word, str(error)) from None


def _value(word: Word, argument: Argument, text: str) -> float | str | bool:
    match argument.kind:
        case ArgumentKind.NAME | ArgumentKind.FILE:
            return text
        case ArgumentKind.SWITCH:
            if text not in ("on", "off"):
                raise _wrong(word, f"expected on or off, got {text!r}")
            return text == "on"
        case ArgumentKind.COUNT:
            return int(_number(word, argument, text))
        case _:
            return _number(word, argument, text)


def _find(tokens: list[str]) -> tuple[Word, list[str]]:
    first = tokens[0].lower()  # ABORT is as good
    tokens = [OTHER_NAMES.get(first, first), *tokens[1:]]
    two = " ".join(tokens[:2])
    if two in WORD_BY_NAME:
        return WORD_BY_NAME[two], tokens[2:]
    if tokens[0] in WORD_BY_NAME:
        return WORD_BY_NAME[tokens[0]], tokens[1:]
    seconds = [name for name in WORD_BY_NAME if name.startswith(tokens[0] + " ")]
    if seconds:
        near = nearest(two, seconds)
        hint = f"did you mean {near}?" if near and len(tokens) > 1 else f"try {seconds[0]}"
        raise LineError(f"{tokens[0]}: expected one of: {', '.join(seconds)}", hint)
    near = nearest(tokens[0], {name.split()[0] for name in WORD_BY_NAME})
    hint = f"did you mean {near}?" if near else f"words: {', '.join(WORD_BY_NAME)}"
    raise LineError(f"{tokens[0]}: not a word of ours", hint)


def nearest(typed: str, known: Iterable[str]) -> str:
    """The word that may have been meant; empty if none is near."""
    near = difflib.get_close_matches(typed, list(known), n=1)
    return near[0] if near else ""


_OPTION = re.compile(r"--[A-Za-z].*|-[A-Za-z]")


def _number(word: Word, argument: Argument, text: str) -> float:
    wrong = f"{argument.name}: expected a {argument.kind.value}, got {text!r}"
    try:
        number = read_number(text)
    except ValueError:
        hint = " (the decimal mark is a point)" if "," in text else ""
        raise _wrong(word, wrong + hint) from None
    if argument.kind is ArgumentKind.SECONDS and number < 0:
        raise _wrong(word, wrong)
    if argument.kind is ArgumentKind.COUNT and not (number >= 0 and number.is_integer()):
        raise _wrong(word, wrong)
    if argument.kind is ArgumentKind.DEGREES and abs(number) > 360.0:
        raise _wrong(word, wrong)
    return number


def _expectation(word: Word) -> str:
    """`3 numbers EAST NORTH UP [YAW_DEG]`, `1 file FILE`, `no arguments`."""
    required = [argument for argument in word.arguments if not argument.optional]
    if not word.arguments:
        return "no arguments"
    if not required:
        return f"at most {word.usage}"
    kind = required[0].kind.value.split(",")[0]
    if required[0].kind is ArgumentKind.SWITCH:
        return kind
    return f"{len(required)} {kind}{'s' if len(required) > 1 else ''} {word.usage}"


def _wrong(word: Word, what: str) -> LineError:
    return LineError(f"{word.name}: {what}", f"for example: {word.example}")
