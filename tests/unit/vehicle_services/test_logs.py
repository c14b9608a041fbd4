"""The log protocol, against clients that list, download, lose frames and ask again."""

from __future__ import annotations

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.unit.vehicle_services.fake_vehicle import MS, Bench, FakeVehicle, S, of
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.effects import Client, Effect, Send
from vehicle_sim.flight_log.log_directory import LogDirectory
from vehicle_sim.flight_log.recorder import Recorder
from vehicle_sim.services.logs import DATA_BYTES, LogServer
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.streams import NEVER
from vehicle_sim.storage.store import MemoryStore, put
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import CODECS

ALL = 0xFFFFFFFF
LOG = bytes(random.Random(1).randrange(1, 256) for _ in range(20_050))


class Aboard:
    """A vehicle's log service with these logs in its store, and a clock."""

    def __init__(self, personality: Personality = "px4", *logs: bytes) -> None:
        self.vehicle = FakeVehicle()
        self.store = MemoryStore()
        self.first = PROFILES[personality].first_log
        root, suffix = (
            ("/fs/microsd/log/2024-05-01", "ulg") if personality == "px4" else ("/APM/LOGS", "BIN")
        )
        self.paths = [f"{root}/{number:08d}.{suffix}" for number in range(1, len(logs) + 1)]
        for path, log in zip(self.paths, logs, strict=True):
            put(self.store, path, log)
        profile = PROFILES[personality]
        shelf = LogDirectory(self.store, personality)
        parameters = Parameters(personality)
        recorder = Recorder(self.vehicle, parameters, shelf, (1, 0))
        self.server = LogServer(self.vehicle, profile, recorder)
        self.now_ns = 0

    def listed(self, start: int = 0, end: int = 0xFFFF, channel: int = 0) -> list[m.LogEntry]:
        told = self.ask(m.LogRequestList(start, end, 1, 1), channel)
        return of(told, m.LogEntry)

    def data(
        self, number: int, offset: int = 0, count: int = ALL, channel: int = 0
    ) -> list[m.LogData]:
        return datas(self.ask(m.LogRequestData(offset, count, number, 1, 1), channel))

    def end(self, channel: int = 0) -> None:
        self.ask(m.LogRequestEnd(1, 1), channel)

    def ask(
        self,
        message: m.LogRequestList | m.LogRequestData | m.LogErase | m.LogRequestEnd,
        channel: int = 0,
    ) -> list[m.Message]:
        client = Client(channel, 255, 190)
        return sent(self.server.handle(client, message, self.now_ns), channel)

    def wait(self, ns: int, channel: int = 0) -> list[m.LogData]:
        heard: list[m.LogData] = []
        end_ns = self.now_ns + ns
        while self.server.deadline_ns <= end_ns:
            self.now_ns = max(self.now_ns + 1, self.server.deadline_ns)
            heard += datas(sent(self.server.tick(self.now_ns), channel))
        self.now_ns = end_ns
        return heard


def sent(effects: list[Effect], channel: int) -> list[m.Message]:
    return [e.message for e in effects if isinstance(e, Send) and e.channel == channel]


def datas(heard: list[m.Message]) -> list[m.LogData]:
    return of(heard, m.LogData)


def joined(frames: list[m.LogData]) -> bytes:
    """What the frames carry; they must follow each other."""
    log = b""
    start = frames[0].ofs
    for frame in frames:
        assert frame.ofs == start + len(log)
        assert len(frame.data) == frame.count_ <= DATA_BYTES
        log += frame.data
    return log


BOTH = pytest.mark.parametrize("personality", ["px4", "ardupilot"])


@BOTH
def test_no_logs_are_one_entry_that_says_so(personality: Personality) -> None:
    """MAVSDK and QGroundControl wait for it."""
    assert Aboard(personality).listed() == [m.LogEntry(0, 0, 0, 0, 0)]


def test_px4_counts_its_logs_from_0_and_ardupilot_from_1() -> None:
    entries = Aboard("px4", b"one", b"three").listed()
    assert [(e.id, e.size, e.num_logs, e.last_log_num) for e in entries] == [
        (0, 3, 2, 1),
        (1, 5, 2, 1),
    ]
    entries = Aboard("ardupilot", b"one", b"three").listed()
    assert [(e.id, e.size, e.num_logs, e.last_log_num) for e in entries] == [
        (1, 3, 2, 2),
        (2, 5, 2, 2),
    ]


@BOTH
@pytest.mark.parametrize(
    ("start", "end", "answered"),
    [(0, 0xFFFF, [0, 1, 2, 3]), (1, 2, [1, 2]), (2, 2, [2]), (3, 99, [3]), (50, 60, [3])],
)
def test_a_part_of_the_list(
    personality: Personality, start: int, end: int, answered: list[int]
) -> None:
    aboard = Aboard(personality, b"a", b"b", b"c", b"d")
    first = aboard.first
    entries = aboard.listed(start + first, end + first if end < 0xFFFF else end)
    assert [entry.id - first for entry in entries] == answered
    assert {entry.num_logs for entry in entries} == {4}


@BOTH
def test_a_whole_log_comes_in_order_and_unchanged(personality: Personality) -> None:
    aboard = Aboard(personality, b"other", LOG)
    number = aboard.listed()[-1].id
    frames = aboard.data(number) + aboard.wait(1 * S)
    assert joined(frames) == LOG
    assert {frame.id for frame in frames} == {number}
    assert frames[-1].count_ == len(LOG) % DATA_BYTES
    assert aboard.server.deadline_ns == NEVER


def test_it_is_paced_and_fast_enough() -> None:
    aboard = Aboard("px4", LOG * 20)
    at_once = aboard.data(0)
    soon = aboard.wait(100 * MS)
    assert len(at_once) == 8
    assert 390 <= len(soon) <= 410, "four a millisecond"


def test_a_late_tick_does_not_bring_everything_at_once() -> None:
    aboard = Aboard("px4", LOG * 20)
    aboard.data(0)
    assert len(datas(sent(aboard.server.tick(10 * S), 0))) == 32


def test_ranges_are_honoured() -> None:
    aboard = Aboard("px4", LOG)
    frames = aboard.data(0, 900, 4500) + aboard.wait(1 * S)
    assert joined(frames) == LOG[900:5400]
    frames = aboard.data(0, 900, 100) + aboard.wait(1 * S)
    assert [(frame.ofs, frame.count_) for frame in frames] == [(900, 90), (990, 10)]


@BOTH
@pytest.mark.parametrize("offset", [len(LOG), len(LOG) + 1, ALL])
def test_past_the_end_it_reads_empty(personality: Personality, offset: int) -> None:
    aboard = Aboard(personality, LOG)
    (frame,) = aboard.data(aboard.first, offset) + aboard.wait(1 * S)
    assert (frame.ofs, frame.count_) == (offset, 0)


def test_a_log_that_ends_with_a_full_frame_is_ended_by_asking_on() -> None:
    """MAVProxy waits for a short frame, then asks for what follows the last one."""
    aboard = Aboard("px4", LOG[:1800])
    frames = aboard.data(0) + aboard.wait(1 * S)
    assert frames[-1].count_ == DATA_BYTES
    (last,) = aboard.data(0, 1800)
    assert last.count_ == 0


def test_a_request_for_nothing_is_answered_with_nothing() -> None:
    (frame,) = Aboard("px4", LOG).data(0, 90, 0)
    assert (frame.ofs, frame.count_) == (90, 0)


@BOTH
@pytest.mark.parametrize("number", [7, 0xFFFF])
def test_a_log_that_there_is_not_is_not_answered(personality: Personality, number: int) -> None:
    aboard = Aboard(personality, LOG)
    assert aboard.data(number) + aboard.wait(1 * S) == []


def test_ardupilot_has_no_log_0() -> None:
    assert Aboard("ardupilot", LOG).data(0) == []


def test_a_new_request_takes_the_place_of_the_old() -> None:
    aboard = Aboard("px4", LOG, LOG[::-1])
    aboard.data(0)
    frames = aboard.data(1) + aboard.wait(1 * S)
    assert {frame.id for frame in frames} == {1}
    assert joined(frames) == LOG[::-1]


def test_a_list_or_a_request_for_no_log_stops_it() -> None:
    aboard = Aboard("px4", LOG)
    aboard.data(0)
    assert len(aboard.listed()) == 1
    assert aboard.wait(1 * S) == []
    aboard.data(0)
    aboard.data(9)
    assert aboard.wait(1 * S) == []


def test_end_stops_it() -> None:
    aboard = Aboard("px4", LOG)
    aboard.data(0)
    aboard.end()
    assert aboard.wait(1 * S) == []
    assert aboard.server.deadline_ns == NEVER


def test_two_channels_do_not_disturb_each_other() -> None:
    aboard = Aboard("px4", LOG)
    one = aboard.data(0, channel=1)
    aboard.data(0, channel=2)
    aboard.server.forget(2)
    assert joined(one + aboard.wait(1 * S, channel=1)) == LOG


def test_erase_removes_all() -> None:
    aboard = Aboard("px4", LOG, LOG)
    aboard.data(0)
    aboard.ask(m.LogErase(1, 1))
    assert aboard.wait(1 * S) == []
    assert [entry.num_logs for entry in aboard.listed()] == [0]
    assert aboard.store.used_bytes == 0


def test_numbers_stand_for_the_same_logs_until_the_next_list() -> None:
    aboard = Aboard("px4", b"old", LOG)
    aboard.listed()
    aboard.store.remove(aboard.paths[0])
    assert joined(aboard.data(1) + aboard.wait(1 * S)) == LOG
    assert aboard.data(0)[0].count_ == 0, "that one is gone"
    aboard.listed()
    assert joined(aboard.data(0) + aboard.wait(1 * S)) == LOG


def test_a_log_that_is_removed_meanwhile_ends_there() -> None:
    aboard = Aboard("px4", LOG)
    aboard.data(0)
    aboard.store.remove(aboard.paths[0])
    assert [frame.count_ for frame in aboard.wait(1 * S)] == [0]


def test_ardupilot_sends_no_logs_in_flight_and_says_it_once() -> None:
    aboard = Aboard("ardupilot", LOG)
    aboard.data(1)
    aboard.vehicle.armed = True
    (text,) = aboard.ask(m.LogRequestList(0, 0xFFFF, 1, 1))
    assert isinstance(text, m.Statustext)
    assert (text.severity, text.text) == (3, b"Disarm for log download")
    assert aboard.data(1) + aboard.wait(1 * S) == []
    assert aboard.listed() == []
    aboard.vehicle.armed = False
    assert len(aboard.listed()) == 1
    aboard.vehicle.armed = True
    assert len(aboard.ask(m.LogRequestList(0, 0xFFFF, 1, 1))) == 1


def test_px4_sends_the_log_of_the_flight_as_far_as_it_was_listed() -> None:
    bench = Bench("px4")
    bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3))
    bench.vehicle.armed = True
    bench.advance(2 * S)
    (entry,) = [e for e in bench.send(m.LogRequestList(0, 0xFFFF, 1, 1)) if is_entry(e)]
    assert isinstance(entry, m.LogEntry)
    heard = bench.send(m.LogRequestData(0, ALL, 0, 1, 1)) + bench.advance(1 * S)
    log = b"".join(frame.data[: frame.count_] for frame in datas(heard))
    assert len(log) == entry.size
    assert log.startswith(b"ULog")


def is_entry(message: m.Message) -> bool:
    return isinstance(message, m.LogEntry)


def lossy_download(aboard: Aboard, number: int, loss: float, seed: int) -> bytes:
    """As MAVProxy does it: all at once, then up to 20 holes each 0.7 s."""
    chance = random.Random(seed)
    chunks: dict[int, bytes] = {}
    ended = False

    def hear(frames: list[m.LogData]) -> None:
        nonlocal ended
        for frame in frames:
            if chance.random() >= loss:
                if frame.count_:
                    chunks[frame.ofs // DATA_BYTES] = frame.data
                short = frame.count_ < DATA_BYTES
                ended = short and len(chunks) >= -(-(frame.ofs + frame.count_) // DATA_BYTES)

    hear(aboard.data(number))
    for _ in range(200):
        hear(aboard.wait(700 * MS))
        if ended:
            return b"".join(chunks[index] for index in sorted(chunks))
        missing = sorted(set(range(max(chunks, default=0))) - set(chunks))
        if not missing:
            hear(aboard.data(number, (max(chunks, default=-1) + 1) * DATA_BYTES))
        for index in missing[:20]:
            hear(aboard.data(number, index * DATA_BYTES, DATA_BYTES))
    raise AssertionError("never whole")


@BOTH
@pytest.mark.parametrize("loss", [0.1, 0.3, 0.6])
def test_a_client_that_fills_its_holes_gets_the_whole_log(
    personality: Personality, loss: float
) -> None:
    aboard = Aboard(personality, LOG)
    assert lossy_download(aboard, aboard.first, loss, seed=3) == LOG


def test_many_small_holes_asked_for_in_a_row_are_all_answered() -> None:
    aboard = Aboard("px4", LOG)
    frames = [
        frame
        for index in range(0, 200, 10)
        for frame in aboard.data(0, index * DATA_BYTES, DATA_BYTES)
    ]
    assert [frame.ofs // DATA_BYTES for frame in frames] == list(range(0, 200, 10))


number16 = st.integers(0, 0xFFFF)
number32 = st.integers(0, ALL)
request = st.one_of(
    st.builds(m.LogRequestList, number16, number16, st.just(1), st.just(1)),
    st.builds(
        m.LogRequestData,
        st.one_of(number32, st.integers(0, 30_000)),
        number32,
        st.one_of(st.integers(0, 3), number16),
        st.just(1),
        st.just(1),
    ),
    st.just(m.LogRequestEnd(1, 1)),
    st.just(m.LogErase(1, 1)),
)


@BOTH
@given(asked=st.lists(st.tuples(request, st.integers(0, 2), st.integers(0, 50 * MS)), max_size=30))
def test_no_requests_upset_it(
    personality: Personality, asked: list[tuple[m.LogRequestData, int, int]]
) -> None:
    aboard = Aboard(personality, LOG, b"second")
    for message, channel, nap_ns in asked:
        effects = aboard.server.handle(Client(channel, 255, 190), message, aboard.now_ns)
        aboard.now_ns += nap_ns
        effects += aboard.server.tick(aboard.now_ns)
        messages = [effect.message for effect in effects if isinstance(effect, Send)]
        assert len(messages) <= 8 + 3 * 32
        for told in messages:
            CODECS[m.IDS[type(told)]].payload(told)  # every field fits
    for channel in range(3):
        aboard.server.forget(channel)
    assert aboard.server.deadline_ns == NEVER


def test_the_vehicle_knows_of_a_download_until_it_has_ended() -> None:
    """ArduCopter does not arm meanwhile (J2_logs)."""
    aboard = Aboard("ardupilot", LOG)
    told = aboard.vehicle.downloads
    aboard.listed()
    assert not any(told)
    aboard.data(1)
    assert told[-1]
    aboard.end()
    assert not told[-1]
