"""MAVLink's operator control: who is obeyed, who is asked, who is told.

Source of the rules: MAV_CMD_REQUEST_OPERATOR_CONTROL and CONTROL_STATUS of MAVLink's
development.xml (work in progress there); none of it is in the recordings.
"""

from __future__ import annotations

import math

import pytest

from tests.unit.vehicle_services.fake_vehicle import Bench, S, acks, long, of
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.simulation.world import Datagram
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import encode
from vehicle_sim.wire.ids import Capability

ASK, LAND, ARM, REQUEST_MESSAGE, SET_INTERVAL = 32100, 21, 400, 512, 511
MANAGER, TAKEOVER = 1, 2
FIRST, SECOND = 255, 254
both = pytest.mark.parametrize("personality", ["px4", "ardupilot"])


class Field(Bench):
    """A vehicle with operator control, and two ground stations with a link each."""

    def __init__(self, personality: Personality = "px4") -> None:
        super().__init__(personality, operator_control=True)
        for station in (FIRST, SECOND):
            self.say(station, m.Heartbeat(0, 6, 8, 0, 4, 3))

    def say(self, station: int, message: m.Message) -> list[m.Message]:
        return self.send(message, station, peer=f"station {station}")

    def command(self, station: int, command: int, *params: float) -> Result | None:
        """The result that this station is told."""
        told = acks(self.say(station, long(command, *params)))
        return Result(told[0][1]) if told else None

    def request(self, station: int, takeover: float = 0.0, seconds: float = 10.0) -> Result | None:
        return self.command(station, ASK, 1, takeover, seconds)

    def release(self, station: int) -> Result | None:
        return self.command(station, ASK, 0)

    def status(self) -> tuple[int, int]:
        """What CONTROL_STATUS says: the flags, and who is in control."""
        heard = self.say(SECOND, long(REQUEST_MESSAGE, 512))
        told = of(heard, m.ControlStatus)[-1]
        assert told.gcs_secondary == bytes(10)
        return told.flags, told.gcs_main

    def lands(self, station: int) -> bool:
        before = len(self.vehicle.named("land"))
        self.command(station, LAND)
        return len(self.vehicle.named("land")) > before


def heard_by(field: Field, listener: int, speaker: int, message: m.Message) -> list[m.Message]:
    """What one station is sent because of what another says."""
    field.sequence += 1
    data = encode(message, field.sequence & 0xFF, speaker, 190)
    outputs = field.world.handle(Datagram(0, f"station {speaker}", data), field.now_ns)
    return field._take(outputs, f"station {listener}")


@both
def test_nobody_is_in_control_at_first_and_everybody_is_obeyed(personality: Personality) -> None:
    field = Field(personality)
    assert field.status() == (MANAGER | TAKEOVER, 0)
    assert field.lands(FIRST)
    assert field.lands(SECOND)


@both
def test_who_asks_first_is_in_control_and_alone_is_obeyed(personality: Personality) -> None:
    field = Field(personality)
    assert field.request(FIRST) is Result.ACCEPTED
    assert field.status() == (MANAGER, FIRST)
    assert field.lands(FIRST)
    assert field.command(SECOND, LAND) is Result.NOT_IN_CONTROL
    assert not field.lands(SECOND)


def test_control_status_comes_once_a_second_and_at_each_change() -> None:
    field = Field()
    told = of(field.advance(5 * S, "station 254"), m.ControlStatus)
    assert len(told) == 5
    heard = heard_by(field, SECOND, FIRST, long(ASK, 1))
    (changed,) = of(heard, m.ControlStatus)
    assert changed.gcs_main == FIRST


def test_without_permission_the_one_in_control_is_asked() -> None:
    field = Field()
    field.request(FIRST)
    heard = heard_by(field, FIRST, SECOND, long(ASK, 1, 1, 30))
    (asked,) = of(heard, m.CommandLong)
    assert (asked.command, asked.target_system) == (ASK, FIRST)
    assert asked[:4] == (1.0, 1.0, 30.0, float(SECOND))
    assert field.status() == (MANAGER, FIRST)


def test_without_permission_the_request_fails() -> None:
    field = Field()
    field.request(FIRST)
    assert field.request(SECOND) is Result.FAILED
    assert not field.lands(SECOND)
    assert field.lands(FIRST)


@pytest.mark.parametrize(
    ("asked_s", "told_s"), [(1.0, 3.0), (100.0, 60.0), (math.nan, 3.0), (10.0, 10.0)]
)
def test_the_time_to_answer_is_within_its_range(asked_s: float, told_s: float) -> None:
    field = Field()
    field.request(FIRST)
    heard = heard_by(field, FIRST, SECOND, long(ASK, 1, 0, asked_s))
    (asked,) = of(heard, m.CommandLong)
    assert asked.param3 == told_s


def test_with_permission_the_next_one_takes_over_at_once() -> None:
    field = Field()
    field.request(FIRST, takeover=1.0)
    assert field.status() == (MANAGER | TAKEOVER, FIRST)
    assert field.request(SECOND) is Result.ACCEPTED
    assert field.status() == (MANAGER, SECOND)
    assert not field.lands(FIRST)


def test_the_one_in_control_can_give_permission_later() -> None:
    """As development.xml has the handover: asked, it requests again with the takeover bit."""
    field = Field()
    field.request(FIRST)
    assert field.request(SECOND) is Result.FAILED
    assert field.request(FIRST, takeover=1.0) is Result.ACCEPTED
    field.advance(1 * S)
    assert field.request(SECOND) is Result.ACCEPTED
    assert field.lands(SECOND)


def test_a_request_that_is_repeated_is_answered_alike_and_asks_once() -> None:
    field = Field()
    field.request(FIRST)
    first = heard_by(field, FIRST, SECOND, long(ASK, 1))
    again = heard_by(field, FIRST, SECOND, long(ASK, 1, confirmation=1))
    asked = [of(heard, m.CommandLong) for heard in (first, again)]
    assert [len(each) for each in asked] == [1, 0]


def test_control_is_given_up_by_who_has_it_alone() -> None:
    field = Field()
    field.request(FIRST)
    assert field.release(SECOND) is Result.FAILED
    assert field.status() == (MANAGER, FIRST)
    assert field.release(FIRST) is Result.ACCEPTED
    assert field.status() == (MANAGER | TAKEOVER, 0)
    assert field.lands(SECOND)


def test_another_action_is_denied() -> None:
    field = Field()
    assert field.command(FIRST, ASK, 2) is Result.DENIED
    assert field.status() == (MANAGER | TAKEOVER, 0)


def test_who_is_not_in_control_may_look() -> None:
    field = Field()
    field.request(FIRST)
    assert field.command(SECOND, REQUEST_MESSAGE, 148) is Result.ACCEPTED
    assert field.command(SECOND, SET_INTERVAL, 32, 1e6) is Result.ACCEPTED
    assert field.say(SECOND, m.ParamRequestRead(-1, 1, 1, b"MAV_SYS_ID"))
    assert field.say(SECOND, m.MissionRequestList(1, 1))


@pytest.mark.parametrize(
    "message",
    [
        m.SetMode(4 << 16, 1, 1),
        m.SetPositionTargetLocalNed(
            0, *(0.0,) * 11, type_mask=0xDF8, target_system=1, target_component=1,
            coordinate_frame=1,
        ),
        m.ManualControl(0, 0, 500, 0, 0, 1),
        m.MissionCount(1, 1, 1, 0),
        m.MissionClearAll(1, 1, 0),
        m.ParamSet(5.0, 1, 1, b"MIS_TAKEOFF_ALT", 9),
    ],
    ids=lambda each: type(each).__name__,
)  # fmt: skip
def test_who_is_not_in_control_changes_nothing(message: m.Message) -> None:
    """The same message of the station in control has an effect."""

    def effect(station: int) -> tuple[int, int, float]:
        field = Field()
        field.request(FIRST)
        calls = len(field.vehicle.calls)
        heard = [e for e in field.say(station, message) if not isinstance(e, m.Heartbeat)]
        height = field.parameters.get("MIS_TAKEOFF_ALT")
        return len(field.vehicle.calls) - calls, len(heard), height

    nothing = (0, 0, 2.5)
    assert effect(SECOND) == nothing
    assert effect(FIRST) != nothing


def test_files_may_be_read_by_everybody_and_written_by_one() -> None:
    field = Field()
    field.request(FIRST)

    def ftp(station: int, opcode: int, path: bytes) -> bool:
        payload = bytes([1, 0, 0, opcode, len(path)]) + bytes(7) + path
        sent = m.FileTransferProtocol(0, 1, 1, payload.ljust(251, b"\0"))
        return bool(field.say(station, sent))

    list_directory, create_directory = 3, 9
    assert ftp(SECOND, list_directory, b"/")
    assert not ftp(SECOND, create_directory, b"/new")
    assert ftp(FIRST, create_directory, b"/new")


def test_a_companion_of_the_vehicles_own_system_is_obeyed() -> None:
    field = Field()
    field.request(FIRST)
    field.send(long(LAND), system=1, component=191, peer="companion")
    assert len(field.vehicle.named("land")) == 1


@both
def test_off_as_delivered(personality: Personality) -> None:
    bench = Bench(personality)
    assert acks(bench.send(long(ASK, 1))) == [(ASK, Result.UNSUPPORTED)]
    heard = bench.advance(5 * S)
    assert not of(heard, m.ControlStatus)
    assert not capabilities(bench) & Capability.COMPONENT_ACCEPTS_GCS_CONTROL


@both
def test_the_capability_says_that_it_is_on(personality: Personality) -> None:
    bench = Bench(personality, operator_control=True)
    assert capabilities(bench) & Capability.COMPONENT_ACCEPTS_GCS_CONTROL


def capabilities(bench: Bench) -> int:
    heard = bench.send(long(REQUEST_MESSAGE, 148))
    return next(each.capabilities for each in heard if isinstance(each, m.AutopilotVersion))
