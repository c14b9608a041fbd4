"""What DO_ORBIT asks for: by MAVLink's common.xml."""

from __future__ import annotations

import math

import pytest

from gcs import ipc
from gcs.bridge.translate.meaning import Words
from gcs.bridge.translate.translate import meaning_of
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.wire.ids import Cmd
from tests.unit.bridge.vehicles import (
    NAN,
    UNSET,
    command_int,
    command_long,
    flying,
    refusal,
    words,
)

BOTH = pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT], ids=lambda a: a.name)
ORBIT = int(Cmd.DO_ORBIT)
SEA, HOME, TERRAIN, LOCAL = 0, 3, 10, 1


def circle(meaning: object) -> ipc.Circle:
    assert isinstance(meaning, Words), meaning
    orbit = meaning.asks[-1].orbit
    assert orbit is not None
    return orbit


@BOTH
def test_nothing_given_is_left_to_the_station(autopilot: Autopilot) -> None:
    nothing = command_int(ORBIT, SEA, (NAN,) * 4, UNSET, UNSET, NAN)
    assert circle(meaning_of(nothing, flying(autopilot))) == ipc.Circle((None, None, None))
    nothing = command_long(ORBIT, *(NAN,) * 7)
    assert circle(meaning_of(nothing, flying(autopilot))) == ipc.Circle((None, None, None))


@BOTH
@pytest.mark.parametrize(("frame", "told"), [(SEA, False), (HOME, True)])
def test_everything_given(autopilot: Autopilot, frame: int, told: bool) -> None:
    """The origin is 488 m above the sea.  MAVSDK 4.1.0 sends heights above the sea in frame 3."""
    x, y = round(47.397742e7), round(8.545594e7)
    asked = command_int(ORBIT, frame, (-20.0, 3.0, 3.0, math.pi), x, y, 520.0)
    meant = meaning_of(asked, flying(autopilot))
    found = circle(meant)
    assert isinstance(meant, Words)
    assert ("above sea level" in meant.note) == told
    assert found.centre_enu == pytest.approx((0.0, 0.0, 32.0), abs=0.01)
    assert (found.radius_m, found.speed_m_s, found.nose) == (-20.0, 3.0, "along")
    assert found.turns == pytest.approx(0.5)


@BOTH
def test_a_height_alone(autopilot: Autopilot) -> None:
    asked = command_int(ORBIT, SEA, (NAN,) * 4, UNSET, UNSET, 520.0)
    assert circle(meaning_of(asked, flying(autopilot))).centre_enu == (None, None, 32.0)


@pytest.mark.parametrize(
    ("p3", "nose"),
    [(0.0, "centre"), (1.0, "initial"), (2.0, "free"), (3.0, "along"), (5.0, ""), (NAN, "")],
)
def test_yaw_behaviours(p3: float, nose: str) -> None:
    asked = command_long(ORBIT, 10.0, 2.0, p3, 0.0, NAN, NAN, NAN)
    assert circle(meaning_of(asked, flying(PX4))).nose == nose


@BOTH
@pytest.mark.parametrize("state", [State.HOLDING, State.EXTERNAL])
def test_after_a_hold_it_resumes(autopilot: Autopilot, state: State) -> None:
    asked = command_long(ORBIT, 10.0, 2.0, 0.0, 0.0, NAN, NAN, NAN)
    assert words(meaning_of(asked, flying(autopilot, state=state))) == ["resume", "orbit"]


@BOTH
@pytest.mark.parametrize(
    ("params", "why"),
    [
        ((10.0, 2.0, 4.0), "the sticks turn"),
        ((10.0, 2.0, 6.0), "yaw behaviour 6"),
        ((10.0, 2.0, 0.5), "yaw behaviour 0.5"),
        ((math.inf, 2.0), "infinite"),
        ((10.0, -math.inf), "infinite"),
        ((10.0, 2.0, 0.0, math.inf), "infinite"),
        ((10.0, 2.0, 0.0, 0.0, 91.0, 8.0, 500.0), "no place on the map"),
        ((10.0, 2.0, 0.0, 0.0, NAN, 8.0, 500.0), "no place on the map"),
    ],
)
def test_what_is_none(autopilot: Autopilot, params: tuple[float, ...], why: str) -> None:
    assert why in refusal(meaning_of(command_long(ORBIT, *params), flying(autopilot)))


@BOTH
@pytest.mark.parametrize("frame", [TERRAIN, LOCAL])
def test_frames_that_are_not_for_a_map(autopilot: Autopilot, frame: int) -> None:
    asked = command_int(ORBIT, frame, (10.0, 2.0), UNSET, UNSET, 20.0)
    assert refusal(meaning_of(asked, flying(autopilot))).startswith("UNSUPPORTED")


@BOTH
def test_a_place_on_the_map_needs_the_origin(autopilot: Autopilot) -> None:
    asked = command_int(ORBIT, SEA, (10.0, 2.0), 473977420, 85455940, 500.0)
    assert refusal(meaning_of(asked, flying(autopilot, origin=None))).startswith("NO_ORIGIN")
