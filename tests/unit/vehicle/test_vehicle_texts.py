"""The vehicle's own words: texts in chunks, and the reasons of its refusals, as recorded."""

from __future__ import annotations

import struct

import pytest

from gcs.gate.machine.sentences import RESULTS
from gcs.ipc import EndingEvent
from gcs.protocol.px4_events import ALL_MODES, ARMING_SUMMARY, HEALTH_SUMMARY
from gcs.session.speedup_waits import Times
from gcs.vehicle.talk.vehicle_texts import LOST, Said, Words
from gcs.wire.ids import Result
from gcs.wire.messages import Event, Statustext
from tests.unit.station import told, wire
from tests.unit.station.station import Script
from tests.unit.station.vehicles import SECOND_NS

CRITICAL, WARNING, INFO = 2, 4, 6
LOITER, OFFBOARD = 0x0304_0000, 0x0006_0000
NO_OFFBOARD_SIGNAL, NO_STICKS, NO_GLOBAL_POSITION = 19865031, 17231145, 26788467
LONG = "Failsafe activated due to no offboard signal, triggering Position mode"


def text(words: str, id: int = 0, chunk_seq: int = 0, severity: int = INFO) -> Statustext:
    return Statustext(severity=severity, text=words, id=id, chunk_seq=chunk_seq)


def event(number: int, log_levels: int, hexes: str) -> Event:
    data = bytes.fromhex(hexes)
    return Event(
        id=number,
        event_time_boot_ms=0,
        sequence=0,
        destination_component=0,
        destination_system=0,
        log_levels=log_levels,
        arguments=tuple(data.ljust(40, b"\0")),
    )


# ------------------------------------------------------------------------------- the texts


def test_px4_s_tab_is_not_told() -> None:
    """scenarios_px4.json, A1: every text that is an event too ends so, with an id."""
    said = Words(Times()).text(1, text("Armed by external command\t", id=1), 0)
    assert said == [Said(INFO, "Armed by external command")]


def test_chunks_are_joined_whatever_their_order() -> None:
    first, second = text(LONG[:50], 7, 0, CRITICAL), text(LONG[50:] + "\t", 7, 1, CRITICAL)
    for chunks in ((first, second), (second, first)):
        words = Words(Times())
        assert words.text(1, chunks[0], 0) == []
        assert words.text(1, chunks[1], 1) == [Said(CRITICAL, LONG)]
        assert words.deadline_ns is None


def test_a_text_of_exactly_one_chunk_ends_with_an_empty_one() -> None:
    words = Words(Times())
    assert words.text(1, text("x" * 50, 7, 0), 0) == []
    assert words.text(1, text("", 7, 1), 1) == [Said(INFO, "x" * 50)]


@pytest.mark.parametrize(
    ("there", "told_as"),
    [((0,), "a" * 50 + LOST), ((1,), LOST + "b"), ((0, 2), "a" * 50 + LOST + "c")],
)
def test_a_chunk_that_is_lost_does_not_keep_the_rest(there: tuple[int, ...], told_as: str) -> None:
    words = Words(Times())
    chunks = {0: "a" * 50, 1: "b" * (50 if 2 in there else 1), 2: "c"}
    for seq in there:
        assert words.text(1, text(chunks[seq], 7, seq), 0) == []
    assert words.deadline_ns == SECOND_NS
    assert words.wake(SECOND_NS - 1) == []
    assert words.wake(SECOND_NS) == [Said(INFO, told_as)]
    assert words.deadline_ns is None


def test_texts_of_two_components_with_the_same_id_are_two() -> None:
    words = Words(Times())
    words.text(1, text("a" * 50, 7, 0), 0)
    assert words.text(100, text("b", 7, 1), 0) == []
    assert words.text(1, text("c", 7, 1), 0) == [Said(INFO, "a" * 50 + "c")]


# ----------------------------------------------------------------------------- the reasons


def test_arducopter_s_reasons_not_to_arm_are_its_texts() -> None:
    """scenarios_arducopter.json, G7 and H7: texts around the FAILED, and before it."""
    words = Words(Times())
    words.text(1, text("PreArm: Battery failsafe", severity=CRITICAL), 0)
    words.text(1, text("Arm: Accels inconsistent", severity=CRITICAL), 9 * SECOND_NS)
    words.text(1, text("ArduPilot Ready"), 9 * SECOND_NS)
    why = words.reasons_not_to_arm(0, 9 * SECOND_NS, 10 * SECOND_NS)
    assert why == "Battery failsafe; Accels inconsistent"
    assert words.reasons_not_to_arm(0, 50 * SECOND_NS, 50 * SECOND_NS) == ""


def test_what_was_said_twice_is_told_once() -> None:
    words = Words(Times())
    for _ in range(3):
        words.text(1, text("Arm: EKF attitude is bad", severity=CRITICAL), 0)
    assert words.reasons_not_to_arm(0, 0, SECOND_NS) == "EKF attitude is bad"


def report(words: Words, can_arm: int, *checks: Event) -> None:
    summary = struct.pack("<BIIII", 0, 0, 0, can_arm, can_arm).hex()
    for each in (event(ARMING_SUMMARY, 0x88, summary), *checks, event(HEALTH_SUMMARY, 0x88, "00")):
        words.event(each, 0)


SIGNAL = event(NO_OFFBOARD_SIGNAL, 0x33, "0040000014")
STICKS = event(NO_STICKS, 0x44, "ffffffff07")
POSITION = event(NO_GLOBAL_POSITION, 0x33, "3800000014")
"""As recorded: scenarios_px4.json, event_catalogue."""


def test_px4_s_reasons_not_to_arm_are_the_checks_of_its_mode() -> None:
    words = Words(Times())
    report(words, ALL_MODES & ~0x4038, SIGNAL, POSITION, STICKS)
    assert words.reasons_not_to_arm(OFFBOARD, 0, 0) == "No offboard signal"
    assert words.reasons_not_to_arm(LOITER, 0, 0) == "No valid global position estimate"


def test_a_report_that_allows_the_mode_is_no_reason() -> None:
    words = Words(Times())
    report(words, ALL_MODES, SIGNAL)
    assert words.reasons_not_to_arm(OFFBOARD, 0, 0) == ""


def test_the_latest_whole_report_counts() -> None:
    words = Words(Times())
    report(words, 0, SIGNAL)
    report(words, ALL_MODES)
    assert words.reasons_not_to_arm(OFFBOARD, 0, 0) == ""


def test_other_refusals_have_the_warnings_of_the_last_second() -> None:
    """scenarios_px4.json: "Mission start denied! No valid mission" comes with the ack."""
    words = Words(Times())
    words.text(1, text("old", severity=CRITICAL), 0)
    words.text(1, text("Mission start denied! No valid mission\t", 3, 0, CRITICAL), 5 * SECOND_NS)
    words.text(1, text("Takeoff detected\t", 4, 0), 5 * SECOND_NS)
    assert words.reasons(5 * SECOND_NS + 8_000_000) == "Mission start denied! No valid mission"


# ------------------------------------------------------------------------------ the station


def test_every_result_has_its_word() -> None:
    words = {int(result): result.name for result in Result}
    del words[Result.ACCEPTED], words[Result.IN_PROGRESS]
    assert words == RESULTS


def test_a_refused_arm_tells_the_result_and_why() -> None:
    script = Script().met()
    script.ask("arm")
    script.hear(wire.text(CRITICAL, "Arm: Battery failsafe"))
    script.hear(wire.ack(400, Result.DENIED))
    (ended,) = told.events(script.told, EndingEvent)
    assert ended.sentence == "the vehicle refused arming (DENIED): Battery failsafe"


def test_a_text_of_which_a_chunk_is_lost_is_logged_in_time() -> None:
    script = Script().met()
    script.forget()
    chunk = wire.text(CRITICAL, LONG[:50], id=9)
    script.hear(chunk)
    script.run(1.5)
    assert LONG[:50] + LOST in told.log(script.told)


# ------------------------------------------------------------------- events in place of texts

TAKEOFF = event(21054825, 0x66, "")
FAILSAFE = event(31382480, 0x42, "0000060005")


def test_an_event_is_told_where_its_text_does_not_come() -> None:
    words = Words(Times())
    words.event(TAKEOFF, 0)
    assert words.wake(SECOND_NS - 1) == []
    assert words.deadline_ns == SECOND_NS
    assert words.wake(SECOND_NS) == [Said(INFO, "Takeoff detected")]
    assert words.deadline_ns is None


@pytest.mark.parametrize("text_ns", [0, SECOND_NS // 2, 3 * SECOND_NS // 2])
def test_and_not_where_it_came_before_or_after(text_ns: int) -> None:
    """Also where the text says more than the event: the failsafe's reason."""
    words = Words(Times())
    said = []
    for time_ns in range(0, 3 * SECOND_NS, SECOND_NS // 10):
        if time_ns == text_ns:
            said += words.text(1, text(LONG[:49] + "\t", severity=CRITICAL), time_ns)
        if time_ns == SECOND_NS:
            words.event(FAILSAFE, time_ns)
        said += words.wake(time_ns)
    assert len(said) == 1
    assert said[0].text == LONG[:49]


def test_an_event_of_which_no_text_came_yet_is_a_reason_too() -> None:
    words = Words(Times())
    words.event(event(27280279, 0x62, "0000040403"), 0)
    assert words.reasons(1) == "Switching to AUTO_MISSION is currently not available"
    words.text(1, text("Switching to AUTO_MISSION is currently not available\t", severity=2), 2)
    assert words.reasons(3) == "Switching to AUTO_MISSION is currently not available"
