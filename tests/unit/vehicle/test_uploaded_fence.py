"""The fence that was uploaded to a vehicle: when it is read, and what is told of it."""

from __future__ import annotations

from dataclasses import dataclass, field

import msgspec
import pymap3d
import pytest

from gcs.gate.airspace.projection import Origin
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.protocol.effects import Address, Heard, Send
from gcs.session.speedup_waits import Times
from gcs.session.work import Log, Work
from gcs.vehicle.missions.uploaded_fence import NO_FENCE, FenceOnBoard, UploadedFence
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import Cmd, MavFrame, MissionResult, MissionType
from gcs.wire.messages import (
    Message,
    MissionAck,
    MissionCount,
    MissionCurrent,
    MissionItemInt,
    MissionRequestList,
    ParamValue,
)

SECOND = 1_000_000_000
OWN, VEHICLE = Address(255, 190), Address(1, 1)
LAT, LON, AMSL_M = 47.0, 8.0, 500.0
INSIDE, OUTSIDE = (
    Cmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION,
    Cmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION,
)
SQUARE_60 = [(60.0, 60.0), (60.0, -60.0), (-60.0, -60.0), (-60.0, 60.0)]
"""North and east in metres: the corners are 84.85 m from its middle."""


def part(
    command: int, p1: float, north_m: float, east_m: float, frame: int = MavFrame.GLOBAL
) -> MissionItemInt:
    """One item of a fence, placed by pymap3d."""
    lat, lon, _ = pymap3d.ned2geodetic(north_m, east_m, 0.0, LAT, LON, AMSL_M)
    return MissionItemInt(
        param1=p1,
        param2=0.0,
        param3=0.0,
        param4=0.0,
        z=0.0,
        seq=0,
        current=0,
        autocontinue=1,
        x=round(float(lat) * 1e7),
        y=round(float(lon) * 1e7),
        command=command,
        frame=frame,
        target_system=OWN.sysid,
        target_component=OWN.compid,
        mission_type=MissionType.FENCE,
    )


def polygon(command: int, corners: list[tuple[float, float]]) -> list[MissionItemInt]:
    return [part(command, len(corners), *corner) for corner in corners]


@dataclass
class Script:
    """The part, its clock, and a vehicle with a fence that answers when it is asked."""

    autopilot: Autopilot = PX4
    items: list[MissionItemInt] = field(default_factory=list)
    now_ns: int = 100 * SECOND
    busy: bool = False
    work: list[Work] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.fence = FenceOnBoard(OWN, Times())
        self.telemetry = Telemetry(1, 1, self.autopilot, 0)
        self.telemetry.origin = Origin(LAT, LON, AMSL_M)
        self.telemetry.home_ned = (0.0, 0.0, 0.0)
        self.telemetry.heard_ns = self.now_ns
        self.fence.start(self.telemetry, self.now_ns)
        self.follow()

    def follow(self, *sent: Message) -> None:
        jobs: list[Work] = [Send(message) for message in sent]
        self._take(self.fence.follow(jobs, self.telemetry, busy=self.busy, now_ns=self.now_ns))

    def hear(self, *messages: Message) -> None:
        for message in messages:
            heard = Heard(1, 1, message)
            self._take(self.fence.heard(heard, self.telemetry, self.now_ns))
            self.follow()

    def answer(self, *items: MissionItemInt) -> UploadedFence:
        """The vehicle tells all that it was asked for; what is known then."""
        kind = MissionType.FENCE
        to = {"target_system": OWN.sysid, "target_component": OWN.compid}
        self.hear(MissionCount(count=len(items), mission_type=kind, **to))
        for seq, item in enumerate(items):
            self.hear(msgspec.structs.replace(item, seq=seq))
        return self.fence.seen(self.telemetry)

    def pass_time(self, seconds: float) -> None:
        until_ns = self.now_ns + round(seconds * SECOND)
        while (due_ns := self.fence.deadline_ns) is not None and due_ns <= until_ns:
            self.now_ns = self.telemetry.heard_ns = max(self.now_ns, due_ns)
            self._take(self.fence.wake(self.telemetry, busy=self.busy, now_ns=self.now_ns))
        self.now_ns = until_ns

    def _take(self, work: list[Work]) -> None:
        self.work += work

    @property
    def lists_asked(self) -> int:
        sent = [item.message for item in self.work if isinstance(item, Send)]
        lists = [message for message in sent if isinstance(message, MissionRequestList)]
        assert all(each.mission_type == MissionType.FENCE for each in lists)
        return len(lists)

    @property
    def said(self) -> list[str]:
        return [item.text for item in self.work if isinstance(item, Log)]


def test_a_vehicle_without_one_has_none() -> None:
    script = Script()
    assert script.lists_asked == 1
    assert script.answer() == NO_FENCE
    assert script.fence.deadline_ns is None


@pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT])
def test_the_farthest_corner_from_home_is_its_reach(autopilot: Autopilot) -> None:
    seen = Script(autopilot).answer(*polygon(INSIDE, SQUARE_60))
    assert (seen.stay_in, seen.stay_out) == (1, 0)
    assert seen.reach_m == pytest.approx(84.85, abs=0.3)


def test_of_several_zones_the_farthest_counts_and_one_to_stay_out_of_does_not() -> None:
    circle = part(Cmd.NAV_FENCE_CIRCLE_INCLUSION, 30.0, 100.0, 0.0)
    forbidden = part(Cmd.NAV_FENCE_CIRCLE_EXCLUSION, 500.0, 0.0, 0.0)
    far = polygon(OUTSIDE, [(900.0, 0.0), (910.0, 0.0), (900.0, 10.0)])
    seen = Script().answer(*polygon(INSIDE, SQUARE_60), circle, forbidden, *far)
    assert (seen.stay_in, seen.stay_out) == (2, 2)
    assert seen.reach_m == pytest.approx(130.0, abs=0.4)


def test_zones_to_stay_out_of_alone_keep_a_vehicle_nowhere() -> None:
    seen = Script().answer(*polygon(OUTSIDE, SQUARE_60))
    assert seen == UploadedFence(0, 1, None)
    assert not seen.keeps_within(1_000.0)


def test_where_home_is_not_known_neither_is_its_reach_and_a_home_that_moves_moves_it() -> None:
    script = Script()
    script.telemetry.home_ned = None
    assert script.answer(*polygon(INSIDE, SQUARE_60)) == UploadedFence(1, 0, None)
    script.telemetry.home_ned = (60.0, 60.0, 0.0)
    reach_m = script.fence.seen(script.telemetry).reach_m
    assert reach_m == pytest.approx(2 * 84.85, abs=0.5)


def test_items_that_are_no_fence_are_told() -> None:
    seen = Script().answer(*polygon(INSIDE, SQUARE_60)[:3])
    assert "corner" in seen.unreadable
    assert not seen.keeps_within(1_000.0)


def accepted(kind: int) -> MissionAck:
    """Told to another station than ours."""
    return MissionAck(
        target_system=77, target_component=0, type=MissionResult.ACCEPTED, mission_type=kind
    )


def fence_total(value: float) -> ParamValue:
    return ParamValue(
        param_value=value, param_count=1, param_index=0, param_id="FENCE_TOTAL", param_type=2
    )


@pytest.mark.parametrize(
    "told",
    [
        accepted(MissionType.FENCE),
        accepted(MissionType.ALL),
        MissionCurrent(seq=0, fence_id=7),
        fence_total(3.0),
    ],
    ids=["accepted", "all kinds", "another number", "another count"],
)
def test_what_says_that_it_has_changed_has_it_read_again(told: Message) -> None:
    script = Script(ARDUPILOT)
    script.answer(*polygon(INSIDE, SQUARE_60))
    script.hear(MissionCurrent(seq=0), fence_total(4.0))
    assert script.lists_asked == 1
    script.hear(told)
    assert script.fence.seen(script.telemetry) == NO_FENCE, "not known before it is read"
    assert script.lists_asked == 2
    assert script.answer(*polygon(OUTSIDE, SQUARE_60)).stay_out == 1


@pytest.mark.parametrize("kind", [MissionType.MISSION, MissionType.RALLY])
def test_another_plan_is_no_fence(kind: int) -> None:
    script = Script()
    script.answer(*polygon(INSIDE, SQUARE_60))
    script.hear(
        accepted(kind),
        MissionCurrent(seq=0),
        MissionCurrent(seq=0, mission_id=5, rally_points_id=6),
    )
    assert script.lists_asked == 1
    assert script.fence.seen(script.telemetry).stay_in == 1


def test_another_transfer_goes_first() -> None:
    script = Script(busy=True)
    assert script.lists_asked == 0
    assert script.fence.deadline_ns is None
    script.busy = False
    script.follow()
    assert script.lists_asked == 1
    script.busy = True
    script.follow()
    assert not script.fence.reading, "given up for it, and begun again"
    script.busy = False
    script.follow()
    assert script.lists_asked == 2


def test_silence_means_none_is_told_once_and_asked_again() -> None:
    script = Script()
    script.pass_time(120.0)
    assert script.fence.seen(script.telemetry) == NO_FENCE
    (text,) = script.said
    assert text == (
        "the vehicle was asked for its fence and did not answer: it is taken to have none"
    )
    assert script.lists_asked > 6


def test_a_vehicle_that_refuses_is_asked_again_and_why_is_told() -> None:
    script = Script()
    script.hear(
        MissionAck(
            target_system=OWN.sysid,
            target_component=OWN.compid,
            type=MissionResult.DENIED,
            mission_type=MissionType.FENCE,
        )
    )
    assert "could not be read" in script.fence.seen(script.telemetry).unreadable
    script.pass_time(1.1)
    assert script.lists_asked == 2
    assert script.answer().unreadable == ""
