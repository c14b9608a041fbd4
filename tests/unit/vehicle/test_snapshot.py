"""The snapshot: in the operator's frame and degrees, and None for what is not known."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import pytest

from gcs import ipc
from gcs.frames import Vec3
from gcs.gate.condition import Condition
from gcs.gate.inputs import ConditionChanged
from gcs.gate.machine.gate import Gate
from gcs.gate.policy.parse import DEFAULT
from gcs.protocol.sequence import SequenceTracker
from gcs.vehicle.snapshot import lost_pct, snapshot
from gcs.vehicle.talk.telemetry import Telemetry
from tests.unit.station.vehicles import SECOND_NS, vehicle

NOW_NS = 50 * SECOND_NS


@dataclass
class Scene:
    """What there is to show."""

    telemetry: Telemetry | None = None
    gate: Gate = field(default_factory=lambda: Gate(DEFAULT, "px4", 0))
    losses: SequenceTracker = field(default_factory=SequenceTracker)

    def shot(self) -> ipc.Snapshot:
        of_station = ipc.Snapshot(
            NOW_NS,
            "NO_VEHICLE",
            "NONE",
            "NOMINAL",
            [],
            0.0,
            log_path="logs/a.mcap",
            recording=True,
            recorded_mb=1.5,
            vehicles=["1/1 px4 quadrotor"],
            in_control=ipc.OperatorInfo(2, "gcs attach, pid 7"),
        )
        return snapshot(of_station, self.gate, self.telemetry, 7, self.losses)


def reported() -> Telemetry:
    telemetry = vehicle()
    telemetry.heartbeat_ns = NOW_NS - SECOND_NS // 2
    telemetry.mode_name, telemetry.armed = "OFFBOARD", True
    telemetry.pos_ned, telemetry.v_ned = (1.0, 2.0, -3.0), (0.1, 0.2, -0.3)
    telemetry.position_ns = NOW_NS - SECOND_NS // 4
    telemetry.home_ned = (10.0, 20.0, -1.0)
    telemetry.yaw_rad = -math.pi / 2
    return telemetry


def test_who_is_in_control_is_told_without_a_vehicle_too() -> None:
    assert Scene().shot().in_control == ipc.OperatorInfo(2, "gcs attach, pid 7")


def test_without_a_vehicle_nothing_of_one_is_shown() -> None:
    shot = Scene().shot()
    assert (shot.state, shot.control, shot.severity) == ("NO_VEHICLE", "NONE", "NOMINAL")
    assert (shot.vehicle, shot.armed, shot.pos_enu, shot.battery_pct) == ("", None, None, None)
    assert (shot.heartbeat_age_s, shot.position_age_s, shot.mission_total) == (None, None, None)
    assert (shot.log_path, shot.recording, shot.recorded_mb) == ("logs/a.mcap", True, 1.5)


def test_a_vehicle_that_only_beats_has_no_place_and_no_zero_in_place_of_one() -> None:
    shot = Scene(vehicle()).shot()
    assert shot.vehicle == "1/1 px4 quadrotor"
    assert (shot.pos_enu, shot.v_enu, shot.yaw_deg, shot.position_age_s) == (None,) * 4
    assert (shot.home_enu, shot.battery_pct, shot.battery_v, shot.armed) == (None,) * 4
    assert shot.landed == "UNDEFINED"


def test_places_are_east_north_up() -> None:
    shot = Scene(reported()).shot()
    assert shot.pos_enu == (2.0, 1.0, 3.0)
    assert shot.v_enu == (0.2, 0.1, 0.3)
    assert shot.home_enu == (20.0, 10.0, 1.0)


@pytest.mark.parametrize(("yaw_rad", "yaw_deg"), [(-math.pi / 2, 270.0), (0.0, 0.0), (1.0, 57.3)])
def test_a_heading_is_degrees_from_nought_to_360(yaw_rad: float, yaw_deg: float) -> None:
    telemetry = reported()
    telemetry.yaw_rad = yaw_rad
    assert Scene(telemetry).shot().yaw_deg == pytest.approx(yaw_deg, abs=0.01)


def test_ages_count_from_the_arrival() -> None:
    shot = Scene(reported()).shot()
    assert shot.time_ns == NOW_NS
    assert shot.heartbeat_age_s == pytest.approx(0.5)
    assert shot.position_age_s == pytest.approx(0.25)


def test_what_is_reported_is_shown_as_it_was() -> None:
    telemetry = reported()
    telemetry.battery_pct, telemetry.battery_v, telemetry.mission_seq = 55.0, 15.2, 3
    shot = Scene(telemetry).shot()
    assert (shot.mode, shot.armed) == ("OFFBOARD", True)
    assert (shot.battery_pct, shot.battery_v) == (55.0, 15.2)
    assert (shot.mission_seq, shot.mission_total) == (3, 7)


def test_at_the_origin_a_place_is_a_place() -> None:
    telemetry = reported()
    telemetry.pos_ned = telemetry.home_ned = (0.0, 0.0, 0.0)
    at: Vec3 | None = Scene(telemetry).shot().pos_enu
    assert at == (0.0, 0.0, 0.0)


def test_what_is_wrong_is_shown_by_its_name() -> None:
    scene = Scene()
    scene.gate.handle(ConditionChanged(Condition.BATTERY_LOW, True, "14 %"), NOW_NS)
    shot = scene.shot()
    assert shot.conditions == ["battery_low"]
    assert shot.severity == "CAUTION"


def test_losses_are_of_all_that_was_sent() -> None:
    losses = SequenceTracker()
    assert lost_pct(losses) == 0.0
    for seq in (0, 1, 4):  # 2 and 3 never came
        losses.seen(1, 1, seq)
    assert lost_pct(losses) == pytest.approx(40.0)
    assert Scene(losses=losses).shot().lost_pct == pytest.approx(40.0)
