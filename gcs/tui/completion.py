"""What Tab makes of a line that is not finished: words, files, modes."""

from __future__ import annotations

import glob
import os
from collections.abc import Sequence
from dataclasses import dataclass

from gcs.protocol.autopilot import ARDUPILOT, PX4
from gcs.request_words import WORDS, Argument, ArgumentKind, Word


@dataclass(frozen=True, slots=True)
class Known:
    """What may be completed beside the words: mission files that are shipped, modes."""

    missions: tuple[str, ...] = ()
    modes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Completed:
    """The line as far as it is certain, and how it may go on."""

    text: str
    offers: tuple[str, ...]


def complete(text: str, known: Known) -> Completed:
    """As far as all that would fit agree; a space where nothing else fits."""
    text = text.lstrip()
    word = _word_of(text)
    if word is None:
        fitting = [each for each in WORDS if each.name.startswith(text.lower())]
        names = [each.name + (" " if each.arguments else "") for each in fitting]
        return _agreed("", text, names, [each.name for each in fitting])
    given = text[len(word.name) + 1 :].split(" ")
    if len(given) > len(word.arguments):
        return Completed(text, ())
    argument, begun = word.arguments[len(given) - 1], given[-1]
    offers = [each for each in _values(argument, word, begun, known) if each.startswith(begun)]
    before = text[: len(text) - len(begun)]
    longer = [each for each in WORDS if each.name.startswith(text.lower())]  # fence, fence put
    ends = [before + each for each in offers]
    ends += [each.name + (" " if each.arguments else "") for each in longer]
    return _agreed("", text, ends, [*offers, *(each.name for each in longer)])


def modes_of(vehicle: str) -> tuple[str, ...]:
    """The names of the modes of a vehicle as a snapshot calls it: `1/1 px4 quadrotor`."""
    return next(
        (
            tuple(mode.name for mode in autopilot.modes)
            for autopilot in (PX4, ARDUPILOT)
            if f" {autopilot.name} " in f"{vehicle} "
        ),
        (),
    )


def _word_of(text: str) -> Word | None:
    """The word whose arguments are being typed."""
    begun = [each for each in WORDS if text.lower().startswith(each.name + " ") and each.arguments]
    return max(begun, key=lambda each: len(each.name), default=None)


def _values(argument: Argument, word: Word, begun: str, known: Known) -> list[str]:
    match argument.kind:
        case ArgumentKind.FILE:
            return sorted({*_paths(begun), *known.missions})
        case ArgumentKind.NAME if word.name == "mode":
            return [*known.modes]
        case ArgumentKind.SWITCH:
            return ["on", "off"]
        case ArgumentKind.FLAG:
            return [argument.name]
        case _:
            return []


def _paths(begun: str) -> list[str]:
    """Files and folders that are there; a folder ends in a slash."""
    found = glob.glob(glob.escape(begun) + "*")
    return [each + os.sep if os.path.isdir(each) else each for each in found]


def _agreed(before: str, begun: str, ends: Sequence[str], offers: Sequence[str]) -> Completed:
    agreed = _common(ends) if ends else begun
    return Completed(before + (agreed if len(agreed) >= len(begun) else begun), tuple(offers))


def _common(ends: Sequence[str]) -> str:
    """What all begin with, letter by letter."""
    first, last = min(ends), max(ends)
    same = next((n for n, (a, b) in enumerate(zip(first, last, strict=False)) if a != b), None)
    return first[: min(len(first), len(last)) if same is None else same]
