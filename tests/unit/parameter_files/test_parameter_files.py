"""Files of parameters: each format read, written, and what is wrong with one by its line."""

from __future__ import annotations

import pytest

from gcs.parameter_files.described import described, lines_of
from gcs.parameter_files.model import Entry, ParameterFileError, differences
from gcs.parameter_files.reader import read
from gcs.parameter_files.writer import FORMATS, format_of, write
from tests.sample_files import elsewhere

MAVPROXY = b"# saved\r\nRTL_ALT 1500\r\nWP_ACC          2.5 # m/s/s\r\n\r\n"
MISSION_PLANNER = b"\xef\xbb\xbf#NOTE: 1.2\nRTL_ALT,1500\nWP_ACC,2.50\n"
QGC = b"# Onboard parameters\n1\t1\tRTL_ALT\t1500\t6\n1\t1\tWP_ACC\t2.5\t9\n"


@pytest.mark.parametrize("data", [MAVPROXY, MISSION_PLANNER, QGC])
def test_three_formats_are_one_model(data: bytes) -> None:
    found = read("a", data)
    assert {name: each.value for name, each in found.items()} == {"RTL_ALT": 1500, "WP_ACC": 2.5}


@pytest.mark.parametrize("form", FORMATS)
def test_there_and_back(form: str) -> None:
    entries = {e.name: e for e in (Entry("A", 0.1, "real32"), Entry("B_2", -3, "int8"))}
    back = read("a", write(form, entries.values(), 1).encode())
    assert differences(entries, back) == []
    if form == "qgc":
        assert [each.kind for each in back.values()] == ["real32", "int8"]


def test_the_suffix_says_whose_format_it_is() -> None:
    names = ("a.parm", "b.PARAM", "c.params", "d.txt")
    assert [format_of(name) for name in names] == [*FORMATS, ""]


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"A 1\nB\n", "f:2: 1 fields, not 2 or 5"),
        (b"A 1\nB,2\n", "f:2: 'B,2': not as the lines before it"),
        (b"A 1\nA 2\n", "f:2: A: it is in line 1 already"),
        (b"A one\n", "f:1: A: 'one' is not a number"),
        (b"A 1,5\n", "f:1: A: '1,5' is not a number"),
        (b"A-B 1\n", "f:1: 'A-B': no name of a parameter"),
        (b"A23456789_1234567 1\n", "no name of a parameter"),
        (b"1\t1\tA\t1.5\t6\n", "f:1: A: '1.5' is not a whole number (int32)"),
        (b"1\t1\tA\t1\t11\n", "f:1: A: '11' is no MAV_PARAM_TYPE"),
        (b"A 1\n\xff\n", "f:2: not UTF-8 text"),
        (b"# nothing\n", "f: holds no parameters"),
    ],
)
def test_what_is_wrong_is_told_by_its_line(data: bytes, said: str) -> None:
    with pytest.raises(ParameterFileError) as wrong:
        read("f", data)
    assert said in str(wrong.value)


def test_a_recorded_list_there_and_back() -> None:
    path = elsewhere("params", "arducopter_sitl.parm")
    found = read(str(path), path.read_bytes())
    assert len(found) == 1369
    for form in FORMATS:
        assert differences(found, read("b", write(form, found.values(), 1).encode())) == []


def test_what_differs() -> None:
    one = {e.name: e for e in (Entry("A", 0.1), Entry("B", 1), Entry("C", 1))}
    other = {e.name: e for e in (Entry("A", 0.10000000149011612), Entry("B", 2), Entry("D", 1))}
    found = [(d.name, d.a and d.a.value, d.b and d.b.value) for d in differences(one, other)]
    assert found == [("B", 1, 2), ("C", 1, None), ("D", None, 1)]


def test_what_an_autopilot_says_of_its_parameters() -> None:
    """By PX4's parameter.schema.json."""
    text = b"""{"version":1,"parameters":[{"name":"NAV_DLL_ACT","type":"Int32","shortDesc":"Loss",
        "longDesc":"What\\nfollows.","units":"s","min":0,"max":3,"default":0,"group":"Mission",
        "rebootRequired":true,"values":[{"value":0,"description":"Disabled"}]}]}"""
    assert lines_of(described("a.json", text)["NAV_DLL_ACT"]) == [
        "Loss", "", "What", "follows.", "unit: s", "minimum: 0", "maximum: 3", "default: 0",
        "  0: Disabled", "takes effect after a restart",
    ]  # fmt: skip
    with pytest.raises(ValueError, match=r"a\.json"):
        described("a.json", b"[]")
    with pytest.raises(ValueError, match=r"a\.json\.xz"):
        described("a.json.xz", b"no xz")
