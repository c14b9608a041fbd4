"""What the vehicle's own parameters say: failsafes, return height, acceptance radius."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

import pytest

from gcs.gate.policy.parse import DEFAULT
from gcs.protocol.autopilot import ARDUPILOT, GENERIC, PX4, Autopilot
from gcs.protocol.effects import Address, Heard, Send
from gcs.session.speedup_waits import Times
from gcs.vehicle.parameters.failsafes import limits_of
from gcs.vehicle.parameters.settings import (
    AcceptanceKnown,
    ClimbEndKnown,
    FailsafesKnown,
    Found,
    ParameterKnown,
    ReturnHeightKnown,
    Settings,
)
from gcs.wire.messages import ParamError, ParamRequestRead, ParamValue
from tests.unit.station.vehicles import SECOND_NS, vehicle

INT32, REAL32 = 6, 9
LIMITS = limits_of(DEFAULT, own_sysid=255)

PX4_ON: dict[str, float | None] = {
    "NAV_DLL_ACT": 2,
    "COM_DL_LOSS_T": 10,
    "NAV_RCL_ACT": 2,
    "GF_ACTION": 2,
    "GF_MAX_HOR_DIST": 150.0,
    "GF_MAX_VER_DIST": 50.0,
    "COM_LOW_BAT_ACT": 2,
    "COM_OF_LOSS_T": 1.0,
    "COM_OBL_RC_ACT": 0,
    "RTL_RETURN_ALT": 30.0,
    "NAV_ACC_RAD": 2.0,
    "NAV_MC_ALT_RAD": 1.5,
    "MIS_TAKEOFF_ALT": 2.5,
    "MPC_XY_CRUISE": 5.0,
}
_COPTER: dict[str, float | None] = {
    "FS_GCS_ENABLE": 1,
    "FS_GCS_TIMEOUT": 5.0,
    "FS_THR_ENABLE": 1,
    "FS_EKF_ACTION": 1,
    "GUID_TIMEOUT": 3.0,
    "FENCE_ENABLE": 1,
    "FENCE_ACTION": 1,
    "FENCE_TYPE": 7,
    "FENCE_RADIUS": 150.0,
    "FENCE_ALT_MAX": 50.0,
    "BATT_FS_LOW_ACT": 2,
    "BATT_LOW_VOLT": 10.5,
    "BATT_LOW_MAH": 0.0,
}
ARDUPILOT_ON: dict[str, float | None] = {
    **_COPTER,
    "SYSID_MYGCS": 255,
    "RTL_ALT": 1500,
    "WPNAV_RADIUS": 200,
    "WPNAV_SPEED": 1000.0,
}
"""With the names of 4.5, whose heights and radii are centimetres."""
ARDUPILOT_4_7: dict[str, float | None] = {
    **_COPTER,
    "MAV_GCS_SYSID": 255,
    "MAV_GCS_SYSID_HI": 0,
    "RTL_ALT_M": 15.0,
    "WP_RADIUS_M": 2.0,
    "WP_SPD": 10.0,
}


def value(autopilot: Autopilot, name: str, number: float) -> ParamValue:
    """As the autopilot puts it: px4 the bytes of an integer, ardupilot its value."""
    integer = isinstance(number, int)
    wire = float(number)
    if integer and autopilot is PX4:
        (wire,) = struct.unpack("<f", struct.pack("<i", number))
    return ParamValue(
        param_value=wire,
        param_count=900,
        param_index=0,
        param_id=name,
        param_type=INT32 if integer else REAL32,
    )


@dataclass
class Script:
    """The settings, a clock, and a vehicle that answers from `params` (None: never)."""

    autopilot: Autopilot
    params: dict[str, float | None]
    now_ns: int = SECOND_NS
    found: list[Found] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.settings = Settings(Address(255, 190), Times(), LIMITS)
        self.telemetry = vehicle(self.autopilot)

    def start(self) -> None:
        self._take(self.settings.start(self.telemetry, self.now_ns))

    def run(self, seconds: float) -> None:
        until_ns = self.now_ns + round(seconds * SECOND_NS)
        while (due_ns := self.settings.deadline_ns) is not None and due_ns <= until_ns:
            self.now_ns = due_ns
            self._take(self.settings.wake(self.telemetry, due_ns))
        self.now_ns = until_ns

    def hear(self, message: ParamValue | ParamError) -> None:
        heard = Heard(1, 1, message)
        self._take(self.settings.heard(heard, self.telemetry, self.now_ns))

    def _take(self, found: list[Found]) -> None:
        self.found += found
        for item in found:
            if isinstance(item, Send) and isinstance(item.message, ParamRequestRead):
                self._answer(item.message.param_id)

    def _answer(self, name: str) -> None:
        if name not in self.params:
            no_such = ParamError(
                param_index=-1, target_system=255, target_component=190, param_id=name, error=1
            )
            self.hear(no_such)
        elif (number := self.params[name]) is not None:
            self.hear(value(self.autopilot, name, number))

    @property
    def asked(self) -> list[str]:
        """Names, a try each."""
        sent = [item.message for item in self.found if isinstance(item, Send)]
        return [message.param_id for message in sent if isinstance(message, ParamRequestRead)]

    @property
    def weak(self) -> list[tuple[str, ...]]:
        """What is said of the failsafes, each time that it is said."""
        return [item.weak for item in self.found if isinstance(item, FailsafesKnown)]

    @property
    def mends(self) -> list[tuple[str, ...]]:
        """The commands that are named to mend it."""
        return [item.mends for item in self.found if isinstance(item, FailsafesKnown)]

    @property
    def return_up_m(self) -> list[float | None]:
        return [item.up_m for item in self.found if isinstance(item, ReturnHeightKnown)]


def test_how_low_a_take_off_may_end_is_read() -> None:
    """PX4 alone has the parameter (1.14 reference: NAV_MC_ALT_RAD, default 0.8 m)."""
    px4, copter = Script(PX4, PX4_ON), Script(ARDUPILOT, ARDUPILOT_4_7)
    px4.start()
    copter.start()
    assert [item.within_m for item in px4.found if isinstance(item, ClimbEndKnown)] == [1.5]
    assert not any(isinstance(item, ClimbEndKnown) for item in copter.found)


# ------------------------------------------------------------------------- the failsafes


@pytest.mark.parametrize(
    ("autopilot", "params", "return_up_m"),
    [
        (PX4, PX4_ON, 30.0),
        (ARDUPILOT, ARDUPILOT_ON, 15.0),
        (ARDUPILOT, ARDUPILOT_4_7, 15.0),
    ],
    ids=["px4", "arducopter 4.5", "arducopter 4.7"],
)
def test_failsafes_that_are_on_are_no_weakness(
    autopilot: Autopilot, params: dict[str, float | None], return_up_m: float
) -> None:
    script = Script(autopilot, params)
    script.start()
    assert set(params) <= set(script.asked)
    assert script.weak == [()]
    assert script.return_up_m == [return_up_m]
    assert AcceptanceKnown(2.0) in script.found
    known = {item.name: item.value for item in script.found if isinstance(item, ParameterKnown)}
    assert known == params
    assert script.settings.deadline_ns is None


def test_the_return_height_comes_first_and_is_told_at_once() -> None:
    """A return waits for it; the rest may still be asked for."""
    script = Script(PX4, {**PX4_ON, "GF_ACTION": None})
    script.start()
    assert script.asked[0] == "RTL_RETURN_ALT"
    assert script.return_up_m == [30.0]
    assert script.weak == []


@pytest.mark.parametrize("answers", [ARDUPILOT_ON, ARDUPILOT_4_7])
def test_an_old_version_that_is_silent_about_the_new_names_is_asked_for_the_old_ones(
    answers: dict[str, float | None],
) -> None:
    new_and_old = {"RTL_ALT_M": None, "RTL_ALT": None, "WP_RADIUS_M": None, "WPNAV_RADIUS": None}
    script = Script(ARDUPILOT, {**new_and_old, **answers})
    script.start()
    script.run(3.0)
    assert script.return_up_m == [15.0]
    assert script.weak == [()]


def test_a_return_height_that_neither_name_has_is_told_as_none() -> None:
    script = Script(ARDUPILOT, {"FS_GCS_ENABLE": 1, "FENCE_ENABLE": 1, "BATT_FS_LOW_ACT": 2})
    script.start()
    assert script.return_up_m == [None]


def test_a_return_height_that_is_lost_on_the_way_is_asked_for_until_it_comes() -> None:
    script = Script(PX4, {**PX4_ON, "RTL_RETURN_ALT": None})
    script.start()
    script.run(60.0)
    assert script.return_up_m == []
    assert script.asked.count("RTL_RETURN_ALT") > 15
    script.params["RTL_RETURN_ALT"] = 30.0
    script.run(9.0)
    assert script.return_up_m == [30.0]


@pytest.mark.parametrize(
    ("autopilot", "params", "name", "about", "mended"),
    [
        (PX4, PX4_ON, "NAV_DLL_ACT", "ground-station loss", 2),
        (PX4, PX4_ON, "GF_ACTION", "geofence breach", 2),
        (PX4, PX4_ON, "COM_LOW_BAT_ACT", "low battery", 3),
        (ARDUPILOT, ARDUPILOT_ON, "FS_GCS_ENABLE", "ground-station loss", 1),
        (ARDUPILOT, ARDUPILOT_ON, "FENCE_ENABLE", "geofence breach", 1),
        (ARDUPILOT, ARDUPILOT_ON, "BATT_FS_LOW_ACT", "low battery", 2),
    ],
)
def test_a_failsafe_that_is_off_is_named_with_what_mends_it(
    autopilot: Autopilot, params: dict[str, float | None], name: str, about: str, mended: int
) -> None:
    script = Script(autopilot, {**params, name: 0})
    script.start()
    assert script.weak == [(f"{about}: off ({name} = 0)",)]
    assert script.mends == [(f"gcs param set {name} {mended}",)]


def test_a_failsafe_that_nothing_is_known_of_is_not_taken_for_on() -> None:
    """The vehicle says that it has no such parameter, and is not asked a second time."""
    script = Script(PX4, {name: on for name, on in PX4_ON.items() if name != "GF_ACTION"})
    script.start()
    assert script.weak == [("geofence breach: GF_ACTION could not be read",)]
    script.run(60.0)
    assert script.asked.count("GF_ACTION") == 1


def test_silence_is_asked_again_and_again_until_it_is_over() -> None:
    script = Script(PX4, {**PX4_ON, "GF_ACTION": None})
    script.start()
    script.run(2.0)
    assert script.asked.count("GF_ACTION") == 3
    assert script.weak[-1] == ("geofence breach: GF_ACTION could not be read",)
    script.run(30.0)
    assert script.asked.count("GF_ACTION") > 6
    assert len(script.weak) == 1  # nothing new was found
    script.params["GF_ACTION"] = 2
    script.run(10.0)
    assert [len(weak) for weak in script.weak] == [1, 0]
    assert script.settings.deadline_ns is None


def test_a_failsafe_that_somebody_switches_off_later_is_noticed() -> None:
    script = Script(PX4, PX4_ON)
    script.start()
    script.hear(value(PX4, "NAV_DLL_ACT", 0))
    assert script.weak[-1] == ("ground-station loss: off (NAV_DLL_ACT = 0)",)


def test_a_return_height_that_somebody_changes_later_is_noticed() -> None:
    script = Script(PX4, PX4_ON)
    script.start()
    script.hear(value(PX4, "RTL_RETURN_ALT", 60.0))
    assert script.return_up_m[-1] == 60.0


@pytest.mark.parametrize(
    "news",
    [
        value(PX4, "NAV_DLL_ACT", 2),  # as it was
        value(PX4, "MPC_XY_VEL_MAX", 5.0),  # none of ours
        ParamValue(
            param_value=0.0, param_count=1, param_index=0, param_id="GF_ACTION", param_type=99
        ),
    ],
)
def test_a_parameter_that_changes_nothing_is_no_news(news: ParamValue) -> None:
    script = Script(PX4, PX4_ON)
    script.start()
    before = len(script.found)
    script.hear(news)
    assert script.found[before:] == []


def test_nothing_is_said_to_be_on_of_an_autopilot_of_an_unknown_kind() -> None:
    """station.md, bug 5: it was asked for nothing, and its failsafes were called all on."""
    script = Script(GENERIC, {})
    script.start()
    script.run(60.0)
    assert script.asked == []
    ((weak,),) = script.weak
    assert "not known" in weak
    assert script.return_up_m == [None]


def test_a_vehicle_that_is_met_anew_is_read_anew() -> None:
    script = Script(PX4, PX4_ON)
    script.start()
    script.params["GF_ACTION"] = 0
    script.start()
    assert len(script.weak) == 2
    assert script.weak[-1] == ("geofence breach: off (GF_ACTION = 0)",)
