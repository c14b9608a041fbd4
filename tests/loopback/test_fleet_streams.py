"""Several vehicles behind one bridge: streams, sticks and parameters of one are not another's."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.states import State
from tests.loopback.bridged import Client
from tests.loopback.fleet import Fleet

VELOCITY_ONLY = 0xDC7


def streams(flight: Fleet, client: Client, v_north: dict[int, float], seconds: float) -> None:
    """A velocity stream for each system id that is named, 20 samples a second."""
    for count in range(round(seconds * 20)):
        for sysid, v_n in v_north.items():
            client.send(
                dialect.MAVLink_set_position_target_local_ned_message(
                    0, sysid, 1, 1, VELOCITY_ONLY, 0, 0, 0, v_n, 0, 0, 0, 0, 0, 0, 0
                )
            )
        if count % 20 == 0:
            client.beat()
        flight.run(0.05)


def test_one_client_streams_to_both_at_once() -> None:
    flight = Fleet()
    client = flight.all_flying()
    streams(flight, client, {1: 2.0, 2: -2.0}, 5)
    assert [flight.state_of(n) for n in (1, 2)] == [State.STREAMING] * 2
    assert flight.place_enu(1)[1] > 5
    assert flight.place_enu(2)[1] < -5


@pytest.mark.parametrize("sysid", [1, 2])
def test_a_stream_for_one_leaves_the_other_where_it_is(sysid: int) -> None:
    flight = Fleet()
    client = flight.all_flying()
    before = flight.place_enu(3 - sysid)
    streams(flight, client, {sysid: 2.0}, 4)
    assert flight.state_of(sysid) is State.STREAMING
    assert flight.state_of(3 - sysid) is State.HOVERING
    assert flight.place_enu(3 - sysid) == pytest.approx(before, abs=0.5)


def test_a_stream_of_one_that_is_refused_is_told_in_its_name_and_the_other_flies_on() -> None:
    flight = Fleet()
    client = flight.all_flying()
    streams(flight, client, {1: 1.0, 2: 90.0}, 2)
    assert flight.state_of(1) is State.STREAMING
    assert flight.place_enu(2)[1] == pytest.approx(0, abs=1.0)
    told = [
        (text.get_srcSystem(), text.text)
        for text in client.messages("STATUSTEXT")
        if text.text.startswith("stream: ")
    ]
    assert [(sysid, text.split(" ")[1]) for sysid, text in told] == [
        (1, "flown"),
        (2, "refused"),
    ]


def test_sticks_fly_the_vehicle_that_they_name() -> None:
    flight = Fleet(("px4", "px4"))
    client = flight.all_flying()
    before = flight.place_enu(1)
    for count in range(100):
        x = 500 if count > 10 else 0  # they count once they were in the middle
        client.send(dialect.MAVLink_manual_control_message(2, x, 0, 500, 0, 0))
        if count % 25 == 0:
            client.beat()
        flight.run(0.04)
    assert flight.place_enu(1) == pytest.approx(before, abs=0.5)
    assert flight.state_of(1) is State.HOVERING
    assert flight.state_of(2) is State.STREAMING, client.texts()
    assert sum(abs(x) for x in flight.place_enu(2)[:2]) > 1.0


@pytest.mark.parametrize("sysid", [1, 2])
def test_a_guarded_parameter_is_refused_in_the_name_of_the_vehicle_and_its_own_value_told(
    sysid: int,
) -> None:
    """GF_ACTION and FENCE_ACTION: what the vehicle does at its own fence."""
    flight = Fleet()
    client = flight.join()
    flight.all_connected()
    name = {1: b"GF_ACTION", 2: b"FENCE_ACTION"}[sysid]
    before = flight.vehicles[sysid].parameters.get(name.decode())
    client.heard.clear()  # the station itself has asked for it at the start
    client.send(dialect.MAVLink_param_set_message(sysid, 1, name, 0, 9))
    flight.run(0.5)
    assert flight.to_vehicle("PARAM_SET") == []
    told = [
        (value.get_srcSystem(), value.param_value)
        for value in client.messages("PARAM_VALUE")
        if value.param_id == name.decode()
    ]
    assert [source for source, _ in told] == [sysid]
    assert flight.vehicles[sysid].parameters.get(name.decode()) == before
