"""Whatever a client sends, it has a meaning: nothing raises, and nothing but numbers comes out."""

from __future__ import annotations

import math
import struct
from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from gcs.bridge.translate.commands import COMMANDS
from gcs.bridge.translate.meaning import Forward, Reject, Sample, Seen, Sticks, Words
from gcs.bridge.translate.settling import Pace, StickStream
from gcs.bridge.translate.translate import meaning_of
from gcs.frames import Vec3
from gcs.gate.airspace.projection import Origin
from gcs.gate.airspace.stream_samples import StreamSample, beyond_rules
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT, PX4
from gcs.session.requests import request_of
from gcs.wire.codec import FrameWriter, decode
from gcs.wire.dialect import MESSAGES
from gcs.wire.frame import Frame, split
from gcs.wire.messages import CLASSES, CommandLong, Message

MOVES = (11, 39, 41, 69, 70, 73, 75, 76, 82, 84, 86)
"""Ids of the messages that are translated."""
NUMBERS = (0.0, 1.0, -1.0, 0.5, 2.0, 21196.0, 47.4, 8.5, 510.0, 1e38, math.nan, math.inf)
WORDS_OF_ASKS = frozenset(
    {"control", "arm", "disarm", "takeoff", "goto", "land", "rtl", "hold", "resume", "mode"}
    | {"mission_start", "mission_check", "mission_set_current"}
)

finite = st.floats(-1e6, 1e6)
vectors = st.tuples(finite, finite, finite)
seen = st.builds(
    Seen,
    autopilot=st.sampled_from([PX4, ARDUPILOT]),
    origin=st.none() | st.builds(Origin, st.floats(-90, 90), st.floats(-180, 180), finite),
    home_ned=st.none() | vectors,
    home_amsl_m=st.none() | finite,
    pos_ned=st.none() | vectors,
    v_ned=vectors,
    yaw_rad=st.none() | st.floats(-math.pi, math.pi),
    on_ground=st.booleans(),
    armed=st.booleans(),
    mode_name=st.sampled_from([mode.name for mode in (*PX4.modes, *ARDUPILOT.modes)] + [""]),
    goal_ned=st.none() | vectors,
    takeoff_up_m=st.floats(0.0, 100.0),
    state=st.sampled_from(State),
    in_control=st.booleans(),
    manual_modes=st.sampled_from([(), ("POSCTL", "loiter"), ("STABILIZE", "nonsense")]),
    goal_yaw_rad=st.none() | st.floats(-math.pi, math.pi),
    mission_paused=st.booleans(),
    max_speed_m_s=st.floats(0.0, 20.0),
    stream=st.none() | st.just(DEFAULT.stream),
    has_sticks=st.booleans(),
    mission_items=st.integers(0, 5),
)


def decoded(msgid: int, payload: bytes) -> Message:
    writer = FrameWriter(255, 190)
    (frame,) = split(writer.write_payload(msgid, payload))
    assert isinstance(frame, Frame)
    message = decode(frame)
    assert message is not None
    return message


@st.composite
def any_message(draw: st.DrawFn) -> Message:
    """Any bytes as the payload of a message that is translated."""
    msgid = draw(st.sampled_from(MOVES))
    size = MESSAGES[msgid].max_len
    payload = draw(st.binary(min_size=1, max_size=size))
    return decoded(msgid, payload)


commands = st.builds(
    CommandLong,
    *(st.sampled_from(NUMBERS) | st.floats(width=32) for _ in range(7)),
    st.sampled_from(sorted(COMMANDS)) | st.integers(0, 65535),
    st.integers(0, 255),
    st.integers(0, 255),
    st.integers(0, 255),
)


def check(message: Message, vehicle: Seen) -> None:
    meaning = meaning_of(message, vehicle)
    if isinstance(meaning, Sticks):
        check_sticks(meaning, vehicle)
        return
    for settled in (meaning, Pace(500_000_000).settle(meaning, 0)):
        match settled:
            case Words(asks, _, sample):
                assert {ask.word for ask in asks} <= WORDS_OF_ASKS
                for ask in asks:  # each is a request that the session understands
                    if ask.word == "mission_set_current":
                        assert 0 <= ask.item <= 0xFFFF
                    elif ask.word != "mission_check":
                        request_of(ask, vehicle.autopilot)
                if sample is not None:
                    check_sample(sample)
            case Sample():
                check_sample(settled)
            case Forward():
                pass
            case Reject(refusal):
                assert refusal.sentence
                assert refusal.code in Code


def check_sticks(sticks: Sticks, vehicle: Seen) -> None:
    """Never beyond the policy's most, and standstill where they are in the middle."""
    check_sample(sticks.sample)
    v_ned, rate_rad_s = sticks.sample.v_ned, sticks.sample.yaw_rate_rad_s
    asked = StreamSample(v_ned=v_ned, yaw_rate_rad_s=rate_rad_s)
    assert beyond_rules(asked, DEFAULT.stream) is None
    assert sticks.centred == (v_ned == (0.0, 0.0, 0.0) and not rate_rad_s)
    assert sticks.resting or not sticks.centred
    for flown in State:
        stream, seen_then = StickStream(), replace(vehicle, state=flown)
        for now_ns in range(0, 3_000_000_000, 500_000_000):
            settled = stream.settle(sticks, seen_then, now_ns)
            if isinstance(settled, Words):
                assert {ask.word for ask in settled.asks} <= {"stream_end"}


def check_sample(sample: Sample) -> None:
    triples: list[Vec3 | None] = [sample.pos_ned, sample.v_ned, sample.a_ned]
    given_ = [triple for triple in triples if triple is not None]
    assert given_
    for number in (number for triple in given_ for number in triple):
        assert not math.isnan(number)
        if math.isfinite(number):
            assert struct.unpack("<f", struct.pack("<f", number))[0] == number


@given(any_message(), seen)
def test_any_bytes_have_a_meaning(message: Message, vehicle: Seen) -> None:
    check(message, vehicle)


@given(commands, seen)
def test_any_command_has_a_meaning(message: CommandLong, vehicle: Seen) -> None:
    check(message, vehicle)


@given(seen, st.sampled_from(sorted(CLASSES)))
def test_any_other_message_is_refused(vehicle: Seen, msgid: int) -> None:
    message = decoded(msgid, b"\0")
    if msgid not in MOVES:
        assert isinstance(meaning_of(message, vehicle), Reject)
