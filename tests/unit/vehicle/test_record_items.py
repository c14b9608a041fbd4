"""What the record is told besides frames and decisions."""

from __future__ import annotations

import json
from typing import Any

import msgspec
import pytest

from gcs import ipc
from gcs.config import SimConfig, StationConfig
from gcs.gate.policy.parse import DEFAULT
from gcs.report import AttachmentItem, LogEvent
from gcs.session.effects import Record
from gcs.session.inputs import (
    ClientCame,
    ClientFlooded,
    ClientGone,
    DiskLow,
    FileRead,
    FileWritten,
    LinkEvent,
    OperatorGone,
    OperatorJoined,
    OperatorLine,
    OtherInput,
    RecorderChanged,
    RecorderGrew,
    SignalCame,
    SimGone,
    SimLine,
    Wake,
)
from gcs.session.setup import Setup
from gcs.session.work import Log, Work
from gcs.vehicle.record_items import Start, firmware, introduction, recorded, sim_line
from tests.unit.station import told


def item_of(given: OtherInput) -> Any:  # whatever the record keeps
    (item,) = told.recorded(recorded(given), "InputItem")
    return item


def as_json(item: Any) -> Any:
    return json.loads(bytes(item.data))


@pytest.mark.parametrize(
    ("given", "told_as"),
    [
        (Wake(), {}),
        (SignalCame("SIGTERM"), {"name": "SIGTERM"}),
        (OperatorGone(3, "lost"), {"client": 3, "reason": "lost"}),
        (
            OperatorJoined(3, "a test"),
            {"client": 3, "name": "a test", "hold_on_leave": True},
        ),
        (
            ClientCame(2, "udp 127.0.0.1:14551", False),
            {"link": 2, "name": "udp 127.0.0.1:14551", "stream": False, "verified": True},
        ),
        (ClientGone(2, "silent for 10 s"), {"link": 2, "reason": "silent for 10 s"}),
        (ClientFlooded(2, 900), {"link": 2, "dropped": 900}),
        (LinkEvent(1, "lost", True), {"link": 1, "text": "lost", "trouble": True}),
        (SimGone(3), {"exit_code": 3}),
        (SimLine("INFO sim: x"), {"text": "INFO sim: x"}),
        (FileWritten(1, "a", "full"), {"token": 1, "path": "a", "error": "full"}),
        (
            RecorderChanged(False, "a.mcap", "full"),
            {"recording": False, "path": "a.mcap", "text": "full"},
        ),
        (
            OperatorLine(1, ipc.Ask(1, "takeoff", up_m=2.0)),
            {"client": 1, "command": {"type": "ask", "id": 1, "word": "takeoff", "up_m": 2.0}},
        ),
        (RecorderGrew(1_000), {"size_bytes": 1_000}),
        (DiskLow(5, None, True), {"free_bytes": 5, "left_s": None, "critical": True}),
        (
            FileRead(1, "b/a.plan", b"12345"),
            {
                "token": 1,
                "path": "b/a.plan",
                "size": 5,
                "attachment": "read-5994471abb01112a-a.plan",
                "error": "",
            },
        ),
        (
            FileRead(1, "a", None, "gone"),
            {"token": 1, "path": "a", "size": -1, "attachment": "", "error": "gone"},
        ),
    ],
)
def test_every_input_is_kept_under_its_own_name(given: OtherInput, told_as: object) -> None:
    item = item_of(given)
    assert item.kind == type(given).__name__
    assert as_json(item) == told_as


def test_the_set_up_is_told_before_anything_else() -> None:
    config = StationConfig(sysid=254, speedup=2.0, sim=SimConfig(seed=42), command_line="gcs demo")
    setup = Setup(
        config,
        "1.2.3",
        DEFAULT,
        "name = 'x'",
        ("udpin://:1", "tcp:h:2"),
        "logs/a.mcap",
        frozenset({1}),
        frozenset({0}),
        "Python 3 on a machine",
    )
    effects = introduction(setup, 1_000)
    (values,) = told.recorded(effects, "MetadataItem")
    assert dict(values.values) == {
        "version": "1.2.3",
        "endpoints": "udpin://:1 tcp:h:2",
        "policy": "default",
        "station": "254/190",
        "speedup": "2",
        "seed": "42",
        "environment": "Python 3 on a machine",
        "command_line": "gcs demo",
    }
    (policy,) = told.recorded(effects, "AttachmentItem")
    assert policy.data == b"name = 'x'"
    assert (policy.name, policy.media_type) == ("policy.toml", "application/toml")
    (kept,) = told.recorded(effects, "InputItem")
    assert msgspec.json.decode(kept.data, type=Start) == Start(setup, 1_000)
    (hello,) = told.events(effects, ipc.Hello)
    assert hello.endpoints == ["udpin://:1", "tcp:h:2"]


def test_without_a_vehicle_of_our_own_there_is_no_seed() -> None:
    (values,) = told.recorded(
        introduction(Setup(StationConfig(), "1", DEFAULT, "", (), ""), 0), "MetadataItem"
    )
    assert dict(values.values)["seed"] == ""


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (17695743, "1.14.3"),  # data/autopilots/scenarios_px4.json: PX4 1.14.3
        (67567616, "4.7.0-dev"),  # scenarios_arducopter.json: ArduCopter 4.7.0-dev
        (0x010F00C0, "1.15.0-rc"),
        (0x01100000, "1.16.0-dev"),
    ],
)
def test_the_firmware_is_read_as_its_makers_write_it(number: int, text: str) -> None:
    assert firmware(number) == text


@pytest.mark.parametrize(
    ("path", "name", "media_type"),
    [
        ("/home/me/fields/north.plan", "north.plan", "application/json"),
        ("missions/demo.toml", "demo.toml", "application/toml"),
        ("x.WAYPOINTS", "x.WAYPOINTS", "text/plain"),
        ("odd", "odd", "application/octet-stream"),
    ],
)
def test_an_attachment_has_its_own_name_and_kind(path: str, name: str, media_type: str) -> None:
    item = AttachmentItem.of_file(path, b"x")
    assert (item.name, item.media_type, item.data) == (name, media_type, b"x")


def work_of(line: str) -> Work:
    return sim_line(line, 1_000)


@pytest.mark.parametrize(
    ("line", "level", "node", "text"),
    [
        ("WARNING world: gusts: 5 m/s", 3, "sim.world", "gusts: 5 m/s"),
        ("ERROR sim: no port", 4, "sim.sim", "no port"),
        ("Traceback (most recent call last):", 2, "sim", "Traceback (most recent call last):"),
        ("INFO without a node", 2, "sim", "INFO without a node"),
        ("LOUD node: text", 2, "sim", "LOUD node: text"),
        ("", 2, "sim", ""),
    ],
)
def test_a_line_of_our_own_vehicle_s_process_is_logged_for_what_it_is(
    line: str, level: int, node: str, text: str
) -> None:
    work = work_of(line)
    assert isinstance(work, Log)
    assert (work.level, work.node, work.text) == (level, node, text)


def test_what_the_vehicle_says_itself_is_not_shown_twice_and_is_kept() -> None:
    work = work_of("ERROR vehicle 1: no GPS")
    assert isinstance(work, Record)
    assert isinstance(work.item, LogEvent)
    assert work.item.level == 1  # below what a viewer shows: the vehicle said it itself
    assert "no GPS" in repr(work.item)
    assert "sim.vehicle 1" in repr(work.item)
