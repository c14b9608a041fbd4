"""Which vehicles a session meets, and whose a frame or a request is."""

from __future__ import annotations

import pytest

from gcs.config import SimConfig, StationConfig
from gcs.gate.condition import Condition
from gcs.gate.inputs import ConditionChanged
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code
from gcs.session.speedup_waits import Times
from gcs.session.work import STATION, ForOwner, GateInput, Log, Work
from gcs.station.queue import WorkQueue
from gcs.station.vehicles import MOST_VEHICLES, Vehicles
from gcs.wire.codec import FrameWriter
from gcs.wire.frame import Frame, split
from gcs.wire.messages import Heartbeat, LocalPositionNed, Message, RadioStatus

QUADROTOR, STATION_TYPE, PX4, NO_AUTOPILOT = 2, 6, 12, 8
BRIDGE = StationConfig(bridge=True)


def frame(message: Message, sysid: int, compid: int = 1) -> Frame:
    (found,) = split(FrameWriter(sysid, compid).write(message))
    assert isinstance(found, Frame)
    return found


def heartbeat(sysid: int, compid: int = 1, kind: int = QUADROTOR, autopilot: int = PX4) -> Frame:
    beat = Heartbeat(
        custom_mode=0,
        type=kind,
        autopilot=autopilot,
        base_mode=0,
        system_status=4,
        mavlink_version=3,
    )
    return frame(beat, sysid, compid)


class Fleet:
    """The vehicles of one station, and what the queue makes of their work."""

    def __init__(self, config: StationConfig = BRIDGE) -> None:
        self.vehicles = Vehicles(config, DEFAULT, Times(), 0)
        self.asked: list[tuple[Work, int]] = []
        self._queue = WorkQueue(self._step)

    def _step(self, item: Work, owner: int, now_ns: int) -> list[Work]:
        self.asked.append((item, owner))
        vehicle = self.vehicles.of_owner(owner)
        return vehicle.ask_gate(item.given, now_ns) if isinstance(item, GateInput) else []

    def hear(self, heard: Frame, link: int = 0, now_ns: int = 1) -> None:
        self._queue.run(self.vehicles.frame(link, heard, now_ns), now_ns)

    def run(self, work: list[Work]) -> None:
        self._queue.run(work, 1)

    @property
    def met(self) -> list[int]:
        return [vehicle.sysid for vehicle in self.vehicles]

    def lines(self) -> list[str]:
        return [item.text for item, _ in self.asked if isinstance(item, Log)]


def test_a_bridge_meets_every_autopilot_that_it_hears() -> None:
    fleet = Fleet()
    for sysid in (7, 3, 7, 200):
        fleet.hear(heartbeat(sysid))
    assert fleet.met == [7, 3, 200]
    assert [fleet.vehicles.slot_of(sysid) for sysid in (7, 3, 200, 9)] == [0, 1, 2, None]
    assert {owner for _, owner in fleet.asked} == {0, 1, 2}


@pytest.mark.parametrize(
    "config",
    [
        StationConfig(),
        StationConfig(clients=["a port"]),
        StationConfig(bridge=True, target_sysid=7),
        StationConfig(bridge=True, sim=SimConfig()),
    ],
    ids=["fly", "fly with clients", "a chosen vehicle", "a vehicle of its own"],
)
def test_any_other_station_flies_one(config: StationConfig) -> None:
    fleet = Fleet(config)
    fleet.hear(heartbeat(7))
    fleet.hear(heartbeat(3))
    assert fleet.met == [7]


@pytest.mark.parametrize(
    ("config", "why"),
    [
        (
            StationConfig(bridge=True, target_sysid=7),
            "system 3 is not this bridge's: --target 7",
        ),
        (
            StationConfig(clients=["a port"], target_sysid=7),
            "system 3 is not this station's: --vehicle 7",
        ),
        (StationConfig(clients=["a port"]), "system 3 is not this station's, which has met: 7"),
        (StationConfig(bridge=True), ""),
    ],
)
def test_of_another_one_that_is_heard_it_is_said_why_it_is_not_flown(
    config: StationConfig, why: str
) -> None:
    fleet = Fleet(config)
    fleet.hear(heartbeat(7))
    fleet.hear(heartbeat(3))
    assert [fleet.vehicles.why_not_ours(sysid, 2) for sysid in (3, 7, 9)] == [why, "", ""]
    long_after_ns = 3_600 * 10**9
    assert fleet.vehicles.why_not_ours(3, long_after_ns) == "", "it is not heard any more"


@pytest.mark.parametrize(
    "other",
    [
        heartbeat(3, kind=STATION_TYPE, autopilot=NO_AUTOPILOT),
        heartbeat(3, compid=100, autopilot=NO_AUTOPILOT),
        heartbeat(3, compid=154),
        frame(LocalPositionNed(1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), 3),
    ],
    ids=["a ground station", "a camera", "no autopilot's component", "a position alone"],
)
def test_what_is_no_heartbeat_of_an_autopilot_is_no_vehicle(other: Frame) -> None:
    fleet = Fleet()
    fleet.hear(heartbeat(7))
    fleet.hear(other)
    assert fleet.met == [7]


def test_who_makes_up_names_fills_no_memory() -> None:
    fleet = Fleet()
    for sysid in range(1, 200):
        fleet.hear(heartbeat(sysid))
    assert len(fleet.vehicles) == MOST_VEHICLES
    told = [line for line in fleet.lines() if "is not met" in line]
    assert told == [f"vehicle {MOST_VEHICLES + 1} is not met: {MOST_VEHICLES} are there already"]


def test_nothing_is_met_any_more_when_the_station_is_being_left() -> None:
    fleet = Fleet()
    fleet.hear(heartbeat(7))
    fleet.vehicles.closed = True
    fleet.hear(heartbeat(3))
    assert fleet.met == [7]


def test_a_condition_of_the_station_is_one_of_every_vehicle_s_gate() -> None:
    """Of those that are there, and of one that comes later; a vehicle's own is not."""
    fleet = Fleet()
    fleet.hear(heartbeat(7))
    failed = ConditionChanged(Condition.RECORDER_FAILED, True, "the disk is full")
    fleet.run(fleet.vehicles.to_all(GateInput(failed)))
    fleet.run([ForOwner(0, (GateInput(ConditionChanged(Condition.BATTERY_LOW, True)),))])
    fleet.hear(heartbeat(3))
    first, second = fleet.vehicles
    assert set(first.gate.conditions) == {Condition.RECORDER_FAILED, Condition.BATTERY_LOW}
    assert second.gate.conditions == (Condition.RECORDER_FAILED,)
    assert second.gate.reasons == ((Condition.RECORDER_FAILED, "the disk is full"),)


def test_a_radio_speaks_of_the_vehicles_on_its_link() -> None:
    """RADIO_STATUS with no signal above the noise: the link of those on it is poor, no other's."""
    fleet = Fleet()
    fleet.hear(heartbeat(7), link=0)
    fleet.hear(heartbeat(3), link=1)
    poor = RadioStatus(rxerrors=0, fixed=0, rssi=20, remrssi=20, txbuf=90, noise=60, remnoise=60)
    for at_s in (1, 3, 5, 7, 9):
        fleet.hear(frame(poor, 51, 68), link=1, now_ns=at_s * 1_000_000_000)
    told = {
        owner
        for item, owner in fleet.asked
        if isinstance(item, GateInput)
        and isinstance(item.given, ConditionChanged)
        and item.given.condition is Condition.LINK_POOR
    }
    assert told == {1}


def test_a_request_without_a_vehicle_is_for_the_first() -> None:
    fleet = Fleet()
    assert fleet.vehicles.owner_for(0) == 0
    assert fleet.vehicles.owner_for(3) == STATION
    for sysid in (7, 3):
        fleet.hear(heartbeat(sysid))
    assert [fleet.vehicles.owner_for(sysid) for sysid in (0, 7, 3, 9)] == [0, 0, 1, STATION]
    refusal = fleet.vehicles.refusal(STATION, 1)
    assert refusal is not None
    assert refusal.code is Code.NO_VEHICLE
    assert "7, 3" in refusal.sentence


def test_what_is_said_of_one_of_several_names_it() -> None:
    fleet = Fleet()
    fleet.hear(heartbeat(7))
    assert fleet.vehicles.prefix(0) == ""
    fleet.hear(heartbeat(3))
    assert [fleet.vehicles.prefix(owner) for owner in (0, 1, STATION)] == [
        "vehicle 7: ",
        "vehicle 3: ",
        "",
    ]


def test_one_number_on_two_links_at_once_is_told_once() -> None:
    """It may be one vehicle with two radios, or two vehicles with the same system id."""
    fleet = Fleet()
    fleet.hear(heartbeat(5), link=0, now_ns=1)
    assert "two vehicles" not in told(fleet)
    fleet.hear(heartbeat(5), link=1, now_ns=500_000_000)
    fleet.hear(heartbeat(5), link=1, now_ns=600_000_000)
    assert told(fleet).count("vehicle 5 is heard on link 0 and on link 1") == 1


def test_a_link_that_takes_over_from_a_silent_one_is_not_told_as_a_second_vehicle() -> None:
    fleet = Fleet()
    fleet.hear(heartbeat(5), link=0, now_ns=1)
    fleet.hear(heartbeat(5), link=1, now_ns=3_000_000_000)
    assert "two vehicles" not in told(fleet)


def told(fleet: Fleet) -> str:
    return "\n".join(item.text for item, _ in fleet.asked if isinstance(item, Log))
