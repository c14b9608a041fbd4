"""Where a return may end: read, overheard, forgotten and read again."""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest

from gcs.gate.airspace.projection import Origin
from gcs.gate.airspace.return_place import ReturnPlace
from gcs.gate.inputs import ReturnPlacesSeen
from gcs.gate.policy.parse import DEFAULT
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.protocol.effects import Address, Heard, Send
from gcs.session.speedup_waits import Times
from gcs.session.work import GateInput, Log, Work
from gcs.vehicle.missions.return_places import READING, ReturnPlaces
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import Cmd, MavFrame, MissionResult, MissionType
from gcs.wire.messages import (
    Message,
    MissionAck,
    MissionCount,
    MissionCurrent,
    MissionItemInt,
    MissionRequestInt,
    MissionRequestList,
    ParamValue,
)

SECOND = 1_000_000_000
RALLY = MissionType.RALLY
OWN, VEHICLE = Address(255, 190), Address(1, 1)
LAT, LON, AMSL_M = 47.0, 8.0, 500.0
UNKNOWN = ReturnPlacesSeen(None, READING)
NOWHERE_ELSE = ReturnPlacesSeen(())


def count(items: int) -> MissionCount:
    return MissionCount(
        count=items, target_system=OWN.sysid, target_component=OWN.compid, mission_type=RALLY
    )


def point(seq: int = 0, up_m: float = 20.0, frame: int = MavFrame.GLOBAL_RELATIVE_ALT) -> Message:
    """At the origin."""
    return MissionItemInt(
        param1=0.0,
        param2=0.0,
        param3=0.0,
        param4=0.0,
        x=round(LAT * 1e7),
        y=round(LON * 1e7),
        z=up_m,
        seq=seq,
        command=Cmd.NAV_RALLY_POINT,
        target_system=OWN.sysid,
        target_component=OWN.compid,
        frame=frame,
        current=0,
        autocontinue=1,
        mission_type=RALLY,
    )


def ack(result: int, kind: int = RALLY, to: Address = OWN) -> MissionAck:
    return MissionAck(
        target_system=to.sysid, target_component=to.compid, type=result, mission_type=kind
    )


def rally_total(value: float) -> ParamValue:
    return ParamValue(
        param_value=value, param_count=1, param_index=0, param_id="RALLY_TOTAL", param_type=2
    )


@dataclass
class Script:
    """The part, its clock, a vehicle, and all that came of it."""

    autopilot: Autopilot = PX4
    now_ns: int = 100 * SECOND
    busy: bool = False
    work: list[Work] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.part = ReturnPlaces(OWN, Times(), DEFAULT)
        self.telemetry = Telemetry(1, 1, self.autopilot, 0)
        self.telemetry.origin = Origin(LAT, LON, AMSL_M)
        self.telemetry.home_ned = (0.0, 0.0, 2.0)
        self.telemetry.heard_ns = self.now_ns
        self._take(self.part.start(self.telemetry, busy=self.busy, now_ns=self.now_ns))

    def typed(self, kind: int | None = 0) -> Script:
        self._take(self.part.returns_by(kind, self.telemetry))
        return self

    def hear(self, *messages: Message) -> None:
        for message in messages:
            self.telemetry.heard_ns = self.now_ns
            heard = Heard(1, 1, message)
            self._take(self.part.heard(heard, self.telemetry, self.now_ns))
            self.jobs()

    def jobs(self, *sent: Message) -> None:
        work = [Send(message) for message in sent]
        follows = self.part.follow(work, self.telemetry, busy=self.busy, now_ns=self.now_ns)
        self._take(follows)

    def run(self, seconds: float, *, heard: bool = True) -> None:
        until_ns = self.now_ns + round(seconds * SECOND)
        while (due_ns := self.part.rally.deadline_ns) is not None and due_ns <= until_ns:
            self.now_ns = max(self.now_ns, due_ns)
            if heard:
                self.telemetry.heard_ns = self.now_ns
            self._take(self.part.wake(self.telemetry, busy=self.busy, now_ns=self.now_ns))
        self.now_ns = until_ns

    def _take(self, work: list[Work]) -> None:
        self.work += work

    def first_time(self) -> bool:
        return not self.part.rally.answered

    @property
    def told(self) -> list[ReturnPlacesSeen]:
        given = [item.given for item in self.work if isinstance(item, GateInput)]
        return [each for each in given if isinstance(each, ReturnPlacesSeen)]

    @property
    def sent(self) -> list[str]:
        return [type(item.message).__name__ for item in self.work if isinstance(item, Send)]

    @property
    def said(self) -> list[str]:
        return [item.text for item in self.work if isinstance(item, Log)]


def test_a_vehicle_without_points_returns_home_alone() -> None:
    script = Script().typed()
    assert script.told == [UNKNOWN]
    assert script.first_time()
    script.hear(count(0))
    assert script.told == [UNKNOWN, NOWHERE_ELSE]
    assert script.sent == ["MissionRequestList", "MissionAck"]
    assert not script.first_time()
    assert script.part.rally.deadline_ns is None
    assert script.said == []


@pytest.mark.parametrize(
    ("autopilot", "frame", "up_m", "expected"),
    [
        (PX4, MavFrame.GLOBAL_RELATIVE_ALT, 20.0, ((0.0, 0.0, -18.0), 0.0)),
        (PX4, MavFrame.GLOBAL, 520.0, ((0.0, 0.0, -20.0), 0.0)),
        (ARDUPILOT, MavFrame.GLOBAL_RELATIVE_ALT, 20.0, ((0.0, 0.0, 2.0), 20.0)),
        (ARDUPILOT, MavFrame.GLOBAL, 520.0, ((0.0, 0.0, 2.0), 22.0)),
    ],
)
def test_a_height_is_the_ground_of_a_px4_and_the_least_height_of_an_ardupilot(
    autopilot: Autopilot,
    frame: int,
    up_m: float,
    expected: tuple[tuple[float, float, float], float],
) -> None:
    script = Script(autopilot).typed()
    script.hear(count(1), point(0, up_m, frame))
    place = ReturnPlace("rally point 1", *expected)
    assert script.told[-1] == ReturnPlacesSeen((place,))
    assert script.said == ["a return may end at home, rally point 1"]


def test_what_home_and_origin_are_moves_the_places() -> None:
    script = Script().typed()
    script.telemetry.origin = None
    script.hear(count(1), point())
    assert script.told[-1].places is None
    assert "origin" in script.told[-1].unknown
    script.telemetry.origin = Origin(LAT, LON, AMSL_M)
    script.work += script.part.placed(script.telemetry)
    assert script.told[-1].unknown == ""
    many = len(script.told)
    script.work += script.part.placed(script.telemetry)
    assert len(script.told) == many


@pytest.mark.parametrize("kind", [1, 2, 3, 4, 6, -1])
def test_a_return_that_a_mission_may_lead_is_not_judged(kind: int) -> None:
    script = Script().typed(kind)
    script.hear(count(0))
    assert script.told[-1].places is None
    assert f"RTL_TYPE {kind}" in script.told[-1].unknown
    script.typed(0)
    assert script.told[-1] == NOWHERE_ELSE


@pytest.mark.parametrize("kind", [0, 5, None])
def test_a_straight_one_is_and_so_is_that_of_a_vehicle_without_the_parameter(
    kind: int | None,
) -> None:
    script = Script().typed(kind)
    script.hear(count(0))
    assert script.told[-1] == NOWHERE_ELSE


def test_the_type_of_a_px4_is_waited_for() -> None:
    script = Script()
    script.hear(count(0))
    assert script.told[-1] == ReturnPlacesSeen(None, "its RTL_TYPE is still being read")
    assert Script(ARDUPILOT).typed().told == [UNKNOWN]


def test_a_vehicle_that_keeps_none_has_none() -> None:
    script = Script().typed()
    script.hear(ack(MissionResult.UNSUPPORTED))
    assert script.told[-1] == NOWHERE_ELSE


@pytest.mark.parametrize("result", [MissionResult.DENIED, MissionResult.ERROR])
def test_any_other_refusal_is_no_answer_and_is_asked_again(result: int) -> None:
    script = Script().typed()
    script.hear(ack(result))
    assert script.told[-1].places is None
    assert "could not be read" in script.told[-1].unknown
    script.run(1.1)
    assert script.sent.count("MissionRequestList") == 2
    script.hear(count(0))
    assert script.told[-1] == NOWHERE_ELSE


def test_silence_of_a_vehicle_that_is_heard_means_none_and_is_said_and_asked_again() -> None:
    script = Script().typed()
    script.run(31.0)
    assert script.told[-1] == NOWHERE_ELSE
    assert len(script.said) == 1
    assert "taken to have none" in script.said[0]
    asked = script.sent.count("MissionRequestList")
    script.run(31.0)
    assert script.sent.count("MissionRequestList") > asked
    script.hear(count(1), point())
    assert script.told[-1].places


def test_silence_of_a_vehicle_that_is_not_heard_means_nothing() -> None:
    script = Script().typed()
    script.run(60.0, heard=False)
    assert script.told[-1].places is None


def test_points_that_came_in_part_are_not_known() -> None:
    script = Script().typed()
    script.hear(count(2), point())
    script.run(30.0)
    assert script.told[-1].places is None


@pytest.mark.parametrize("to", [OWN, Address(77, 190)])
@pytest.mark.parametrize("kind", [RALLY, MissionType.ALL])
def test_a_change_that_the_vehicle_accepts_of_anybody_is_read(kind: int, to: Address) -> None:
    script = Script().typed()
    script.hear(count(0))
    script.hear(ack(MissionResult.ACCEPTED, kind, to))
    assert script.told[-1] == UNKNOWN
    assert not script.first_time()
    script.hear(count(1), point())
    assert script.told[-1].places


def test_another_plan_s_is_none() -> None:
    script = Script().typed()
    script.hear(count(0), ack(MissionResult.ACCEPTED, MissionType.MISSION))
    assert script.told[-1] == NOWHERE_ELSE


def test_another_number_of_the_points_is_a_change() -> None:
    script = Script().typed()
    script.hear(count(0), MissionCurrent(seq=0), MissionCurrent(seq=1))
    assert script.told[-1] == NOWHERE_ELSE
    script.hear(MissionCurrent(seq=1, rally_points_id=7))
    assert script.told[-1] == UNKNOWN
    assert script.sent.count("MissionRequestList") == 2


def test_another_count_of_an_ardupilot_is_a_change() -> None:
    script = Script(ARDUPILOT)
    script.hear(count(0), rally_total(0), rally_total(0))
    assert script.told[-1] == NOWHERE_ELSE
    script.hear(rally_total(1))
    assert script.told[-1] == UNKNOWN
    assert script.sent.count("MissionRequestList") == 2


def test_a_job_that_brings_points_makes_them_unknown_until_it_has_read_them_back() -> None:
    script = Script().typed()
    script.hear(count(0))
    script.busy = True
    script.jobs(count(1))
    assert script.told[-1] == UNKNOWN
    assert script.part.rally.deadline_ns is None, "the job transfers"
    script.hear(ack(MissionResult.ACCEPTED))
    script.jobs(MissionRequestList(target_system=1, target_component=1, mission_type=RALLY))
    asked = len(script.sent)
    script.hear(count(1))
    script.jobs(MissionRequestInt(seq=0, target_system=1, target_component=1, mission_type=RALLY))
    script.hear(point())
    assert script.told[-1].places
    assert len(script.sent) == asked, "overheard"
    script.busy = False
    script.jobs()
    assert len(script.sent) == asked


def test_a_job_that_ends_before_it_has_read_them_leaves_that_to_us() -> None:
    script = Script().typed()
    script.hear(count(0))
    script.busy = True
    script.jobs(count(1))
    script.busy = False
    asked = len(script.sent)
    script.jobs()
    assert script.sent[asked:] == ["MissionRequestList"]


def test_a_job_goes_first() -> None:
    script = Script(busy=True).typed()
    assert script.sent == []
    script.busy = False
    script.jobs()
    assert script.sent == ["MissionRequestList"]
    script.busy = True
    script.jobs()
    assert not script.part.rally.reading
    script.hear(count(0))
    assert script.told[-1] == UNKNOWN
    script.busy = False
    script.jobs()
    script.hear(count(0))
    assert script.told[-1] == NOWHERE_ELSE
