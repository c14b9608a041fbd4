"""Whatever an operator says who only looks: nothing fails, and nothing but a stop is sent."""

from __future__ import annotations

from typing import get_args

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs import ipc
from gcs.request_words import REQUESTS
from gcs.session.inputs import OperatorJoined, OperatorLine, OperatorNoise
from tests.unit.station import told
from tests.unit.station.station import Script

WORDS = sorted(REQUESTS.keys() - {"station_take"})
STOPS = {(176, 4.0, 3.0), (176, 4.0, 5.0), (176, 4.0, 6.0)}
"""DO_SET_MODE to px4's AUTO.LOITER, AUTO.RTL and AUTO.LAND."""
LAND, DISARM = 21, 400
OWN = {511, 512}
"""SET_MESSAGE_INTERVAL, REQUEST_MESSAGE: the station's own questions."""

numbers = st.one_of(st.none(), st.floats(), st.floats(-5.0, 5.0))
asks = st.builds(
    ipc.Ask,
    id=st.integers(),
    word=st.one_of(st.sampled_from(WORDS), st.text()),
    goal_enu=st.one_of(st.none(), st.tuples(numbers, numbers, numbers)),
    yaw_deg=numbers,
    up_m=numbers,
    mode=st.one_of(st.sampled_from(("AUTO.MISSION", "AUTO.LAND", "OFFBOARD")), st.text()),
    force=st.booleans(),
    on=st.booleans(),
    path=st.text(),
    operation=st.integers(-1, 12),
    lease_s=numbers,
)
commands = st.one_of(
    asks,
    st.builds(ipc.Subscribe, st.lists(st.one_of(st.just("HEARTBEAT"), st.text()))),
    st.builds(ipc.ListOperations, st.integers()),
    st.builds(ipc.WatchTopics),
    st.builds(ipc.Check, asks),
    st.builds(ipc.Renew, st.integers()),
    st.builds(ipc.Note, st.text()),
    st.builds(ipc.Preflight, st.integers(), st.integers(-1, 3)),
    st.builds(ipc.Show, st.integers(-1, 3)),
    st.builds(ipc.Join, st.text()),
    st.builds(
        ipc.Stream,
        *[st.one_of(st.none(), st.tuples(numbers, numbers, numbers))] * 3,
        yaw_deg=numbers,
        yaw_rate_deg_s=numbers,
    ),
    st.builds(ipc.Pending, st.tuples(st.floats(), st.floats(), st.floats())),
)


def over_the_socket(command: ipc.Command) -> ipc.Command | None:
    """As it arrives; None for what JSON cannot carry."""
    try:
        return ipc.decode_command(ipc.encode(command))
    except (msgspec.DecodeError, UnicodeEncodeError, OverflowError):
        return None


@pytest.mark.slow
@given(st.lists(commands, max_size=25))
def test_one_who_looks_can_stop_the_vehicle_and_nothing_else(said: list[ipc.Command]) -> None:
    script = Script().hovering()
    script.feed(OperatorJoined(2, "anybody"))
    script.forget()
    for command in said:
        arrived = over_the_socket(command)
        if arrived is None:
            script.feed(OperatorNoise(2, "no command"))
        else:
            script.feed(OperatorLine(2, arrived))
    for message in script.sent("COMMAND_LONG"):
        stop = (message.command, message.param2, message.param3) in STOPS
        assert stop or message.command in {LAND, DISARM, *OWN}, message
    assert script.sent("SET_POSITION_TARGET_LOCAL_NED") == []
    assert told.files(script.told) == []
    asked = sum(isinstance(command, ipc.Ask) for command in said)
    assert len(told.verdicts(script.told)) <= asked
    assert told.finishes(script.told) == []
    for effect in script.told:
        if hasattr(effect, "event"):
            ipc.encode(effect.event)


def test_every_kind_of_command_is_tried() -> None:
    kinds = set(get_args(ipc.Command)) - {ipc.Leave}
    assert kinds == {
        ipc.Ask,
        ipc.Stream,
        ipc.Subscribe,
        ipc.ListOperations,
        ipc.Check,
        ipc.Renew,
        ipc.Note,
        ipc.Preflight,
        ipc.Show,
        ipc.Join,
        ipc.Pending,
        ipc.WatchTopics,
    }
