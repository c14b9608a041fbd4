"""Flight logs of the simulated vehicle through a station: listed, read both ways, summed up."""

from __future__ import annotations

import random
import zlib

import pytest

from gcs import ipc
from gcs.session import inputs
from tests.loopback.flight import Flight, Personality
from tests.loopback.lossy_link import CLEAR, Weather
from vehicle_sim.storage.store import put

PATHS: dict[Personality, str] = {
    "px4": "/fs/microsd/log/2024-05-01/12_00_00.ulg",
    "ardupilot": "/APM/LOGS/00000001.BIN",
}
LOG = random.Random(1).randbytes(40_000)
NOISY = Weather(loss=0.02)


def with_log(personality: Personality, weather: Weather = CLEAR) -> Flight:
    flight = Flight(personality, up=weather, down=weather)
    put(flight.world.servers[0].store, PATHS[personality], LOG)
    flight.run(3.0)
    return flight


def came(flight: Flight, offset: int = 0) -> bytes:
    """The bytes that the operator was told, in order and without a gap."""
    data = b""
    for event in flight.of(ipc.FileDataEvent):
        assert event.offset == offset + len(data)
        assert len(event.data) <= 16_384
        data += event.data
    return data


@pytest.mark.parametrize("weather", [CLEAR, NOISY])
def test_a_log_is_listed_and_read_by_messages(personality: Personality, weather: Weather) -> None:
    flight = with_log(personality, weather)
    assert flight.done(flight.say("log_list")) == "complete"
    (log,) = flight.of(ipc.LogsEvent)[-1].logs
    assert log.size == len(LOG)
    assert flight.done(flight.say("log_read", item=log.number)) == "complete"
    assert came(flight) == LOG


def test_a_part_goes_on_by_ftp_and_its_check_sum_is_told(personality: Personality) -> None:
    flight = with_log(personality, NOISY)
    path = PATHS[personality]
    assert flight.done(flight.say("file_read", path=path, offset=12_345)) == "complete"
    assert came(flight, 12_345) == LOG[12_345:]
    assert flight.done(flight.say("file_crc", path=path)) == "complete"
    crc = flight.of(ipc.FilesEvent)[-1].files[0].crc
    assert crc == zlib.crc32(LOG, 0xFFFFFFFF) ^ 0xFFFFFFFF


def test_a_log_that_is_not_there_and_one_in_flight_are_not_read() -> None:
    flight = with_log("px4")
    assert flight.done(flight.say("log_read", item=99)) == "aborted BAD_PARAMETER"
    flight.hovering()
    for word in ("log_list", "log_read", "file_read"):
        ask_id = flight.say(word, path=PATHS["px4"])
        assert flight.done(ask_id) == "refused IN_AIR"


def test_a_reading_is_given_up_when_the_vehicle_is_armed() -> None:
    flight = with_log("px4").connected()
    put(flight.world.servers[0].store, PATHS["px4"], LOG * 50)
    reading = flight.say("file_read", path=PATHS["px4"])
    flight.run(0.1)
    flight.do("arm")
    assert flight.done(reading) == "aborted IN_AIR"


def test_what_an_operator_reads_ends_when_it_leaves() -> None:
    flight = with_log("px4").connected()
    put(flight.world.servers[0].store, PATHS["px4"], LOG * 50)
    flight.feed(inputs.OperatorJoined(2, "another", hold_on_leave=False))
    flight.feed(inputs.OperatorLine(2, ipc.Ask(1000, "file_read", path=PATHS["px4"])))
    flight.run(0.1)
    assert flight.done(flight.say("param_get", name="RTL_TYPE")) == "refused BUSY"
    flight.feed(inputs.OperatorGone(2, "its connection ended"))
    flight.run(0.1)
    assert flight.done(flight.say("param_get", name="RTL_TYPE")) == "complete"
