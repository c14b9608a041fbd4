"""TOML into typed values: what fits comes out, what does not is told with its line."""

from __future__ import annotations

from typing import Annotated, Literal

import pytest
from msgspec import Meta, Struct

from gcs.toml import TomlError, decode, read

Length = Annotated[float, Meta(ge=0.0, le=100.0)]
Text = Annotated[str, Meta(pattern=r"\S")]


class Leg(Struct, frozen=True, forbid_unknown_fields=True):
    to_m: tuple[Length, Length]
    wait_s: Length = 1.5


class Trip(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    name: Text
    mode: Literal["walk", "fly"] = "walk"
    back: bool = False
    most_m: Length | None = None
    legs: Annotated[tuple[Leg, ...], Meta(min_length=1)]
    way: tuple[tuple[Length, Length], ...] = ()
    notes: dict[str, Length] = {}


GOOD = """\
name = "home"
most_m = 5
[notes]
far = 3
[[legs]]
to_m = [1, 2.5]
[[legs]]
to_m = [0, 0]
wait_s = 2
"""


def trip(text: str) -> Trip:
    doc = read(text, "trip.toml")
    return doc.convert(Trip, doc.data)


def error(text: str) -> TomlError:
    with pytest.raises(TomlError) as caught:
        trip(text)
    return caught.value


def test_whole_numbers_are_numbers_and_what_is_left_out_has_its_default() -> None:
    assert trip(GOOD) == Trip(
        name="home",
        most_m=5.0,
        legs=(Leg((1.0, 2.5)), Leg((0.0, 0.0), 2.0)),
        notes={"far": 3.0},
    )


@pytest.mark.parametrize(
    ("old", "new", "line", "key", "what", "hint"),
    [
        ('"home"', "3", 1, "name", "3 is not a text", "write it in quotes"),
        ('"home"', '" "', 1, "name", '" " is not a text', "write it in quotes"),
        ("name", "nam", 1, "name", "is missing", "`nam` is unknown here: did you mean name?"),
        ('name = "home"\n', "", 1, "name", "is missing", 'name = "..."'),
        ("= 5", "= true", 2, "most_m", "true is not a number", ""),
        ("= 5", "= nan", 2, "most_m", "nan is not finite", "between 0 and 100"),
        ("= 5", "= -inf", 2, "most_m", "-inf is not finite", "between 0 and 100"),
        ("= 5", "= 101", 2, "most_m", "101 is impossible", "between 0 and 100"),
        ("= 5", "= -1e-9", 2, "most_m", "-1e-09 is impossible", "between 0 and 100"),
        ("= 5", f"= {10**400}", 2, "most_m", "the number is too large", "between 0 and 100"),
        ("= 5", "= 1979-05-27", 2, "most_m", "1979-05-27 is not a number", "write it"),
        ("= 5", "= {a = 1}", 2, "most_m", "{'a': 1} is not a number", "write it"),
        ("far = 3", 'far = "x"', 4, "notes.far", '"x" is not a number', "write it"),
        ("[notes]\nfar = 3", "notes = 1", 3, "notes", "is a table", "write it as [notes]"),
        ("[1, 2.5]", "[1]", 6, "legs[1].to_m", "[1] is not a pair of numbers", "such as [-5, 5]"),
        ("[0, 0]", "[0, -1]", 8, "legs[2].to_m", "-1 is impossible", "between 0 and 100"),
        ("wait_s", "wait", 9, "legs[2].wait", "unknown key", "did you mean wait_s?"),
        ("wait_s", "x", 9, "legs[2].x", "unknown key", "known here: to_m, wait_s"),
        ("most_m = 5", "back = 1", 2, "back", "1 is neither true nor false", ""),
        ("most_m = 5", 'mode = "fyl"', 2, "mode", '"fyl" is none of: walk, fly', "mean fly?"),
        ("most_m = 5", "mode = 1", 2, "mode", "1 is none of: walk, fly", ""),
        ("most_m = 5", "way = 1", 2, "way", "1 is not a list of pairs", "such as [[0, 0]"),
        ("most_m = 5", "way = [[1, 2], 3]", 2, "way[2]", "3 is not a pair of numbers", "such as"),
    ],
)
def test_what_does_not_fit_is_told(
    old: str, new: str, line: int, key: str, what: str, hint: str
) -> None:
    found = error(GOOD.replace(old, new, 1))
    assert (found.line, found.key, found.what) == (line, key, what)
    assert hint in found.hint
    assert str(found) == f"trip.toml:{line}: {key}: {what}"


@pytest.mark.parametrize(
    ("legs", "what", "hint"),
    [
        ("", "is missing", "write at least one [[legs]]"),
        ("legs = []", "has 0 entries, which is too few", ""),
        ("legs = 3", "is a list of tables", "write each as [[legs]]"),
        ("[legs]\nto_m = [0, 0]", "is a list of tables", "write each as [[legs]]"),
    ],
)
def test_an_array_of_tables_is_asked_for_as_one(legs: str, what: str, hint: str) -> None:
    found = error(f'name = "x"\n{legs}')
    assert (found.key, found.what, found.hint) == ("legs", what, hint)


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ("a = 1\nb = = 2", 2, "not TOML: Invalid value"),
        ("a = [1,\n2", 2, "not TOML: Unclosed array"),
        (f"a = {'9' * 5000}", 0, "not TOML that can be read"),
        (f"a = {'[' * 5000}{']' * 5000}", 0, "not TOML that can be read"),
    ],
)
def test_what_is_no_toml_is_told(text: str, line: int, what: str) -> None:
    found = error(text)
    assert found.line == line
    assert found.what.startswith(what)
    assert str(found).startswith(f"trip.toml:{line}: not TOML" if line else "trip.toml: not TOML")


def test_bytes_that_are_no_text_are_told_with_their_line() -> None:
    with pytest.raises(TomlError, match="is not UTF-8") as caught:
        decode(b'a = 1\nb = "\xff"', "trip.toml")
    assert caught.value.line == 2
    assert decode(b"\xef\xbb\xbfa = 1", "trip.toml") == "a = 1"


def test_a_key_that_has_no_line_of_its_own_is_told_with_that_of_its_table() -> None:
    doc = read("a = 1\n[part]\nsize = {x = 1}\n[[row]]\nc = 2", "trip.toml")
    assert doc.line(("part", "size", "x")) == 3
    assert doc.line(("part", "colour")) == 2
    assert doc.line(("row", 0, "d")) == 4
    assert doc.line(("nothing",)) == 1


def test_what_the_file_says_itself_is_known() -> None:
    doc = read("a = 1\n[part]\nsize = 2", "trip.toml")
    assert doc.has(("part", "size"))
    assert not doc.has(("part", "a"))
    assert not doc.has(("a", "size"))
