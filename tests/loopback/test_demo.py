"""The demo's script, flown whole on a virtual clock, and its record as a viewer opens it."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from gcs import ipc
from gcs.cli.demo.script import FAILSAFES_ON, MISSION, SCRIPT, Step
from gcs.operator.line_parser import parse_line
from gcs.policy_file import load_policy
from gcs.record.viewer.layout import PURPOSES, Purpose, layout_for
from gcs.record.viewer.live_layout import live_layout
from gcs.record.writer import Recorder
from gcs.report import AttachmentItem, FsaItem, LegItem, MetadataItem, StopItem
from gcs.request_words import SendRequests
from gcs.resources import find
from gcs.session.inputs import OperatorLine
from tests.loopback.flight import PERSONALITIES, Flight, Personality
from tests.loopback.observed import START_NS

MOST_HZ = 60.0
"""Above it a viewer warns of a topic."""


def flown(personality: Personality) -> tuple[Flight, list[tuple[Step, str]]]:
    """The script, each step with what it came to."""
    policy, _ = load_policy("demo")
    params = dict(FAILSAFES_ON[personality])
    flight = Flight(personality, policy=policy, params=params).connected()
    asks: list[tuple[Step, int]] = []
    for step in SCRIPT:
        if step.say:
            for _, ask in asks:
                flight.done(ask)
        ask = _ask(flight, step)
        asks.append((step, ask))
        if step.wait:
            flight.done(ask)
        flight.run(step.pause_s)
    return flight, [(step, flight.done(ask)) for step, ask in asks]


def _ask(flight: Flight, step: Step) -> int:
    line = parse_line(step.line.format(mission=find(MISSION)))
    assert line is not None
    assert isinstance(line.action, SendRequests)
    (given,) = line.action.requests
    return flight.say(
        given.word, goal_enu=given.goal_enu, up_m=given.up_m, on=given.on, path=given.path
    )


@pytest.fixture(scope="module", params=PERSONALITIES)
def demo(request: pytest.FixtureRequest) -> tuple[Flight, list[tuple[Step, str]]]:
    return flown(request.param)


@pytest.fixture(scope="module")
def path(demo: tuple[Flight, object], tmp_path_factory: pytest.TempPathFactory) -> Path:
    flight, _ = demo
    recorder = Recorder.open(tmp_path_factory.mktemp("logs"), "demo", "20260101-000000", START_NS)
    for time_ns, item in flight.records:
        recorder.write(item, time_ns)
        recorder.tick(time_ns)
    assert recorder.close(flight.now_ns)
    return recorder.path


def json_messages(path: Path, topic: str) -> list[tuple[int, dict[str, Any]]]:
    with path.open("rb") as file:
        found = make_reader(file).iter_messages(topics=[topic])
        return [(message.log_time, json.loads(message.data)) for _, _, message in found]


def test_it_goes_as_scripted_in_less_than_a_minute_and_a_quarter(
    demo: tuple[Flight, list[tuple[Step, str]]],
) -> None:
    flight, steps = demo
    assert [(step.line, came_to) for step, came_to in steps] == [
        (step.line, step.expect) for step, _ in steps
    ]
    # The program beside it: start of two processes, position, leaving.
    assert (flight.now_ns - START_NS) / 1e9 < 70.0


def test_nothing_is_wrong_from_beginning_to_end(demo: tuple[Flight, object]) -> None:
    flight, _ = demo
    told = [item for _, item in flight.records if isinstance(item, FsaItem)]
    assert {(item.severity, item.conditions) for item in told} == {("NOMINAL", ())}


def test_the_record_says_which_vehicle_and_firmware_this_was(demo: tuple[Flight, object]) -> None:
    flight, _ = demo
    (vehicle, *_) = [
        dict(item.values)
        for _, item in flight.records
        if isinstance(item, MetadataItem) and item.name == "vehicle"
    ]
    assert re.fullmatch(r"\d+\.\d+\.\d+(-\w+)?", vehicle["firmware"])
    assert vehicle["vehicle"].startswith(f"1/1 {flight.personality}")


def test_what_the_flight_stood_on_is_attached(demo: tuple[Flight, object]) -> None:
    flight, _ = demo
    flight.feed(OperatorLine(1, ipc.Leave("the test is over")))
    flight.run(4.0)
    kept = {i.name: i for _, i in flight.records if isinstance(i, AttachmentItem)}
    named = {name for name in kept if not name.startswith("read-")}  # those are the audit's
    assert named == {"policy.toml", MISSION, "fence.json", "parameters.json"}
    zones = json.loads(kept["fence.json"].data)
    assert [zone["name"] for zone in zones] == ["yard", "mast"]
    known = json.loads(kept["parameters.json"].data)
    assert known.items() >= FAILSAFES_ON[flight.personality].items()


def test_a_refusal_and_a_hold_are_long_enough_to_be_seen(path: Path) -> None:
    phases = json_messages(path, "/vehicle/1/phase")
    states: list[tuple[str, int]] = []
    for at_ns, phase in phases:
        if not states or states[-1][0] != phase["state"]:
            states.append((phase["state"], at_ns))
    lasts_s = {
        (name, number): (states[number + 1][1] - at_ns) / 1e9
        for number, (name, at_ns) in enumerate(states[:-1])
    }
    holds = [seconds for (name, _), seconds in lasts_s.items() if name == "HOLDING"]
    assert len(holds) == 1  # the abort; nothing is braked
    assert min(holds) > 1.0
    assert {"TAKING_OFF", "MOVING", "TAKING_PICTURE", "FLYING_MISSION", "LANDING"} <= {
        name for name, _ in states
    }
    decisions = json_messages(path, "/gate/decision")
    refused_ns = [at_ns for at_ns, one in decisions if one["outcome"] == "refused"]
    quiet = 0
    for at_ns in refused_ns:
        later = [other_ns for other_ns, _ in decisions if other_ns > at_ns]
        quiet += min(later) - at_ns > 1.4e9
    assert quiet >= 2


def test_the_speed_drawn_along_a_leg_is_the_one_that_the_gate_allows_there(
    demo: tuple[Flight, object],
) -> None:
    """Each leg of the script is drawn, and is gone at its end.  At its beginning the gate allows
    less, as the vehicle is slow yet."""
    flight, _ = demo
    legs = [item for _, item in flight.records if isinstance(item, LegItem)]
    assert len(legs) == 2 * 5
    assert all(bool(leg.places_ned) is (number % 2 == 0) for number, leg in enumerate(legs))
    drawn = legs[1]
    apart_m_s = []
    for _, item in flight.records:
        if isinstance(item, LegItem):
            drawn = item
        elif isinstance(item, StopItem) and item.allowed_m_s is not None and drawn.places_ned:
            apart_m_s.append(_speed_there(drawn, item) - item.allowed_m_s)
    assert min(apart_m_s) > -0.15
    assert sorted(apart_m_s)[len(apart_m_s) * 3 // 4] < 0.1


def _speed_there(leg: LegItem, at: StopItem) -> float:
    """Between the two places beside the one where the vehicle is."""
    goal_ned = leg.places_ned[-1]
    left_m = [math.dist(place_ned, goal_ned) for place_ned in leg.places_ned]
    here_m = min(left_m[0], math.dist(at.pos_ned, goal_ned))
    after = next(number for number, metres in enumerate(left_m) if number and metres <= here_m)
    share = (here_m - left_m[after]) / (left_m[after - 1] - left_m[after])
    before_m_s, after_m_s = leg.speeds_m_s[after - 1], leg.speeds_m_s[after]
    return after_m_s + share * (before_m_s - after_m_s)


def test_the_last_table_has_the_whole_story(path: Path) -> None:
    _, table = json_messages(path, "/gate/requests")[-1]
    story = [f"{row['verdict']} {row.get('ending', '')}".strip() for row in table["rows"][::-1]]
    assert len(story) == len(SCRIPT)
    assert story.count("refused") == 4
    assert story.count("accepted aborted") == 1
    to_the_fence = next(row for row in table["rows"] if row["request"] == "goto 22 0 4")
    assert to_the_fence["ending"] == "complete"


def test_no_derived_topic_is_faster_than_a_viewer_likes(path: Path) -> None:
    times: dict[str, list[int]] = {}
    with path.open("rb") as file:
        for _, channel, message in make_reader(file).iter_messages():
            if not channel.topic.startswith(("/mavlink/", "/session/")):
                times.setdefault(channel.topic, []).append(message.log_time)
    for topic, found in times.items():
        span_s = (found[-1] - found[0]) / 1e9
        assert span_s < 1.0 or (len(found) - 1) / span_s < MOST_HZ, topic


# --------------------------------------------------------------------------------- layout


def fields(path: Path) -> dict[str, Any]:
    """A decoded message of every topic that a layout may name; JSON topics by their schema."""
    found: dict[str, Any] = {}
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, channel, message in reader.iter_messages():
            if schema is not None and schema.encoding == "jsonschema":
                found.setdefault(channel.topic, json.loads(schema.data))
            elif schema is not None and schema.encoding == "protobuf":
                decoder = DecoderFactory().decoder_for("protobuf", schema)
                assert decoder is not None
                if channel.topic not in found:
                    found[channel.topic] = decoder(message.data)
    return found


def vars_of(message: Any) -> dict[str, Any]:
    """The fields of a decoded protobuf message."""
    names = [] if message is None else [field.name for field in message.DESCRIPTOR.fields]
    return {name: getattr(message, name) for name in names}


def resolves(known: dict[str, Any], value: str) -> bool:
    """Whether a message path leads to a field."""
    topic, *names = value.split(".")
    at = known.get(topic)
    for name in names:
        inner = at.get("properties", {}) if isinstance(at, dict) else vars_of(at)
        at = inner.get(name)
    return at is not None


def paths_in(value: Any) -> set[str]:
    """Every string in a layout that names a topic to read or a path into one."""
    if isinstance(value, dict):
        read = [(key, one) for key, one in value.items() if key != "publish"]  # the viewer's own
        return {path for pair in read for one in pair for path in paths_in(one)}
    if isinstance(value, list):
        return {path for one in value for path in paths_in(one)}
    return {value} if isinstance(value, str) and re.match(r"/\w", value) else set()


@pytest.mark.parametrize("purpose", PURPOSES)
def test_every_topic_and_field_of_the_layout_is_in_the_record(path: Path, purpose: Purpose) -> None:
    known = fields(path)
    wanted = paths_in(layout_for(path, purpose))
    assert len(wanted) > 15
    assert {value for value in wanted if not resolves(known, value)} == set()
    assert not resolves(known, "/vehicle/1/state.no_such_field")
    assert not resolves(known, "/vehicle/1/setpoint.pose.position.w")


def test_the_layout_for_any_flight_names_only_what_a_flight_has(path: Path) -> None:
    known = fields(path)
    for made in (layout_for(None), live_layout([1], None, "abcd2345")):
        assert {value for value in paths_in(made) if not resolves(known, value)} == set()
