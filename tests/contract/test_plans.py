"""Missions, fences and rally points: how they come, go back, and are flown."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction

import pytest
from pymavlink.dialects.v20 import all as mavlink

from tests.contract.client import ACCEPTED, BOTH, MS, NAN, Client, Message, connected
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.simulation.impairment import Impairment

either = pytest.mark.parametrize("personality", BOTH)
ERROR, MAV_UNSUPPORTED = 1, 3
OK, UNSUPPORTED, NO_SPACE, INVALID_SEQUENCE, DENIED, CANCELLED = 0, 3, 4, 13, 14, 15
BAD_LINK = Impairment(loss=0.3, duplicate=0.2, delay_ns=250 * MS, jitter_ns=30 * MS)


class Planner:
    """Speaks the mission protocol in the integer or in the float form."""

    def __init__(self, client: Client, kind: int = 0, floats: bool = False) -> None:
        self.client = client
        self.kind = kind
        self.floats = floats

    def item(
        self,
        seq: int,
        command: int,
        north_m: float = 0.0,
        up_m: float = 0.0,
        *params: float,
        frame: int = 6,
    ) -> Message:
        home = self.client.sky.home
        p = (*params, *(0.0, 0.0, 0.0, NAN)[len(params) :])
        lat = home.lat_deg + north_m / 111_319.5
        if self.floats:
            plain = {6: 3, 5: 0}.get(frame, frame)
            return mavlink.MAVLink_mission_item_message(
                1, 1, seq, plain, command, 0, 1, *p, lat, home.lon_deg, up_m, self.kind
            )
        x, y = round(lat * 1e7), round(home.lon_deg * 1e7)
        if frame == 2:
            x = y = 0
        return mavlink.MAVLink_mission_item_int_message(
            1, 1, seq, frame, command, 0, 1, *p, x, y, up_m, self.kind
        )

    def shifted(self, make: Callable[[int], Message], count: int) -> list[Message]:
        """With home in front where the personality keeps it."""
        if self.client.sky.personality == "px4" or self.kind:
            return [make(seq) for seq in range(count)]
        return [self.item(0, 16), *(make(seq) for seq in range(1, count + 1))]

    def upload(self, items: list[Message], patience_s: float = 1.0, tries: int = 1) -> int:
        """Answers requests until the ack comes; its result."""
        client = self.client
        client.forget()
        count = mavlink.MAVLink_mission_count_message(1, 1, len(items), self.kind)
        last = count
        client.send(last)
        answered, silent_since, left = 0, client.sky.now_ns, tries
        while True:
            acks = client.all("MISSION_ACK")
            if acks:
                assert acks[-1].mission_type == self.kind
                return int(acks[-1].type)
            asked = client.all("MISSION_REQUEST") + client.all("MISSION_REQUEST_INT")
            if asked:
                last = items[asked[-1].seq]
                answered, silent_since, left = answered + 1, client.sky.now_ns, tries
                client.forget()
                client.send(last)
            elif client.sky.now_ns - silent_since >= patience_s * 1e9:
                left -= 1
                assert left >= 0, f"silence after {answered} items"
                silent_since = client.sky.now_ns
                client.send(last)
            else:
                client.sky.run(0.02)

    def download(self) -> list[Message]:
        client = self.client
        (told,) = client.send(mavlink.MAVLink_mission_request_list_message(1, 1, self.kind))
        items = []
        for seq in range(told.count):
            asked = mavlink.MAVLink_mission_request_int_message(1, 1, seq, self.kind)
            if self.floats:
                asked = mavlink.MAVLink_mission_request_message(1, 1, seq, self.kind)
            (item,) = client.send(asked)
            items.append(item)
        client.send(mavlink.MAVLink_mission_ack_message(1, 1, 0, self.kind))
        return items


@either
@pytest.mark.parametrize("floats", [False, True])
@pytest.mark.parametrize(
    ("kind", "command", "params"), [(0, 16, ()), (1, 5003, (40.0,)), (2, 5100, ())]
)
def test_plans_are_taken_whole(
    personality: Personality, floats: bool, kind: int, command: int, params: tuple[float, ...]
) -> None:
    """MISSION_COUNT, types mission / fence / rally."""
    client = connected(personality)
    planner = Planner(client, kind, floats)

    def make(seq: int) -> Message:
        return planner.item(seq, command, 10.0 * seq, 20.0, *params, frame=6)

    items = planner.shifted(make, 4)
    assert planner.upload(items) == OK
    back = planner.download()
    assert [each.command for each in back[-4:]] == [command] * 4
    bad = planner.shifted(make, 4)
    bad[2] = planner.item(2, 9999, 10.0, 20.0)
    assert planner.upload(bad) == UNSUPPORTED
    assert any(text.startswith("item 2: ") for text in client.texts())
    assert len(planner.download()) == len(items), "the old plan is whole"
    assert planner.upload([]) == OK
    assert planner.download() == []


@either
def test_an_upload_that_stalls_is_cancelled(personality: Personality) -> None:
    client = connected(personality)
    client.forget()
    client.send(mavlink.MAVLink_mission_count_message(1, 1, 3, 0))
    client.sky.run(30.0)
    asked = client.all("MISSION_REQUEST") + client.all("MISSION_REQUEST_INT")
    assert len(asked) > 5
    assert {each.seq for each in asked} == {0}
    assert [each.type for each in client.all("MISSION_ACK")] == [CANCELLED]
    too_many = mavlink.MAVLink_mission_count_message(1, 1, 60_000, 0)
    assert [each.type for each in client.send(too_many)] == [NO_SPACE]


@either
@pytest.mark.parametrize("seed", [1])
def test_500_items_over_30_percent_loss_and_half_a_second(
    personality: Personality, seed: int
) -> None:
    # Links and transfers live on wall time: a vehicle that only stands there may live slowly.
    client = connected(personality, speedup=Fraction(1, 10))
    # The impairments of a link are drawn by the datagram's number: another seed, another start.
    client.sky.run(0.5 * seed)
    client.sky.world.impair(None, None, BAD_LINK)
    planner = Planner(client)
    items = planner.shifted(lambda seq: planner.item(seq, 16, 1.0 * seq, 20.0), 500)
    assert planner.upload(items, 0.7, 100) == OK
    client.sky.world.impair(None, None, Impairment())
    client.sky.run(1.0)
    client.forget()
    assert len(planner.download()) == len(items)


@either
def test_requests_are_of_the_personalitys_form(personality: Personality) -> None:
    """personality."""
    client = connected(personality)
    count = mavlink.MAVLink_mission_count_message(1, 1, 2, 0)
    (first,) = client.send(count)
    assert first.get_type() == "MISSION_REQUEST"
    planner = Planner(client)
    (second,) = client.send(planner.item(0, 16, 0.0, 5.0))
    expected = "MISSION_REQUEST_INT" if personality == "px4" else "MISSION_REQUEST"
    assert second.get_type() == expected


@either
def test_items_come_back_in_the_form_that_was_asked_for(personality: Personality) -> None:
    """MISSION_REQUEST_LIST, MISSION_REQUEST, MISSION_REQUEST_INT."""
    client = connected(personality)
    planner = Planner(client)
    items = planner.shifted(lambda seq: planner.item(seq, 16, 10.0 * seq, 20.0, 3.0), 3)
    assert planner.upload(items) == OK
    for seq in (2, 0, 1, 2):
        (back,) = client.send(mavlink.MAVLink_mission_request_int_message(1, 1, seq, 0))
        assert (back.get_type(), back.seq) == ("MISSION_ITEM_INT", seq)
    if personality == "ardupilot":
        (home,) = client.send(mavlink.MAVLink_mission_request_int_message(1, 1, 0, 0))
        assert (home.frame, home.command) == (0, 16)
        assert home.z == pytest.approx(client.sky.home.alt_amsl_m, abs=1.5)
    (old,) = client.send(mavlink.MAVLink_mission_request_message(1, 1, 1, 0))
    assert old.get_type() == ("MISSION_ITEM_INT" if personality == "px4" else "MISSION_ITEM")
    assert (old.param1, old.z) == (3.0, 20.0)
    assert old.frame == (6 if personality == "px4" else 3)
    (refused,) = client.send(mavlink.MAVLink_mission_request_int_message(1, 1, 99, 0))
    out_of_range = ERROR if personality == "px4" else INVALID_SEQUENCE
    assert (refused.get_type(), refused.type) == ("MISSION_ACK", out_of_range)


@either
def test_plans_are_cleared_and_items_made_current(personality: Personality) -> None:
    """MISSION_CLEAR_ALL, MISSION_SET_CURRENT, DO_SET_MISSION_CURRENT."""
    client = connected(personality)
    planner = Planner(client)
    items = planner.shifted(lambda seq: planner.item(seq, 16, 10.0 * seq, 20.0), 3)
    assert planner.upload(items) == OK
    client.send(mavlink.MAVLink_mission_set_current_message(1, 1, 2))
    current = client.last("MISSION_CURRENT")
    if personality == "px4":  # a 1.14 tells its item alone, and nothing without a mission
        assert (current.seq, current.total, current.mission_state) == (2, 0, 0)
        assert client.long(224, 1) == [MAV_UNSUPPORTED], "not in PX4 1.14"
    else:
        assert (current.seq, current.total) == (2, 3)
        assert current.mission_state == mavlink.MISSION_STATE_NOT_STARTED
        assert client.long(224, 1) == [ACCEPTED]
        client.sky.run(1.5)
        assert client.request_message(42)[1][0].seq == 1
        assert client.long(224, 99) != [ACCEPTED]
    (refused,) = client.send(mavlink.MAVLink_mission_set_current_message(1, 1, 99))
    assert refused.type == INVALID_SEQUENCE
    (cleared,) = client.send(mavlink.MAVLink_mission_clear_all_message(1, 1, 255))
    assert (cleared.type, cleared.mission_type) == (OK, 255)
    assert planner.download() == []
    client.forget()
    client.sky.run(1.5)
    if personality == "px4":
        assert not client.all("MISSION_CURRENT")
    else:
        client.request_message(42)
        state = client.last("MISSION_CURRENT").mission_state
        assert state == mavlink.MISSION_STATE_NO_MISSION


@either
def test_a_mission_is_flown_and_told_of(personality: Personality) -> None:
    """items flown."""
    client = connected(personality, parameters={"CAM_EXPOSURE_S": 0.2})
    planner = Planner(client)
    ardupilot = personality == "ardupilot"
    smooth = [(82, 20.0, ())] if ardupilot else []
    delays = [(112, 0.0, (1.0,))] if ardupilot else []  # PX4 stores conditions: it flies none
    turns = [(115, 0.0, (90.0, 60.0, 1.0, 0.0))] if ardupilot else []
    rows: list[tuple[int, float, tuple[float, ...]]] = [
        (22, 0.0, ()),
        (530, 0.0, (0.0, 0.0)),
        (178, 0.0, (1.0, 4.0, -1.0)),
        (16, 10.0, (1.0,)),
        *delays,
        (2000, 0.0, (0.0, 0.0, 1.0)),
        *turns,
        *smooth,
        (195, 60.0, ()),
        (206, 0.0, (3.0, 0.0, 1.0)),
        (16, 30.0, ()),
        (206, 0.0, (0.0,)),
        (197, 0.0, ()),
        (93, 0.0, (2.0,)),
        (19, 30.0, (2.0,)),
        (18, 30.0, (1.0, 0.0, 6.0)),
        (205, 0.0, ()),
        (203, 0.0, ()),
        (1000, 0.0, ()),
        (2001, 0.0, ()),
        (5000, 0.0, ()),
        (207, 0.0, (0.0,)),
        (179, 0.0, (1.0,)),
        (177, 0.0, (0.0, 0.0)),
        (21, 30.0, ()),
    ]
    # A PX4 takes these in frame 2 alone.
    plain = {530, 178, 112, 2000, 115, 206, 197, 93, 205, 203, 1000, 2001, 5000, 207, 179, 177}

    def make(seq: int) -> Message:
        command, north_m, params = rows[seq - (personality == "ardupilot")]
        if command == 177:
            params = (1.0, 0.0)
        frame = 2 if command in plain else 6
        return planner.item(seq, command, north_m, 8.0, *params, frame=frame)

    assert planner.upload(planner.shifted(make, len(rows))) == OK
    if personality == "ardupilot":
        client.send(mavlink.MAVLink_request_data_stream_message(1, 1, 0, 4, 1))
        assert client.long(176, 1, 4) == [ACCEPTED]
        assert client.long(400, 1) == [ACCEPTED]
    assert client.long(300, 0, 0) == [ACCEPTED]
    client.forget()
    client.sky.run(240.0, lambda: not client.sky.truth().armed)
    first = 1 if personality == "ardupilot" else 0
    flown = [
        seq
        for seq, (command, _, _) in enumerate(rows, first)
        if command in (16, 18, 19, 21, 22, 82, 93)
    ]
    told = dict.fromkeys(each.seq for each in client.all("MISSION_ITEM_REACHED"))
    assert [seq for seq in told if seq in flown] == flown
    if personality == "ardupilot":
        assert list(told) == flown
    assert len(client.all("CAMERA_IMAGE_CAPTURED")) >= 3
    assert client.sky.truth().pos_ned[0] == pytest.approx(30.0, abs=2.5)
    speeds = [math.hypot(e.vx, e.vy) / 100.0 for e in client.all("GLOBAL_POSITION_INT")]
    assert 3.0 < max(speeds) < 5.0
    states = {each.mission_state for each in client.all("MISSION_CURRENT")}
    if ardupilot:
        assert states >= {mavlink.MISSION_STATE_ACTIVE, mavlink.MISSION_STATE_COMPLETE}
    else:
        assert states == {0}, "a PX4 1.14 tells its item alone"


TAKEN = {("px4", 177), ("ardupilot", 94), ("ardupilot", 183), ("ardupilot", 16)}
"""PX4 tells of the jump when it arms; ArduCopter stores payloads, servos and heights above terrain
(scenario C8)."""


@either
@pytest.mark.parametrize(
    ("command", "frame", "params"),
    [
        (83, 6, ()),
        (94, 6, ()),
        (113, 2, (1.0,)),
        (183, 2, (1.0, 1500.0)),
        (16, 10, ()),
        (93, 2, (-1.0, 12.0, 0.0, 0.0)),
        (177, 2, (77.0, 1.0)),
    ],
)
def test_what_cannot_be_flown_is_refused_by_name(
    personality: Personality, command: int, frame: int, params: tuple[float, ...]
) -> None:
    client = connected(personality)
    planner = Planner(client)
    items = planner.shifted(lambda seq: planner.item(seq, 16, 10.0 * seq, 20.0), 3)
    items[2] = planner.item(2, command, 10.0, 20.0, *params, frame=frame)
    if (personality, command) in TAKEN:
        assert planner.upload(items) == OK
        return
    assert planner.upload(items) == UNSUPPORTED
    assert any(text.startswith("item 2: ") for text in client.texts())


def test_dronekits_simple_goto_is_flown() -> None:
    """MISSION_ITEM with current = 2."""
    client = connected("ardupilot")
    client.take_off(10.0)
    lat = client.sky.home.lat_deg + 1.5e-4
    goto = mavlink.MAVLink_mission_item_message(
        1, 1, 0, 3, 16, 2, 0, 0, 0, 0, 0, lat, client.sky.home.lon_deg, 12.0, 0
    )
    (ack,) = client.send(goto)
    assert (ack.get_type(), ack.type) == ("MISSION_ACK", OK)
    client.sky.run(12.0)
    north, _, down = client.sky.truth().pos_ned
    assert (north, down) == pytest.approx((16.7, -12.0), abs=1.5)


def test_mavproxy_moves_one_waypoint() -> None:
    client = connected("ardupilot")
    planner = Planner(client)
    items = planner.shifted(lambda seq: planner.item(seq, 16, 10.0 * seq, 20.0), 3)
    assert planner.upload(items) == OK
    (asked,) = client.send(mavlink.MAVLink_mission_write_partial_list_message(1, 1, 2, 2, 0))
    assert (asked.get_type(), asked.seq) == ("MISSION_REQUEST", 2)
    heard = client.send(planner.item(2, 16, 20.0, 55.0))
    assert [each.type for each in heard if each.get_type() == "MISSION_ACK"] == [OK]
    assert [each.z for each in planner.download()[1:]] == [20.0, 55.0, 20.0]
