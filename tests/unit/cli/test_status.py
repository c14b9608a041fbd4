"""`gcs status`: the rows of its table."""

from __future__ import annotations

import json

import msgspec
import pytest

from gcs import ipc
from gcs.cli.status import rows, show
from tests.unit.operator.fake_station import FakeStation


def test_a_heading_goes_round_and_a_rate_not_measured_is_left_out() -> None:
    seen = msgspec.structs.replace(FakeStation().snapshot(), yaw_deg=359.7, rx_hz=0.0)
    shown = dict(rows(seen, 1))
    assert shown["heading"] == "0 deg"
    assert shown["link"] == "0.0 % lost"


def test_other_vehicles_that_are_heard_are_named() -> None:
    seen = FakeStation().snapshot()
    two = msgspec.structs.replace(seen, vehicles=[seen.vehicle, "2/1 ardupilot quadrotor"])
    assert dict(rows(two, 1))["also heard"] == "2/1 ardupilot quadrotor"
    alone = msgspec.structs.replace(seen, vehicles=[seen.vehicle])
    assert "also heard" not in dict(rows(alone, 1))


def test_every_vehicle_of_a_bridge_is_shown() -> None:
    seen = FakeStation().snapshot()
    name = "2/1 ardupilot quadrotor"
    two = msgspec.structs.replace(seen, vehicles=[seen.vehicle, name, "3/1 px4 quadrotor"])
    first = ipc.BridgeVehicle(1, seen.vehicle, "HOVERING", "OURS", "NOMINAL")
    second = ipc.BridgeVehicle(
        2, name, "MOVING", "OURS", "CAUTION", ["too_close"], "GUIDED", True, lost_pct=1.2,
        silent_s=0.14, pos_enu=(1.0, -2.0, 10.0), v_enu=(3.0, 4.0, 0.0), battery_pct=71.0,
    )  # fmt: skip
    shown = dict(rows(two, 1, ipc.BridgeStatus(0, [], [], [first, second])))
    assert shown["vehicle 2"].splitlines() == [
        "2/1 ardupilot quadrotor: MOVING, control OURS, CAUTION (too_close)",
        "GUIDED, armed, battery 71 %, heard 0.1 s ago, 1.2 % lost",
        "E +1.00 N -2.00 U +10.00 m, 5.00 m/s",
    ]
    assert shown["also heard"] == "3/1 px4 quadrotor", "heard, and not met yet"
    assert "vehicle 1" not in shown


def test_clients_that_are_not_verified_are_shown() -> None:
    seen = FakeStation().snapshot()
    clients = [
        ipc.BridgeClient(1000, 1, "udp 127.0.0.1:5001", signed="signed"),
        ipc.BridgeClient(0, 2, "udp 127.0.0.1:5002", signed="3 unsigned", verified=False),
        ipc.BridgeClient(0, 3, "tcp 127.0.0.1:5003", verified=False),
    ]
    shown = dict(rows(seen, 1, ipc.BridgeStatus(0, [], clients)))
    assert shown["not verified"].splitlines() == [
        "client udp 127.0.0.1:5002: 3 unsigned",
        "client tcp 127.0.0.1:5003: nothing came yet",
    ]
    assert "not verified" not in dict(rows(seen, 1, ipc.BridgeStatus(0, [], clients[:1])))


def test_unknown_values_are_dashes() -> None:
    shown = dict(rows(FakeStation("silent").snapshot(), 1))
    assert shown["position"].startswith("E - N - U -")


@pytest.mark.parametrize(
    ("state", "in_control", "told"),
    [
        ("HOVERING", ipc.OperatorInfo(3, "gcs status, pid 9"), "you"),
        ("HOVERING", ipc.OperatorInfo(1, "gcs fly, pid 7"), "operator 1 (gcs fly, pid 7)"),
        ("HOVERING", None, "nobody"),
        ("EXTERNAL", None, "the pilot or another station; of this station: nobody"),
    ],
)
def test_who_is_in_control_is_told(
    state: str, in_control: ipc.OperatorInfo | None, told: str
) -> None:
    seen = msgspec.structs.replace(FakeStation().snapshot(), state=state, in_control=in_control)
    assert dict(rows(seen, 3))["control"] == told


def test_json_tells_it_too(capsys: pytest.CaptureFixture[str]) -> None:
    operator = ipc.OperatorInfo(1, "gcs fly, pid 7")
    seen = msgspec.structs.replace(FakeStation().snapshot(), in_control=operator)
    show(seen, 3, as_json=True)
    told = json.loads(capsys.readouterr().out)
    assert told["in_control"] == {"client": 1, "name": "gcs fly, pid 7"}


def test_json_of_a_fleet_has_every_vehicle(capsys: pytest.CaptureFixture[str]) -> None:
    row = ipc.BridgeVehicle(1, "1/1 px4 quadrotor", "HOVERING", "OURS", "NOMINAL")
    other = msgspec.structs.replace(row, vehicle=2, name="2/1 px4 quadrotor", state="MOVING")
    seen = FakeStation().snapshot()
    show(seen, 3, as_json=True, bridge=ipc.BridgeStatus(0, [], [], [row, other]))
    told = json.loads(capsys.readouterr().out)
    assert [(each["vehicle"], each["state"]) for each in told["fleet"]] == [
        (1, "HOVERING"),
        (2, "MOVING"),
    ]
    show(seen, 3, as_json=True, bridge=ipc.BridgeStatus(0, [], [], [row]))
    assert "fleet" not in json.loads(capsys.readouterr().out)
