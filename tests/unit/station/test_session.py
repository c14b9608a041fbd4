"""The composition: what reaches the station, in what order it is told, and what changes nothing."""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import pytest
from msgspec import structs

from gcs import ipc
from gcs.config import SimConfig, StationConfig
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.zonespec import CircleSpec
from gcs.session.effects import Effect, Record
from gcs.session.inputs import (
    Datagram,
    DiskLow,
    FileRead,
    LinkEvent,
    OperatorNoise,
    RecorderChanged,
    RecorderGrew,
    SimGone,
    SimLine,
)
from gcs.vehicle.record_items import Pieces
from tests.unit.station import told, wire
from tests.unit.station.station import Script
from tests.unit.station.wire import MS_NS, Sender

ARM = 400
HERE = CircleSpec(name="here", radius_m=20.0, frame="local")
SMALL = structs.replace(DEFAULT, name="small", fence=(HERE,))


# ----------------------------------------------------------------------- what is recorded


def test_first_of_all_it_is_told_and_recorded_what_this_session_is() -> None:
    script = Script()
    effects = script.feed(LinkEvent(0, "open"))
    kinds = [type(e.item).__name__ for e in effects if isinstance(e, Record)]
    assert kinds[:3] == ["MetadataItem", "AttachmentItem", "InputItem"]
    (hello,) = told.events(effects, ipc.Hello)
    assert (hello.log_path, hello.policy) == ("logs/a.mcap", "default")
    assert told.events(script.feed(LinkEvent(0, "still open")), ipc.Hello) == []


@pytest.mark.parametrize(
    ("config", "sysids"),
    [
        (StationConfig(sim=SimConfig()), [1]),
        (StationConfig(target_sysid=7), [7]),
        (StationConfig(), []),
    ],
)
def test_the_record_begins_with_the_state_of_a_vehicle_whose_number_is_known(
    config: StationConfig, sysids: list[int]
) -> None:
    effects = Script(config=config).feed(LinkEvent(0, "open"))
    found = [(item.sysid, item.state) for item in told.recorded(effects, "FsaItem")]
    assert found == [(sysid, "NO_VEHICLE") for sysid in sysids]


def test_every_frame_is_recorded_before_anything_that_it_leads_to() -> None:
    script = Script()
    first = script.sender.frame(wire.heartbeat())
    second = script.sender.frame(wire.landed(wire.ON_GROUND))
    third = script.sender.frame(wire.position(1000, (0.0, 0.0, 0.0)))
    effects = script.feed(Datagram(0, first + second + third))
    received = [raw for _, direction, raw in told.frames(effects) if direction == 0]
    assert received == [first, second, third]
    at = [index for index, effect in enumerate(effects) if _is_received(effect)]
    met = _index(effects, lambda e: "vehicle 1/1" in told.log([e]))
    grounded = _index(effects, lambda e: told.states([e]) == ["GROUNDED"])
    assert at[0] < met < at[1] < at[2] < grounded


def _is_received(effect: Effect) -> bool:
    return [direction for _, direction, _ in told.frames([effect])] == [0]


def _index(effects: list[Effect], true: Callable[[Effect], bool]) -> int:
    return next(index for index, effect in enumerate(effects) if true(effect))


@pytest.mark.parametrize("data", [b"", b"GET / HTTP/1.1", b"\xfd\x09\x00"])
def test_bytes_that_are_no_frame_are_recorded_and_change_nothing(data: bytes) -> None:
    script = Script().met()
    script.forget()
    effects = script.feed(Datagram(0, data))
    assert [type(e.item).__name__ for e in effects if isinstance(e, Record)] == (
        ["GarbageItem"] if data else ["InputItem"]
    )
    assert len(effects) == 1


def test_a_frame_with_a_wrong_checksum_moves_nothing() -> None:
    script = Script().flying()
    raw = bytearray(script.sender.frame(wire.position(script.now_ns // MS_NS, (40.0, 0.0, -5.0))))
    raw[-1] ^= 1
    effects = script.feed(Datagram(0, bytes(raw)))
    assert told.frames(effects) == []
    assert script.session.gate.pos_ned == (0.0, 0.0, -5.0)


def test_how_a_datagram_was_cut_is_recorded_only_where_it_does_not_show() -> None:
    two = ("udpin://127.0.0.1:14540", "tcpout://127.0.0.1:5760")
    script = Script(endpoints=two, streams=frozenset({1})).met()
    script.forget()
    first, second = script.sender.frame(wire.heartbeat()), script.sender.frame(wire.heartbeat())
    script.feed(Datagram(0, first))
    script.feed(Datagram(0, first + second))
    script.feed(Datagram(1, first[:5]))
    script.feed(Datagram(1, first[5:] + second[:3]))
    script.feed(Datagram(1, second[3:]))
    script.feed(Datagram(1, first))
    kept = [
        msgspec.json.decode(i.data, type=Pieces) for i in told.recorded(script.told, "InputItem")
    ]
    assert kept == [Pieces(1, 0, first[:5]), Pieces(1, 1, second[:3])]


def test_an_input_that_is_no_frame_is_recorded_as_what_it_was() -> None:
    script = Script()
    script.feed(LinkEvent(0, "open"))
    effects = script.feed(FileRead(7, "a.plan", b"12345"))
    (item,) = told.recorded(effects, "InputItem")
    assert "FileRead" in repr(item)
    assert "12345" not in repr(item)


# ------------------------------------------------------------------------------ strangers


def test_a_stranger_s_frames_are_recorded_and_change_nothing() -> None:
    script = Script().hovering()
    stranger = Sender(sysid=7)
    script.feed(Datagram(0, stranger.frame(wire.heartbeat())))
    assert "several vehicles are heard: 1/1 px4 quadrotor, 7/1 px4" in told.log(script.told)
    script.forget()
    before = script.session.gate.memory
    for message in (
        wire.heartbeat(armed=False, mode=wire.POSCTL),
        wire.landed(wire.ON_GROUND),
        wire.position(1, (90.0, 0.0, -1.0)),
        wire.ack(176, 2),
        wire.text(0, "MAYDAY"),
        wire.origin(),
    ):
        raw = stranger.frame(message)
        effects = script.feed(Datagram(0, raw))
        assert told.frames(effects) == [(0, 0, raw)]
        assert len(effects) == 1
    assert script.session.gate.memory == before


def test_another_component_of_our_vehicle_is_not_its_autopilot() -> None:
    script = Script().flying()
    companion = Sender(sysid=1, compid=191)
    for message in (wire.heartbeat(mode=wire.OFFBOARD), wire.position(1, (90.0, 0.0, -1.0))):
        script.feed(Datagram(0, companion.frame(message)))
    assert script.session.gate.pos_ned == (0.0, 0.0, -5.0)
    assert script.session.telemetry is not None
    assert script.session.telemetry.mode_name == "POSCTL"


def test_another_station_with_our_id_is_shown_until_it_is_silent_for_five_seconds() -> None:
    script = Script().met()
    twin = Sender(255, 190)
    effects = script.feed(
        Datagram(0, twin.frame(wire.heartbeat(wire.NO_AUTOPILOT, type_=wire.GCS)))
    )
    assert "other_station" in script.conditions
    assert len(told.frames(effects)) == 1
    script.run(4.9)
    assert "other_station" in script.conditions
    script.run(1.2)
    assert "other_station" not in script.conditions


def test_another_station_with_an_id_of_its_own_is_nothing_to_show() -> None:
    script = Script().met()
    other = Sender(254, 190)
    script.feed(Datagram(0, other.frame(wire.heartbeat(wire.NO_AUTOPILOT, type_=wire.GCS))))
    assert "other_station" not in script.conditions


# ---------------------------------------------------------------------- ways of the bytes


def test_a_vehicle_may_speak_mavlink_1() -> None:
    script = Script()
    boot_ms = script.now_ns // MS_NS
    script.hear(wire.heartbeat(), wire.landed(wire.ON_GROUND), mavlink1=True)
    script.hear(wire.position(boot_ms, (1.0, 2.0, -3.0)), mavlink1=True)
    assert script.state == "GROUNDED"
    assert script.session.gate.pos_ned == (1.0, 2.0, -3.0)


def test_a_stream_may_be_cut_anywhere() -> None:
    whole, cut = Script(streams=frozenset({0})), Script(streams=frozenset({0}))
    messages = (wire.heartbeat(), wire.landed(wire.ON_GROUND), wire.position(9, (1.0, 2.0, -3.0)))
    data = b"".join(whole.sender.frame(message) for message in messages)
    whole.feed(Datagram(0, data))
    for n in range(len(data)):
        cut.feed(Datagram(0, data[n : n + 1]))
    assert told.frames(cut.told) == told.frames(whole.told)
    assert cut.session.gate.memory == whole.session.gate.memory
    assert cut.state == "GROUNDED"


def test_nothing_is_sent_where_nobody_has_spoken() -> None:
    script = Script(endpoints=("one", "two"), waiting=frozenset({0, 1}))
    script.run(2.0)
    assert script.sent() == []
    script.hear(wire.heartbeat(), link=1)
    script.run(1.0)
    assert wire.sent(script.told, link=0) == []
    assert wire.sent(script.told, "HEARTBEAT", link=1) != []


# ------------------------------------------------------------------------------- requests


def test_what_is_no_request_is_refused_in_its_own_words() -> None:
    script = Script().met()
    asked = script.ask("dance")
    assert told.verdicts(script.told) == [(asked, "refused", "BAD_REQUEST")]


@pytest.mark.parametrize("word", ["arm", "land", "mission_upload", "mission_start"])
def test_without_a_vehicle_every_request_is_refused(word: str) -> None:
    script = Script()
    asked = script.ask(word, path="box.plan")
    assert told.verdicts(script.told) == [(asked, "refused", "NO_VEHICLE")]
    assert wire.sent(script.told) == []


def test_an_accepted_request_has_one_verdict_and_one_outcome() -> None:
    script = Script().met()
    script.hear(wire.system(armable=True))
    asked = script.ask("arm")
    assert told.verdicts(script.told) == [(asked, "accepted", "")]
    assert told.outcomes(script.told) == []
    script.hear(wire.ack(ARM))
    script.armed = True
    script.run(2.0)
    script.hear(wire.ack(ARM))
    assert told.verdicts(script.told) == [(asked, "accepted", "")]
    assert told.outcomes(script.told) == [(asked, "complete", "")]


def test_what_the_vehicle_refuses_ends_as_refused_by_the_vehicle() -> None:
    script = Script().met()
    script.hear(wire.system(armable=True))
    asked = script.ask("arm")
    script.hear(wire.ack(ARM, 2))  # MAV_RESULT_DENIED
    script.run(0.2)  # its reason may follow
    assert told.outcomes(script.told) == [(asked, "aborted", "VEHICLE_REFUSED")]


def test_the_mission_mode_by_its_name_is_a_mission_start_and_needs_a_mission() -> None:
    script = Script().hovering()
    asked = script.ask("mode", mode="AUTO.MISSION")
    script.hear(wire.mission_count(0))
    assert told.verdicts(script.told)[-1] == (asked, "refused", "NO_MISSION")


def test_a_line_that_is_no_command_is_answered_and_nothing_is_done() -> None:
    script = Script().met()
    script.forget()
    effects = script.feed(OperatorNoise(1, "bad: b'xyz'"))
    assert [trouble.text for trouble in told.troubles(effects)] == ["not a command: bad: b'xyz'"]
    assert script.sent() == []


def test_a_pending_goal_is_logged_and_nothing_is_sent() -> None:
    script = Script().hovering()
    script.forget()
    effects = script.say(ipc.Pending((1.0, -2.5, 3.0)))
    assert told.log(effects) == "Keyboard: (1.00, -2.50, 3.00)"
    assert script.sent() == []


@pytest.mark.parametrize(("trouble", "level"), [(False, told.INFO), (True, told.WARNING)])
def test_what_happens_to_a_link_is_logged(trouble: bool, level: int) -> None:
    script = Script()
    effects = script.feed(LinkEvent(0, "connection lost", trouble))
    assert told.lines(effects) == [(level, "connection lost")]


# -------------------------------------------------------------------------------- recorder


def test_a_recorder_that_fails_is_a_condition_in_the_same_turn_and_gone_when_it_is_back() -> None:
    script = Script().met()
    effects = script.feed(RecorderChanged(False, "logs/a.mcap", "disk full"))
    assert "recorder_failed" in script.conditions
    assert (told.ERROR, "disk full") in told.lines(effects)
    script.run(0.1)
    assert told.snapshots(script.told)[-1].recording is False
    script.feed(RecorderChanged(True, "logs/a_part2.mcap", "recording again"))
    assert "recorder_failed" not in script.conditions
    script.run(0.1)
    last = told.snapshots(script.told)[-1]
    assert (last.recording, last.log_path) == (True, "logs/a_part2.mcap")


def test_where_the_policy_says_so_nothing_is_armed_while_nothing_is_recorded() -> None:
    script = Script(policy=structs.replace(DEFAULT, arm_requires_recording=True)).met()
    script.feed(RecorderChanged(False, "logs/a.mcap", "disk full"))
    asked = script.ask("arm")
    assert told.verdicts(script.told) == [(asked, "refused", "RECORDER_DOWN")]


def test_a_recorder_that_failed_before_the_vehicle_was_heard_still_has() -> None:
    script = Script()
    script.feed(RecorderChanged(False, "logs/a.mcap", "disk full"))
    script.met()
    assert "recorder_failed" in script.conditions


def test_how_much_is_recorded_is_shown() -> None:
    script = Script().met()
    script.feed(RecorderGrew(2_500_000))
    script.run(0.1)
    assert told.snapshots(script.told)[-1].recorded_mb == 2.5


def test_a_disk_that_fills_up_is_told_with_what_is_left() -> None:
    script = Script().met()
    assert told.lines(script.feed(DiskLow(150_000_000, 1500.0, False))) == [
        (told.WARNING, "the disk of the record has 150 MB left, for 25 min at this rate")
    ]
    assert told.lines(script.feed(DiskLow(19_000_000, None, True))) == [
        (told.ERROR, "the disk of the record has 19 MB left")
    ]


# -------------------------------------------------------------------- a vehicle of our own


def test_a_line_of_our_own_vehicle_is_logged_as_its_own() -> None:
    script = Script()
    assert told.lines(script.feed(SimLine("WARNING world: wind from nowhere"))) == [
        (told.WARNING, "wind from nowhere")
    ]


def test_a_vehicle_s_process_that_ends_before_it_is_heard_ends_the_session() -> None:
    script = Script()
    effects = script.feed(SimGone(2))
    (trouble,) = told.troubles(effects)
    assert (trouble.exit_code, "exit code 2" in trouble.text) == (3, True)
    (finish,) = told.finishes(effects)
    assert finish.exit_code == 3


def test_a_vehicle_s_process_that_ends_later_is_an_error_and_its_silence_tells_the_rest() -> None:
    script = Script().met()
    effects = script.feed(SimGone(2))
    assert told.finishes(effects) == []
    ((level, text),) = told.lines(effects)
    assert (level, "exit code 2" in text) == (told.ERROR, True)
    script.reporting = False
    script.run(5.0)
    assert script.state == "NO_VEHICLE"


# ---------------------------------------------------------------------------- a bad start


def test_a_start_outside_the_fence_ends_the_session_and_names_the_policy() -> None:
    script = Script(policy=SMALL)
    script.pos_ned = (0.0, 30.0, 0.0)
    script.met()
    (trouble,) = told.troubles(script.told)
    assert trouble.exit_code == 6  # refused by the gate
    assert "small: fence: the vehicle stands outside" in trouble.text
    (finish,) = told.finishes(script.told)
    assert finish.exit_code == 6


def test_a_start_inside_the_fence_is_looked_at_once() -> None:
    """Carried out of the fence by hand, it is no start any more."""
    script = Script(policy=SMALL).met()
    script.pos_ned = (0.0, 30.0, 0.0)
    script.run(1.0)
    assert told.finishes(script.told) == []


def test_a_vehicle_that_is_met_in_the_air_is_not_left_alone_for_where_it_is() -> None:
    script = Script(policy=SMALL)
    script.armed, script.landed, script.mode = True, wire.IN_AIR, wire.POSCTL
    script.pos_ned = (0.0, 30.0, -5.0)
    script.met()
    assert told.finishes(script.told) == []
    asked = script.ask("goto", goal_enu=(40.0, 0.0, 5.0))
    script.run(0.1)
    (verdict,) = told.verdicts(script.told)
    assert verdict[:2] == (asked, "refused")


def test_a_session_that_heard_a_vehicle_or_has_one_of_its_own_is_worth_keeping() -> None:
    script = Script()
    script.run(3.0)
    heard = [script.session.nothing_heard]
    script.hear(wire.heartbeat())
    heard.append(script.session.nothing_heard)
    assert heard == [True, False]
    assert not Script(config=StationConfig(sim=SimConfig())).session.nothing_heard


def test_how_the_vehicle_is_is_recorded_when_its_mode_or_armed_state_changes() -> None:
    script = Script()
    script.hear(wire.heartbeat())
    script.hear(wire.heartbeat())
    effects = script.hear(wire.heartbeat(mode=wire.OFFBOARD))
    effects += script.hear(wire.heartbeat(mode=wire.OFFBOARD))
    effects += script.hear(wire.heartbeat(mode=wire.OFFBOARD, armed=True))
    found = [(item.mode, item.armed) for item in told.recorded(effects, "StatusItem")]
    assert found == [("OFFBOARD", False), ("OFFBOARD", True)]
