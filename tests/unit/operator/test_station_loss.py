"""What is told of the vehicle when the station's process has died."""

from __future__ import annotations

from typing import Any

import pytest

from gcs import ipc
from gcs.gate.policy.parse import DEFAULT
from gcs.operator.client import StationEnded
from gcs.operator.conversation import Conversation, TrackedRequest
from gcs.operator.dialogue import Dialogue
from gcs.operator.errors import ExitError
from gcs.operator.station_loss import after_station_died
from gcs.vehicle.parameters.failsafes import findings, limits_of
from tests.unit.operator.fake_station import FakeConnection, FakeStation, NoInterrupts


class OfAKilledStation(FakeConnection):
    """A station that ends without a word."""

    def _ended(self) -> StationEnded:
        return KILLED


KILLED = StationEnded(None, -9, "")
LIMITS = limits_of(DEFAULT, 255)


def flying(autopilot: str, mode: str = "", **values: float) -> ipc.Snapshot:
    """The last snapshot of a vehicle with these parameters, as the session makes it."""
    failsafes = [each.words for each in findings(autopilot, values, LIMITS)]
    return seen(vehicle=f"1/1 {autopilot} quadrotor", mode=mode, failsafes=failsafes)


def seen(**known: Any) -> ipc.Snapshot:
    given: dict[str, Any] = {"armed": True, **known}
    return ipc.Snapshot(0, "AWAY", "OURS", "OK", [], 0.0, "logs/x.mcap", True, 1.0, **given)


def test_an_ardupilot_whose_failsafe_is_off_goes_on() -> None:
    told = after_station_died(flying("ardupilot", "GUIDED", FS_GCS_ENABLE=0.0))
    assert "ground-station failsafe is off (FS_GCS_ENABLE = 0): it goes on with what it" in told
    assert "an ArduPilot flies to its last goal" in told
    assert told.endswith("its setpoints have ended: stop of velocities, positions are held")


def test_what_leads_to_an_action_is_told_with_its_time() -> None:
    told = after_station_died(flying("ardupilot", FS_GCS_ENABLE=1.0, FS_GCS_TIMEOUT=5.0))
    assert told.endswith("unless it hears another station: return after 5 s")
    assert "goes on" not in told


def test_one_that_watches_another_station_is_not_said_to_act() -> None:
    told = after_station_died(flying("ardupilot", FS_GCS_ENABLE=1.0, MAV_GCS_SYSID=7.0))
    assert "does not act on this: it watches another station than this one, 255" in told
    assert "it goes on with what it was told" in told


def test_a_px4_in_offboard_has_a_setting_for_setpoints_that_end() -> None:
    settings = {"NAV_DLL_ACT": 0.0, "COM_OBL_RC_ACT": 5.0, "COM_OF_LOSS_T": 1.0}
    told = after_station_died(flying("px4", "OFFBOARD", **settings))
    assert "is off (NAV_DLL_ACT = 0)" in told
    assert told.endswith("its setpoints have ended: hold after 1 s")
    assert "setpoints" not in after_station_died(flying("px4", "AUTO.MISSION", **settings))


@pytest.mark.parametrize(
    ("last", "told"),
    [
        (None, "no vehicle had been heard"),
        (seen(vehicle=""), "no vehicle had been heard"),
        (seen(vehicle="1/1 px4 quadrotor", armed=False), "the vehicle was disarmed"),
        (
            seen(vehicle="1/1 px4 quadrotor"),
            "what the vehicle does without a ground station is not known: it was not read",
        ),
        (
            flying("ardupilot"),
            "what the vehicle does without a ground station is not known: "
            "FS_GCS_ENABLE could not be read",
        ),
    ],
)
def test_what_is_not_known_is_not_made_up(last: ipc.Snapshot | None, told: str) -> None:
    assert after_station_died(last) == told


def test_of_several_vehicles_the_others_are_named_as_not_known() -> None:
    both = ["1/1 px4 quadrotor", "2/1 px4 quadrotor"]
    told = after_station_died(seen(vehicle=both[0], vehicles=both))
    assert told.endswith("that is 1/1 px4 quadrotor; of 1 more nothing is known here")


def test_the_error_says_it_and_names_the_record() -> None:
    talk = Conversation()
    talk.told(flying("ardupilot", FS_GCS_ENABLE=0.0))
    talk.told(KILLED)
    error = talk.unexpected_end()
    assert str(error).startswith("the link process died (exit code -9); the vehicle's own ground-")
    assert "gcs log recover logs/x.mcap -o WHOLE.mcap\nit left no word" in error.hint


def test_a_dialogue_tells_what_its_last_snapshot_had() -> None:
    station = FakeStation("airborne")
    dialogue = Dialogue(OfAKilledStation(station), NoInterrupts(), ignore)
    dialogue.wait_for_vehicle(1.0)
    station.done = True
    with pytest.raises(ExitError, match="not known: it was not read") as failed:
        dialogue.poll(0.1)
    assert "gcs log recover logs/" in failed.value.hint


def ignore(event: ipc.Event, request: TrackedRequest | None) -> None:
    pass
