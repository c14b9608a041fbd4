"""When a flight is logged, where the log lies, and that none of it grows without end."""

from __future__ import annotations

import datetime

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.unit.vehicle_logbook.flights import MS, Flight, S
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.effects import Note
from vehicle_sim.flight_log import recorder as recorder_module
from vehicle_sim.flight_log.log_directory import LOGS_MAX, LogDirectory, civil_date, unix_days
from vehicle_sim.flight_log.recorder import NEVER
from vehicle_sim.storage.store import MemoryStore, put

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")


def paths(flight: Flight) -> list[str]:
    return [log.path for log in flight.recorder.logs()]


def test_a_vehicle_that_is_not_armed_writes_nothing_and_is_never_due() -> None:
    flight = Flight()
    flight.advance(10 * S)
    assert flight.recorder.due_ns == NEVER
    assert flight.recorder.logs() == ()


@pytest.mark.parametrize("personality", BOTH)
def test_a_log_that_is_switched_off_writes_nothing(personality: Personality) -> None:
    flight = Flight(personality, enabled=False)
    flight.fly()
    flight.vehicle.armed = True
    assert flight.recorder.due_ns == NEVER
    assert flight.recorder.logs() == ()


def test_it_is_due_at_once_when_armed_and_then_at_every_tenth_of_a_second() -> None:
    flight = Flight()
    flight.advance(1 * S)
    flight.vehicle.armed = True
    assert flight.recorder.due_ns == flight.vehicle.time_ns
    flight.advance(52 * MS)
    assert flight.recorder.due_ns == 1100 * MS
    flight.advance(52 * MS)
    assert flight.recorder.due_ns == 1200 * MS


def test_it_needs_no_step_but_those_that_are_due() -> None:
    every, due_only = Flight(), Flight()
    for flight in (every, due_only):
        flight.vehicle.armed = True
        flight.advance(4 * MS)
    every.advance(996 * MS)
    while due_only.recorder.due_ns <= 1 * S:
        due_only.vehicle.time_ns = due_only.recorder.due_ns - due_only.vehicle.dt_ns
        due_only.advance(4 * MS)
    assert due_only.logs == every.logs


def test_px4_names_its_logs_by_date_and_time() -> None:
    flight = Flight("px4")
    flight.fly()
    flight.fly()
    assert paths(flight) == [
        "/fs/microsd/log/2024-05-01/09_16_41.ulg",
        "/fs/microsd/log/2024-05-01/09_16_45.ulg",
    ]


def test_ardupilot_counts_its_logs_and_keeps_the_last_number() -> None:
    flight = Flight("ardupilot")
    flight.fly()
    flight.fly()
    assert paths(flight) == ["/APM/LOGS/00000001.BIN", "/APM/LOGS/00000002.BIN"]
    assert flight.store.read("/APM/LOGS/LASTLOG.TXT", 0, 99) == b"2\r\n"


def test_two_logs_of_one_second_are_two_files_in_their_order() -> None:
    flight = Flight("px4")
    for _ in range(3):
        flight.vehicle.armed = True
        flight.advance(8 * MS)
        flight.vehicle.armed = False
        flight.advance(8 * MS)
    names = [path.rpartition("/")[2] for path in paths(flight)]
    assert names == ["09_16_40.ulg", "09_16_40_1.ulg", "09_16_40_2.ulg"]


@pytest.mark.parametrize("personality", BOTH)
def test_the_time_of_a_log_is_that_of_its_last_write(personality: Personality) -> None:
    flight = Flight(personality)
    flight.fly(20 * S)
    (log,) = flight.recorder.logs()
    assert log.time_utc_s == 1_714_555_000 + 21


@pytest.mark.parametrize("personality", BOTH)
def test_equal_flights_give_equal_bytes_and_others_do_not(personality: Personality) -> None:
    first, again, later = Flight(personality), Flight(personality), Flight(personality)
    later.advance(4 * MS)
    for flight in (first, again, later):
        flight.fly()
    assert first.logs == again.logs
    assert first.logs != later.logs


@pytest.mark.parametrize("personality", BOTH)
def test_the_log_being_written_is_listed_up_to_now(personality: Personality) -> None:
    flight = Flight(personality)
    flight.vehicle.armed = True
    flight.advance(1 * S)
    (before,) = flight.recorder.logs()
    flight.advance(1 * S)
    (after,) = flight.recorder.logs()
    assert before.path == after.path
    assert 0 < before.size < after.size


@pytest.mark.parametrize("personality", BOTH)
def test_erase_takes_them_all_and_a_flight_goes_on_in_a_new_one(personality: Personality) -> None:
    flight = Flight(personality)
    flight.fly()
    flight.vehicle.armed = True
    flight.advance(1 * S)
    flight.recorder.erase()
    assert flight.recorder.logs() == ()
    flight.advance(1 * S)
    assert len(flight.recorder.logs()) == 1


@pytest.mark.parametrize("personality", BOTH)
def test_a_long_flight_is_cut_into_logs_of_bounded_size(
    personality: Personality, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recorder_module, "LOG_BYTES_MAX", 50_000)
    flight = Flight(personality)
    flight.fly(30 * S)
    logs = flight.recorder.logs()
    assert len(logs) > 2
    assert max(log.size for log in logs) < 60_000
    heads = {log[:3] for log in flight.logs}
    assert len(heads) == 1, "each is a file of its own"


@pytest.mark.parametrize("personality", BOTH)
def test_the_oldest_logs_make_room_for_new_ones(personality: Personality) -> None:
    flight = Flight(personality)
    root = "/fs/microsd/log/2001-01-01" if personality == "px4" else "/APM/LOGS"
    suffix = "ulg" if personality == "px4" else "BIN"
    for number in range(LOGS_MAX):
        put(flight.store, f"{root}/{number:08d}.{suffix}", b"old")
    flight.fly()
    found = paths(flight)
    assert len(found) == LOGS_MAX
    assert f"{root}/00000000.{suffix}" not in found
    assert f"{root}/00000001.{suffix}" in found


def test_all_logs_together_stay_within_their_bound() -> None:
    store = MemoryStore()
    shelf = LogDirectory(store, "ardupilot")
    for _ in range(8):
        path = shelf.begin(0)
        shelf.append(path, bytes(8 * 1024 * 1024), 0)
    assert store.used_bytes <= 33 * 1024 * 1024
    assert [log.path[-6:] for log in shelf.logs()] == ["05.BIN", "06.BIN", "07.BIN", "08.BIN"]


@pytest.mark.parametrize("personality", BOTH)
def test_a_full_store_loses_old_logs_first_then_ends_the_new_one_with_a_word(
    personality: Personality,
) -> None:
    flight = Flight(personality, MemoryStore(bytes_max=120_000))
    put(flight.store, "/mine", bytes(20_000))
    for _ in range(4):
        flight.fly(5 * S)
    assert flight.notes == []
    assert 1 <= len(flight.recorder.logs()) < 4
    flight.fly(30 * S)
    (note,) = flight.notes
    assert isinstance(note, Note)
    assert note.level == "warning"
    assert "full" in note.text
    assert flight.recorder.due_ns == NEVER
    flight.fly()
    assert len(flight.notes) == 1, "the next flight is logged again"


def test_a_log_that_somebody_removes_in_flight_ends_with_a_word() -> None:
    flight = Flight("ardupilot")
    flight.vehicle.armed = True
    flight.advance(1 * S)
    flight.shelf.remove(paths(flight)[0])
    flight.advance(20 * S)
    assert len(flight.notes) == 1


@given(st.integers(0, 365 * 300))
def test_dates_are_the_calendars(days: int) -> None:
    date = datetime.date(1970, 1, 1) + datetime.timedelta(days)
    assert civil_date(days) == (date.year, date.month, date.day)
    assert unix_days(date.year, date.month, date.day) == days


def test_a_log_of_an_earlier_run_has_the_time_of_its_name() -> None:
    flight = Flight("px4")
    flight.fly()
    again = LogDirectory(flight.store, "px4")
    assert [log.time_utc_s for log in again.logs()] == [1_714_555_000 + 1]


@pytest.mark.parametrize(
    ("personality", "root"), [("px4", "/fs/microsd/log"), ("ardupilot", "/APM/LOGS")]
)
def test_the_place_of_the_logs_is_there_before_the_first(
    personality: Personality, root: str
) -> None:
    store = MemoryStore()
    LogDirectory(store, personality)
    assert store.entries(root) == []
    LogDirectory(store, personality)  # over a store that has it already
