"""A station and a vehicle with keys: it flies signed, and nobody else is heard on either side."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest
from pymavlink.dialects.v20 import all as upstream

from gcs.audit.audit import audit
from gcs.audit.messages import Tape
from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from gcs.record.writer import Recorder
from gcs.report import FramesItem
from gcs.session import inputs
from gcs.wire.frame import Frame, split
from tests.loopback import pymavlink_decoder
from tests.loopback.flight import PEER, Flight, Personality
from tests.loopback.lossy_link import CLEAR, Weather
from tests.loopback.observed import START_NS
from vehicle_sim.services.profile import profile_of
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import Datagram as Inbound
from vehicle_sim.simulation.world import LinkSpec, SigningKey, Transmit, World

KEY, OTHER = bytes(range(32)), bytes(32 * [7])


def signed(
    personality: Personality = "px4", *, up: Weather = CLEAR, down: Weather = CLEAR
) -> Flight:
    return Flight(personality, up=up, down=down, vehicle_key=KEY, station_key=KEY)


def flown(flight: Flight, up_m: float = 1.0) -> Flight:
    flight.hovering(up_m)
    assert flight.done(flight.goto(2.0, 0.0, up_m)) == "complete"
    flight.do("land")
    return flight


def test_with_the_key_it_flies_and_every_frame_either_way_is_signed(
    personality: Personality,
) -> None:
    flight = flown(signed(personality))
    for sent in (*flight.sent, *flight.received):
        for item in split(sent.data):
            assert isinstance(item, Frame)
            assert item.signature
    assert flight.garbage() == []


def test_over_a_bad_link_it_flies_as_well(personality: Personality) -> None:
    bad = Weather(loss=0.05, duplicate=0.05, corrupt=0.02, delay_s=(0.001, 0.03))
    flight = signed(personality, up=bad, down=bad)
    # So high, the drift of an estimate that has just begun brings no climb near the fence's floor.
    flown(flight, 3.0)
    assert {g.reason for g in flight.garbage()} >= {"replayed"}


@pytest.mark.parametrize(
    ("station_key", "why", "hint"),
    [
        (OTHER, "signed with another key", "is the key right?"),
        (KEY, "unsigned", "gcs key install"),
    ],
    ids=["another key", "a vehicle without a key"],
)
def test_a_vehicle_that_signs_otherwise_is_none_and_the_operator_is_told_why(
    personality: Personality, station_key: bytes, why: str, hint: str
) -> None:
    vehicle_key = KEY if station_key == OTHER else None
    flight = Flight(personality, vehicle_key=vehicle_key, station_key=station_key)
    flight.run(15.0)
    assert flight.session.telemetry is None
    (trouble,) = flight.troubles()
    assert why in trouble.text
    assert hint in trouble.hint
    assert trouble.exit_code == 3
    assert any(why in line and "1/1 HEARTBEAT" in line for line in flight.lines("signing"))
    assert flight.outcome(flight.say("arm")) == "refused NO_VEHICLE"


def test_without_a_key_the_operator_is_told_that_the_vehicle_signs(
    personality: Personality,
) -> None:
    flight = Flight(personality, vehicle_key=KEY)
    flight.run(3.0)
    (line,) = flight.lines("signing")
    assert "1/1 signs its frames" in line
    assert "--sign-key" in line


def test_a_policy_may_take_what_is_unsigned_and_then_it_is_told() -> None:
    policy = parse_policy('signing.unsigned = "warn"', "my.toml")
    flight = Flight(station_key=KEY, policy=policy)
    flown(flight)
    assert any("unsigned, taken all the same" in line for line in flight.lines("signing"))


def test_a_vehicle_whose_clock_is_an_hour_behind_is_brought_on_by_what_we_send() -> None:
    flight = signed()
    flight.world = _with_clock(flight, START_NS - 3600 * 10**9)
    flown(flight)
    assert {g.reason for g in flight.garbage()} == {"too old"}


# ------------------------------------------------------------------------------- strangers


def forged(key: bytes | None, link_id: int = 0) -> upstream.MAVLink:
    """A program that calls itself the vehicle, or the station, as it likes."""
    mav = upstream.MAVLink(None, srcSystem=1, srcComponent=1)
    if key is not None:
        mav.signing.secret_key, mav.signing.link_id = key, link_id
        mav.signing.timestamp = 1 << 47
        mav.signing.sign_outgoing = True
    return mav


@pytest.mark.parametrize("key", [None, OTHER], ids=["unsigned", "another key"])
def test_a_forged_position_is_nobody_s_and_the_record_says_who_tried(key: bytes | None) -> None:
    flight = signed().hovering()
    before = flight.session.telemetry.pos_ned if flight.session.telemetry else None
    mav = forged(key)
    far = upstream.MAVLink_local_position_ned_message(2**31, 400.0, 0.0, -1.0, 0.0, 0.0, 0.0)
    flight.feed(inputs.Datagram(0, bytes(far.pack(mav))))
    telemetry = flight.session.telemetry
    assert telemetry is not None
    assert telemetry.pos_ned == before
    flight.run(2.0)
    assert flight.is_in(State.HOVERING)
    (item,) = flight.garbage()
    assert item.reason == ("wrong key" if key else "unsigned")
    (line,) = flight.lines("signing")
    assert "refused: 1/1 LOCAL_POSITION_NED" in line


@pytest.mark.parametrize("key", [None, OTHER], ids=["unsigned", "another key"])
def test_who_goes_round_the_station_gets_nothing(
    personality: Personality, key: bytes | None
) -> None:
    flight = signed(personality).connected()
    mav = forged(key)
    mav.srcSystem, mav.srcComponent = 255, 190
    arm = upstream.MAVLink_command_long_message(1, 1, 400, 0, 1, 21196, 0, 0, 0, 0, 0)
    for data in (arm, arm):
        flight.world.handle(Inbound(0, "stranger", bytes(data.pack(mav))), flight.now_ns)
    flight.run(2.0)
    assert not flight.vehicle.armed
    assert flight.is_in(State.GROUNDED)


ANSWERS = {"COMMAND_ACK", "MISSION_ACK", "MISSION_REQUEST_INT", "MISSION_COUNT", "PARAM_VALUE"}


@pytest.mark.parametrize("seed", range(3))
def test_what_was_sent_once_changes_nothing_a_second_time(
    personality: Personality, seed: int
) -> None:
    """A flight is listened to.  In the air and after the landing any of it is played at any time,
    both ways: the vehicle answers nothing of it, and the station believes nothing of it."""
    dice = random.Random(seed)
    flight = signed(personality).hovering()
    _played_back(flight, dice, 40)
    assert flight.is_in(State.HOVERING)
    assert flight.vehicle.armed
    flight.do("land")
    _played_back(flight, dice, 40)
    assert flight.is_in(State.GROUNDED)
    assert not flight.vehicle.armed


def _played_back(flight: Flight, dice: random.Random, times: int) -> None:
    states = len(flight.states())
    for _ in range(times):
        down, up = dice.choice(flight.received).data, dice.choice(flight.sent).data
        refused, told = len(flight.garbage()), len(flight.events)
        flight.feed(inputs.Datagram(0, down))
        assert len(flight.garbage()) == refused + len(split(down))
        assert all(g.reason == "replayed" for g in flight.garbage()[refused:])
        assert len(flight.events) == told
        outputs = flight.world.handle(Inbound(0, PEER, up), flight.now_ns)
        sent = [split(each.data) for each in outputs if isinstance(each, Transmit)]
        names = {item.name for items in sent for item in items if isinstance(item, Frame)}
        assert not names & ANSWERS
        flight.run(dice.uniform(0.01, 0.3))
    assert len(flight.states()) == states


# ------------------------------------------------------------------------------- the record


def test_the_audit_reproduces_a_signed_flight_and_sees_what_was_altered(
    personality: Personality, monkeypatch: pytest.MonkeyPatch
) -> None:
    tape = Tape()
    monkeypatch.setattr(
        Flight, "new_recorder", lambda _flight: Recorder.without_file(tape, START_NS)
    )
    flight = signed(personality).connected()
    mav = forged(OTHER)
    beat = upstream.MAVLink_heartbeat_message(2, 12, 81, 0, 4, 3)
    flight.feed(inputs.Datagram(0, bytes(beat.pack(mav))))
    flight.feed(inputs.Datagram(0, flight.received[-1].data))
    flight.run(2.0)
    reasons = {g.reason for g in flight.garbage()}
    assert reasons == {"wrong key", "replayed"}
    messages = list(tape.take())
    result = audit(messages, tape.attachments, "test", "")
    assert result.good, (result.notes, result.first[:5])
    assert any("signatures are not compared" in note for note in result.notes)
    at, last = max(
        (n, m) for n, m in enumerate(messages) if m.is_frame and m.data[1] == 1 and len(m.data) > 40
    )
    altered = bytearray(last.data)
    altered[-14] ^= 1  # in the frame's checksum, before its signature
    messages[at] = last._replace(data=bytes(altered))
    assert not audit(messages, tape.attachments, "test", "").good


@pytest.mark.parametrize("wrong", [None, OTHER], ids=["unsigned", "wrong key"])
@pytest.mark.parametrize("secret", [bytes(32), KEY, KEY[::-1]], ids=["no key", "KEY", "backwards"])
def test_a_refused_set_up_of_signing_is_recorded_as_the_frame_it_was(
    wrong: bytes | None, secret: bytes
) -> None:
    """MAVLink 2 cuts the last zeros of a payload: of a key, none or all of it."""
    tape = Tape()
    flight = signed("px4").connected()
    flight.recorder = Recorder.without_file(tape, START_NS)
    setup = upstream.MAVLink_setup_signing_message(1, 1, secret, 12345)
    flight.feed(inputs.Datagram(0, bytes(setup.pack(forged(wrong)))))
    (kept,) = [m for m in tape.take() if m.is_garbage]
    (frame,) = split(kept.raw)
    assert isinstance(frame, Frame)
    assert frame.msgid == upstream.MAVLINK_MSG_ID_SETUP_SIGNING
    assert bool(frame.signature) == (wrong is not None)
    assert secret == bytes(32) or secret[1:9] not in kept.data


def test_a_record_holds_no_key() -> None:
    """A SETUP_SIGNING that passes is recorded with zeros for its key, a good frame all the same."""
    tape = Tape()
    flight = Flight()
    flight.recorder = Recorder.without_file(tape, START_NS)
    setup = upstream.MAVLink_setup_signing_message(1, 1, KEY, 12345)
    raw = bytes(setup.pack(forged(None)))
    flight.feed(inputs.Datagram(0, raw))
    flight.feed(inputs.Datagram(0, raw[:-20]))  # and broken off: garbage with half a key
    flight.feed(inputs.Datagram(0, b"\xfd" + raw))
    messages = list(tape.take())
    assert raw in [raw for item in flight.recorded(FramesItem) for raw in item.raws]
    assert not [m for m in messages if KEY[1:9] in m.data or KEY[1:9].hex().encode() in m.data]
    (kept,) = [m for m in messages if m.topic.endswith("SETUP_SIGNING")][:1]
    told = pymavlink_decoder.read(kept.raw)
    assert (told.get_type(), told.initial_timestamp) == ("SETUP_SIGNING", 12345)
    assert bytes(told.secret_key) == bytes(32)
    assert audit(messages, tape.attachments, "test", "").good


def _with_clock(flight: Flight, unix_ns: int) -> World:
    server = VehicleServer(
        flight.vehicle,
        profile_of("px4", flight.vehicle.parameters.firmware),
        flight.vehicle.parameters,
        1,
    )
    return World(
        [server],
        [LinkSpec((PEER,))],
        Fraction(1),
        START_NS,
        signing=SigningKey(KEY),
        unix_start_ns=unix_ns,
    )
