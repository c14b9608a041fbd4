"""What a vehicle that was just met is asked: its failsafes, and what is needed of its telemetry."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

import pytest

from gcs.config import StationConfig
from gcs.protocol.autopilot import ARDUPILOT, GENERIC, PX4, Autopilot
from gcs.protocol.effects import Heard, Send
from gcs.session.discovery import Discovery, Found, ParameterKnown, SettingsKnown
from gcs.wire.ids import Cmd, MsgId
from gcs.wire.messages import CommandLong, ParamError, ParamRequestRead, ParamValue
from tests.unit.session.vehicles import HOME, SECOND_NS, vehicle

INT32, REAL32 = 6, 9

PX4_ON: dict[str, float | None] = {
    "NAV_DLL_ACT": 2,
    "GF_ACTION": 2,
    "COM_LOW_BAT_ACT": 2,
    "COM_OF_LOSS_T": 1.0,
    "COM_OBL_RC_ACT": 0,
    "RTL_RETURN_ALT": 30.0,
    "NAV_MC_ALT_RAD": 1.5,
}
ARDUPILOT_ON: dict[str, float | None] = {
    "FS_GCS_ENABLE": 1,
    "FENCE_ENABLE": 1,
    "BATT_FS_LOW_ACT": 2,
    "RTL_ALT": 1500,
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
    """A discovery, its clock, and a vehicle that answers from `params` (None: never)."""

    autopilot: Autopilot
    params: dict[str, float | None]
    now_ns: int = SECOND_NS
    found: list[Found] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.discovery = Discovery(StationConfig())
        self.telemetry = vehicle(self.autopilot)

    def start(self) -> None:
        self._take(self.discovery.start(self.telemetry, self.now_ns))

    def run(self, seconds: float) -> None:
        until_ns = self.now_ns + round(seconds * SECOND_NS)
        while (due_ns := self.discovery.deadline_ns) is not None and due_ns <= until_ns:
            self.now_ns = due_ns
            self._take(self.discovery.wake(self.telemetry, due_ns))
        self.now_ns = until_ns

    def hear(self, message: ParamValue | ParamError) -> None:
        heard = Heard(1, 1, message)
        self._take(self.discovery.heard(heard, self.telemetry, self.now_ns))

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
    def settings(self) -> list[SettingsKnown]:
        return [item for item in self.found if isinstance(item, SettingsKnown)]


# ------------------------------------------------------------------------- the failsafes


@pytest.mark.parametrize(
    ("autopilot", "params", "return_up_m", "climb_ends_within_m"),
    [(PX4, PX4_ON, 30.0, 1.5), (ARDUPILOT, ARDUPILOT_ON, 15.0, 0.0)],  # RTL_ALT is centimetres
)
def test_failsafes_that_are_on_are_no_weakness(
    autopilot: Autopilot,
    params: dict[str, float | None],
    return_up_m: float,
    climb_ends_within_m: float,
) -> None:
    script = Script(autopilot, params)
    script.start()
    assert sorted(script.asked) == sorted(params)
    assert script.settings == [SettingsKnown((), return_up_m, climb_ends_within_m)]
    known = {item.name: item.value for item in script.found if isinstance(item, ParameterKnown)}
    assert known == params
    assert script.discovery.deadline_ns is None


@pytest.mark.parametrize(
    ("autopilot", "params", "name", "about"),
    [
        (PX4, PX4_ON, "NAV_DLL_ACT", "ground-station loss"),
        (PX4, PX4_ON, "GF_ACTION", "geofence breach"),
        (PX4, PX4_ON, "COM_LOW_BAT_ACT", "low battery"),
        (ARDUPILOT, ARDUPILOT_ON, "FS_GCS_ENABLE", "ground-station loss"),
        (ARDUPILOT, ARDUPILOT_ON, "FENCE_ENABLE", "geofence breach"),
        (ARDUPILOT, ARDUPILOT_ON, "BATT_FS_LOW_ACT", "low battery"),
    ],
)
def test_a_failsafe_that_is_off_is_named(
    autopilot: Autopilot, params: dict[str, float | None], name: str, about: str
) -> None:
    script = Script(autopilot, {**params, name: 0})
    script.start()
    (settings,) = script.settings
    assert settings.weak == (f"{about}: off ({name} = 0)",)


def test_a_failsafe_that_nothing_is_known_of_is_not_taken_for_on() -> None:
    """The vehicle says that it has no such parameter, and is not asked a second time."""
    script = Script(PX4, {name: on for name, on in PX4_ON.items() if name != "GF_ACTION"})
    script.start()
    (settings,) = script.settings
    assert settings.weak == ("geofence breach: GF_ACTION could not be read",)
    script.run(60.0)
    assert script.asked.count("GF_ACTION") == 1


def test_silence_is_asked_again_and_again_until_it_is_over() -> None:
    script = Script(PX4, {**PX4_ON, "GF_ACTION": None})
    script.start()
    script.run(2.0)
    assert script.asked.count("GF_ACTION") == 3
    assert script.settings[-1].weak == ("geofence breach: GF_ACTION could not be read",)
    script.run(30.0)
    assert script.asked.count("GF_ACTION") > 6
    assert len(script.settings) == 1  # nothing new was found
    script.params["GF_ACTION"] = 2
    script.run(10.0)
    assert script.settings[-1] == SettingsKnown((), 30.0, 1.5)
    assert script.discovery.deadline_ns is None


def test_a_failsafe_that_somebody_switches_off_later_is_noticed() -> None:
    script = Script(PX4, PX4_ON)
    script.start()
    script.hear(value(PX4, "NAV_DLL_ACT", 0))
    assert script.settings[-1].weak == ("ground-station loss: off (NAV_DLL_ACT = 0)",)


def test_a_return_height_that_somebody_changes_later_is_noticed() -> None:
    script = Script(PX4, PX4_ON)
    script.start()
    script.hear(value(PX4, "RTL_RETURN_ALT", 60.0))
    assert script.settings[-1].return_up_m == 60.0


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


def test_an_autopilot_of_an_unknown_kind_is_asked_for_no_parameter() -> None:
    script = Script(GENERIC, {})
    script.start()
    script.run(60.0)
    assert script.asked == []


def test_a_vehicle_that_is_met_anew_is_read_anew() -> None:
    script = Script(PX4, PX4_ON)
    script.start()
    script.params["GF_ACTION"] = 0
    script.start()
    assert len(script.settings) == 2
    assert script.settings[-1].weak == ("geofence breach: off (GF_ACTION = 0)",)


# ------------------------------------------------------------------------- the telemetry


def ask(script: Script, seconds: float = 0.0) -> list[CommandLong]:
    script.now_ns += round(seconds * SECOND_NS)
    return list(script.discovery.missing(script.telemetry, script.now_ns))


def once(commands: list[CommandLong]) -> set[float]:
    return {c.param1 for c in commands if c.command == Cmd.REQUEST_MESSAGE}


def rates_hz(commands: list[CommandLong]) -> dict[float, float]:
    """By message id; param2 is the interval in microseconds."""
    wanted = [c for c in commands if c.command == Cmd.SET_MESSAGE_INTERVAL]
    return {c.param1: 1e6 / c.param2 for c in wanted}


def test_at_first_everything_is_asked_for() -> None:
    script = Script(PX4, PX4_ON)
    commands = ask(script)
    assert once(commands) == {
        MsgId.GPS_GLOBAL_ORIGIN,
        MsgId.HOME_POSITION,
        MsgId.AUTOPILOT_VERSION,
    }
    assert {MsgId.LOCAL_POSITION_NED, MsgId.EXTENDED_SYS_STATE} <= set(rates_hz(commands))
    assert {(c.target_system, c.target_component) for c in commands} == {(1, 1)}
    unused = {(c.param3, c.param4, c.param5, c.param6, c.param7) for c in commands}
    assert unused == {(0.0,) * 5}  # param7 0: whoever sends it, sends it as it always does


def test_positions_come_at_least_at_10_hz_for_the_prediction_of_the_stop() -> None:
    assert rates_hz(ask(Script(PX4, PX4_ON)))[MsgId.LOCAL_POSITION_NED] >= 10.0


def test_what_did_not_come_is_asked_for_again_every_two_seconds() -> None:
    script = Script(PX4, PX4_ON)
    ask(script)
    assert ask(script, 1.9) == []
    assert once(ask(script, 0.2)) == {MsgId.GPS_GLOBAL_ORIGIN, MsgId.HOME_POSITION}
    assert ask(script, 1.9) == []


def test_what_came_is_not_asked_for_again() -> None:
    script = Script(PX4, PX4_ON)
    ask(script)
    telemetry = script.telemetry
    telemetry.origin, telemetry.home = HOME, (47.0, 8.0, 488.0)
    telemetry.pos_ned, telemetry.landed_ns = (0.0, 0.0, 0.0), script.now_ns + 2 * SECOND_NS
    assert ask(script, 3.0) == []


def test_a_landed_state_that_stops_coming_is_asked_for_again() -> None:
    script = Script(PX4, PX4_ON)
    ask(script)
    telemetry = script.telemetry
    telemetry.origin, telemetry.home = HOME, (47.0, 8.0, 488.0)
    telemetry.pos_ned, telemetry.landed_ns = (0.0, 0.0, 0.0), script.now_ns
    assert set(rates_hz(ask(script, 3.0))) == {MsgId.EXTENDED_SYS_STATE}


@pytest.mark.parametrize(("speedup", "hz"), [(1.0, 30.0), (4.0, 120.0), (100.0, 200.0)])
def test_a_sped_up_vehicle_is_asked_for_positions_so_much_more_often_up_to_a_limit(
    speedup: float, hz: float
) -> None:
    discovery = Discovery(StationConfig(speedup=speedup))
    commands = list(discovery.missing(vehicle(), SECOND_NS))
    assert rates_hz(commands)[MsgId.LOCAL_POSITION_NED] == pytest.approx(hz, rel=1e-4)
