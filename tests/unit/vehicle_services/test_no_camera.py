"""`--camera none`: a vehicle as the recorded ones were, which carried no camera.

Rows: `behaviour.json` "camera commands 2000/2001/521" and "commands for absent components";
`commands_px4.json` and `commands_arducopter.json`, the rows of cameras.
"""

from __future__ import annotations

import pytest

from tests.unit.vehicle_services.fake_vehicle import S, acks, long, of
from tests.unit.vehicle_services.flown_vehicle import Flown
from tests.unit.vehicle_services.test_real_acks import (
    CAMERA,
    CAMERA_MESSAGES,
    COMMON,
    ON_PURPOSE,
    RESULTS,
    recorded,
    rows_of,
)
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd

ROWS = [
    row
    for personality in ("px4", "ardupilot")
    for row in rows_of(personality)
    if ON_PURPOSE.get((row[0], row[2])) == CAMERA and row[1] == "ground"
]


def bare(personality: Personality) -> Flown:
    bench = Flown(personality, camera=False)
    bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3))
    bench.advance(2 * S)
    return bench


@pytest.mark.parametrize(("personality", "stage", "what", "real"), ROWS)
def test_a_camera_command_is_answered_as_by_the_real_one(
    personality: Personality, stage: str, what: str, real: str
) -> None:
    assert bare(personality).result(COMMON[what]) == RESULTS[real]


def test_every_recorded_row_of_a_camera_is_here() -> None:
    assert {(row[0], row[2]) for row in ROWS} == {
        ("px4", "2000 image"),
        ("px4", "2001 imagestop"),
        ("px4", "530 cam mode"),
        ("px4", "521 caminfo"),
        ("ardupilot", "2000 image"),
        ("ardupilot", "530 cam mode"),
        ("ardupilot", "521 caminfo"),
    }


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_a_cameras_messages_are_answered_as_by_the_real_one(personality: Personality) -> None:
    bench = bare(personality)
    rows = [row for row in recorded(personality)[1] if row[0] in CAMERA_MESSAGES[personality]]
    assert len(rows) == len(CAMERA_MESSAGES[personality])
    for number, _, result, sent in rows:
        heard = bench.send(long(512, number))
        assert acks(heard) == [(512, RESULTS[result])]
        assert sent == "not sent"
        assert number not in {m.IDS[type(each)] for each in heard}
        bench.advance(4 * S)


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_nothing_takes_a_picture(personality: Personality) -> None:
    """DO_DIGICAM_CONTROL is accepted by ArduCopter all the same, as recorded."""
    bench = bare(personality)
    for asked in (COMMON["2000 image"], COMMON["203 digicam"]):
        bench.send(asked)
    heard = bench.advance(10 * S)
    assert not of(heard, m.CameraImageCaptured)
    assert bench.autopilot.images_captured == 0


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_a_camera_cannot_be_streamed(personality: Personality) -> None:
    bench = bare(personality)
    asked = long(Cmd.SET_MESSAGE_INTERVAL, m.IDS[m.CameraSettings], 1e6)
    assert bench.result(asked) != Result.ACCEPTED
    assert not of(bench.advance(3 * S), m.CameraSettings)


def test_a_mission_flies_on_without_its_pictures() -> None:
    """A mission asks the vehicle itself, not its services."""
    bench = bare("px4")
    bench.autopilot.parts.mission_support.take_pictures(0.0, 3)
    bench.advance(10 * S)
    assert bench.autopilot.images_captured == 0
