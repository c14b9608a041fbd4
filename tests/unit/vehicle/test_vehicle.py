"""One vehicle: which one is ours, over which link it is answered, and what of it is void."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from msgspec import structs

from gcs.config import StationConfig
from gcs.gate import inputs
from gcs.gate.condition import Condition
from gcs.gate.effects import Level
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code
from gcs.protocol.effects import Send
from gcs.session.speedup_waits import Times
from gcs.session.work import GateInput, Log, PlaceFence, Work
from gcs.vehicle.parameters.failsafes import parameters_of
from gcs.vehicle.parameters.settings import READ_FIRST, READ_LAST
from gcs.vehicle.vehicle import Vehicle
from gcs.wire.frame import Frame, split
from gcs.wire.ids import Cmd, MsgId
from gcs.wire.messages import CommandLong
from tests.unit.station import wire
from tests.unit.station.wire import MS_NS, SECOND_NS, START_NS, Message, Sender


class Script:
    """One vehicle of the session, a clock, and senders for it and for others."""

    def __init__(self, config: StationConfig | None = None, policy: Policy = DEFAULT) -> None:
        self.config = config or StationConfig()
        self.policy = policy
        self.vehicle = Vehicle(self.config, self.policy, Times(self.config.speedup), START_NS)
        self.now_ns = START_NS
        self.sender = Sender()

    def hear(
        self,
        *messages: Message,
        link: int = 0,
        sender: Sender | None = None,
        mavlink1: bool = False,
    ) -> list[Work]:
        sender = sender or self.sender
        work: list[Work] = []
        for message in messages:
            work += self.bytes(sender.frame(message, mavlink1=mavlink1), link)
        return work

    def bytes(self, raw: bytes, link: int = 0) -> list[Work]:
        (frame,) = split(raw)
        assert isinstance(frame, Frame)
        return self.vehicle.frames.frame(link, frame, self.now_ns)

    def wait(self, seconds: float) -> None:
        self.now_ns += round(seconds * SECOND_NS)

    @property
    def link(self) -> int:
        assert self.vehicle.telemetry is not None
        return self.vehicle.telemetry.link


def gate_inputs(work: Iterable[Work]) -> list[inputs.Input]:
    return [item.given for item in work if isinstance(item, GateInput)]


def log(work: Iterable[Work]) -> list[tuple[Level, str]]:
    return [(item.level, item.text) for item in work if isinstance(item, Log)]


def requested(work: Iterable[Work]) -> set[float]:
    """Message ids that are asked for once."""
    sent = [item.message for item in work if isinstance(item, Send)]
    asks = [message for message in sent if isinstance(message, CommandLong)]
    return {ask.param1 for ask in asks if ask.command == Cmd.REQUEST_MESSAGE}


# ---------------------------------------------------------------------------- which one


def test_the_first_autopilot_that_is_heard_is_our_vehicle() -> None:
    script = Script()
    assert script.vehicle.sysid == 0
    work = script.hear(wire.heartbeat(), sender=Sender(3))
    assert (Level.INFO, "vehicle 3/1 px4 quadrotor on link 0") in log(work)
    script.hear(wire.heartbeat(), sender=Sender(4))
    assert script.vehicle.sysid == 3


@pytest.mark.parametrize(
    ("sender", "beat"),
    [
        (Sender(254, 190), wire.heartbeat(wire.NO_AUTOPILOT, type_=wire.GCS)),
        (Sender(2, 1), wire.heartbeat(wire.PX4, type_=wire.GCS)),
        (Sender(1, 100), wire.heartbeat(wire.NO_AUTOPILOT, type_=30)),  # a camera
        (Sender(1, 191), wire.heartbeat(wire.PX4)),  # not the autopilot's component id
    ],
)
def test_stations_cameras_and_companions_are_no_vehicle(sender: Sender, beat: Message) -> None:
    script = Script()
    assert script.hear(beat, sender=sender) == []
    assert script.vehicle.telemetry is None


def test_a_vehicle_that_was_named_is_waited_for() -> None:
    script = Script(StationConfig(target_sysid=4))
    assert script.hear(wire.heartbeat(), sender=Sender(3)) == []
    script.hear(wire.heartbeat(), sender=Sender(4))
    assert script.vehicle.sysid == 4


@pytest.mark.parametrize(
    ("autopilot", "name"),
    [(wire.PX4, "px4"), (wire.ARDUPILOT, "ardupilot"), (99, "of an unknown kind")],
)
def test_its_heartbeat_tells_which_autopilot_it_is(autopilot: int, name: str) -> None:
    script = Script()
    script.hear(wire.heartbeat(autopilot))
    assert script.vehicle.telemetry is not None
    assert script.vehicle.telemetry.autopilot.name == name


def test_before_a_heartbeat_nothing_is_believed() -> None:
    script = Script()
    assert script.hear(wire.position(1, (1.0, 2.0, 3.0)), wire.landed(wire.IN_AIR)) == []


def test_a_vehicle_that_is_met_is_asked_for_its_origin_its_home_and_its_version() -> None:
    work = Script().hear(wire.heartbeat())
    assert requested(work) == {MsgId.GPS_GLOBAL_ORIGIN}  # one at a time
    names = [
        item.message.param_id
        for item in work
        if isinstance(item, Send) and hasattr(item.message, "param_id")
    ]
    assert names[0] == "RTL_RETURN_ALT"  # a return waits for it
    assert len(names) == len(set(names)), "each is asked for once"
    wanted = {table["px4"] for table in (*READ_FIRST, *READ_LAST)} | {*parameters_of("px4")}
    assert set(names) == wanted


def test_what_a_thrust_means_is_asked_for_where_attitudes_may_be_flown() -> None:
    stream = structs.replace(DEFAULT.stream, tilt_deg=5.0)
    script = Script(policy=structs.replace(DEFAULT, stream=stream))
    names = [
        item.message.param_id
        for item in script.hear(wire.heartbeat())
        if isinstance(item, Send) and hasattr(item.message, "param_id")
    ]
    assert names[-1] == "MPC_THR_HOVER"
    assert len(names) == len(set(names))


def test_several_vehicles_are_named_and_none_is_meant() -> None:
    """newcomer.md, 7: it flew the first one silently."""
    script = Script()
    script.hear(wire.heartbeat())
    assert script.vehicle.listening(script.now_ns)
    script.wait(0.9)
    work = script.hear(wire.heartbeat(wire.ARDUPILOT), sender=Sender(2))
    names = "1/1 px4 quadrotor, 2/1 ardupilot quadrotor"
    assert log(work) == [(Level.WARNING, f"several vehicles are heard: {names}")]
    refusal = script.vehicle.refusal(script.now_ns)
    assert refusal is not None
    assert refusal.code is Code.SEVERAL_VEHICLES
    assert names in refusal.sentence
    assert "--vehicle" in refusal.sentence
    script.hear(wire.float_param("RTL_RETURN_ALT", 30.0), wire.no_rally_points())
    assert script.vehicle.listening(script.now_ns)
    script.wait(0.4)
    assert not script.vehicle.listening(script.now_ns)


def test_a_vehicle_that_was_named_is_meant() -> None:
    script = Script(StationConfig(target_sysid=2))
    script.hear(wire.heartbeat())
    script.hear(wire.heartbeat(), sender=Sender(2))
    assert script.vehicle.refusal(script.now_ns) is None
    assert script.vehicle.listening(script.now_ns), "for its return height"
    script.hear(wire.float_param("RTL_RETURN_ALT", 30.0), sender=Sender(2))
    assert script.vehicle.listening(script.now_ns), "for its rally points"
    script.hear(wire.no_rally_points(), sender=Sender(2))
    assert not script.vehicle.listening(script.now_ns)
    assert script.vehicle.roster.names(script.now_ns) == [
        "1/1 px4 quadrotor",
        "2/1 px4 quadrotor",
    ]


def test_once_the_other_one_is_gone_it_is_clear_again() -> None:
    script = Script()
    script.hear(wire.heartbeat())
    script.hear(wire.heartbeat(), sender=Sender(2))
    for _ in range(4):
        script.wait(1.0)
        script.hear(wire.heartbeat())
    assert script.vehicle.refusal(script.now_ns) is None


def test_one_that_comes_later_does_not_keep_the_other_from_being_stopped() -> None:
    script = Script()
    script.hear(wire.heartbeat())
    assert script.vehicle.refusal(script.now_ns) is None  # a request is let through
    script.hear(wire.heartbeat(), sender=Sender(2))
    assert script.vehicle.refusal(script.now_ns) is None


@pytest.mark.parametrize(
    ("autopilot", "type_", "name"),
    [
        (wire.ARDUPILOT, 1, "1/1 ardupilot fixed wing"),
        (wire.ARDUPILOT, 10, "1/1 ardupilot ground rover"),
        (wire.PX4, 22, "1/1 px4 vtol reserved2"),
        (99, 2, "1/1 of an unknown kind quadrotor"),
    ],
)
def test_what_is_no_multirotor_is_shown_and_cannot_be_asked(
    autopilot: int, type_: int, name: str
) -> None:
    script = Script()
    work = script.hear(wire.heartbeat(autopilot, type_=type_))
    assert script.vehicle.telemetry is not None
    assert script.vehicle.telemetry.label == name
    assert [g for g in gate_inputs(work) if isinstance(g, inputs.HeartbeatSeen)]
    refusal = script.vehicle.refusal(script.now_ns)
    assert refusal is not None
    assert refusal.code is Code.UNSUPPORTED_VEHICLE
    assert "multirotors" in refusal.sentence
    assert name in refusal.sentence


# ----------------------------------------------------------------------------- its links


def test_it_is_answered_where_it_was_heard_first_while_that_link_is_alive() -> None:
    script = Script()
    script.hear(wire.heartbeat(), link=1)
    script.wait(1.9)
    script.hear(wire.heartbeat(), link=0)
    assert script.link == 1


def test_a_link_that_is_silent_for_two_seconds_is_replaced_by_the_one_that_is_not() -> None:
    script = Script()
    script.hear(wire.heartbeat(), link=1)
    script.wait(2.1)
    script.hear(wire.heartbeat(), link=0)
    assert script.link == 0
    script.hear(wire.heartbeat(), link=1)
    assert script.link == 0


def test_only_the_autopilot_itself_keeps_a_link_alive() -> None:
    script = Script()
    script.hear(wire.heartbeat(), link=1)
    script.wait(1.5)
    script.hear(wire.text(6, "hello"), link=1, sender=Sender(1, 191))
    script.wait(1.0)
    script.hear(wire.text(6, "hello"), link=0, sender=Sender(1, 191))
    assert script.link == 1
    script.hear(wire.heartbeat(), link=0)
    assert script.link == 0


# -------------------------------------------------------------------------- what is void


def overtaken(script: Script, first: Message, second: Message) -> list[Work]:
    """`second` was sent after `first` and comes before it; what `first` then still leads to."""
    early, late = script.sender.frame(first), script.sender.frame(second)
    script.bytes(late)
    return script.bytes(early)


def test_a_heartbeat_that_a_newer_one_overtook_says_nothing_of_now() -> None:
    script = Script()
    script.hear(wire.heartbeat())
    armed = wire.heartbeat(armed=True, mode=wire.OFFBOARD)
    assert gate_inputs(overtaken(script, wire.heartbeat(armed=False), armed)) == []
    assert script.vehicle.telemetry is not None
    assert script.vehicle.telemetry.armed is True


def test_a_landed_state_that_a_newer_one_overtook_says_nothing_of_now() -> None:
    script = Script()
    script.hear(wire.heartbeat())
    work = overtaken(script, wire.landed(wire.ON_GROUND), wire.landed(wire.IN_AIR))
    assert gate_inputs(work) == []


def test_a_state_is_overtaken_by_its_own_kind_only() -> None:
    script = Script()
    script.hear(wire.heartbeat())
    work = overtaken(script, wire.landed(wire.IN_AIR), wire.heartbeat())
    assert [type(given) for given in gate_inputs(work)] == [inputs.LandedSeen]


def test_an_answer_is_heard_though_something_newer_came_before_it() -> None:
    script = Script()
    script.hear(wire.heartbeat())
    assert log(overtaken(script, wire.text(6, "late"), wire.heartbeat())) == [(Level.INFO, "late")]


def test_the_same_state_over_two_links_is_heard_once() -> None:
    script = Script()
    script.hear(wire.heartbeat())
    raw = script.sender.frame(wire.landed(wire.IN_AIR))
    assert len(gate_inputs(script.bytes(raw, link=0))) == 1
    assert gate_inputs(script.bytes(raw, link=1)) == []


def test_the_round_of_the_sequence_numbers_overtakes_nothing() -> None:
    script = Script()
    script.sender.seq = 253
    script.hear(wire.heartbeat())
    for _ in range(6):
        assert len(gate_inputs(script.hear(wire.landed(wire.IN_AIR)))) == 1


# ------------------------------------------------------------------------ away and back


def test_a_vehicle_that_was_away_is_met_anew_and_its_place_is_not_known() -> None:
    script = Script()
    script.hear(wire.heartbeat(), wire.origin(), wire.home())
    telemetry = script.vehicle.telemetry
    assert telemetry is not None
    assert None not in [telemetry.origin, telemetry.home_ned]
    script.wait(3.6)
    script.sender.seq = 0  # it restarted
    work = script.hear(wire.heartbeat())
    assert (Level.INFO, "vehicle 1/1 px4 quadrotor is back") in log(work)
    assert PlaceFence() in work
    assert [telemetry.origin, telemetry.home_ned] == [None, None]
    assert inputs.HeartbeatSeen in [type(given) for given in gate_inputs(work)]
    assert len(gate_inputs(script.hear(wire.landed(wire.ON_GROUND)))) == 1


def test_one_heartbeat_that_was_lost_is_no_absence() -> None:
    script = Script()
    script.hear(wire.heartbeat(), wire.origin())
    script.wait(3.4)
    work = script.hear(wire.heartbeat())
    assert not any("is back" in text for _, text in log(work))
    assert script.vehicle.telemetry is not None
    assert script.vehicle.telemetry.origin is not None


def test_a_sped_up_vehicle_is_away_after_as_much_real_time() -> None:
    script = Script(StationConfig(speedup=10.0))
    script.hear(wire.heartbeat())
    script.wait(30.0)
    assert not any("is back" in text for _, text in log(script.hear(wire.heartbeat())))
    script.wait(36.0)
    assert any("is back" in text for _, text in log(script.hear(wire.heartbeat())))


def test_how_long_a_vehicle_may_be_silent_is_the_policy_s_affair() -> None:
    """station.md, bug 14: 3.5 s whatever the policy's heartbeat_age_s said."""
    script = Script(policy=structs.replace(DEFAULT, heartbeat_age_s=8.0))
    script.hear(wire.heartbeat())
    script.wait(7.9)
    assert not any("is back" in text for _, text in log(script.hear(wire.heartbeat())))
    script.wait(8.1)
    assert any("is back" in text for _, text in log(script.hear(wire.heartbeat())))


def test_after_a_quick_restart_its_reports_count_at_once() -> None:
    """Its numbers begin anew: 100 heartbeats of an ArduPilot would have been taken for late."""
    script = Script()
    script.sender.seq = 99
    script.hear(wire.heartbeat(armed=True))
    script.wait(1.5)
    script.sender.seq = 0
    script.hear(wire.heartbeat(armed=False))
    assert script.vehicle.telemetry is not None
    assert script.vehicle.telemetry.armed is False
    assert len(gate_inputs(script.hear(wire.landed(wire.ON_GROUND)))) == 1


def test_losses_are_counted_over_gaps_and_not_over_an_absence() -> None:
    script = Script()
    script.hear(wire.heartbeat())
    script.sender.seq += 3
    script.hear(wire.heartbeat())
    assert script.vehicle.presence.losses.lost == 3
    script.wait(10.0)
    script.sender.seq = 100
    script.hear(wire.heartbeat(), wire.heartbeat())
    assert script.vehicle.presence.losses.lost == 3


# --------------------------------------------------------------------------- its settings


def settings(script: Script, **params: float) -> list[Work]:
    """The vehicle answers what it is asked about its failsafes; px4's integers are bytes."""
    work = script.hear(wire.heartbeat())
    answered: list[Work] = []
    for name in ("NAV_DLL_ACT", "NAV_RCL_ACT", "GF_ACTION", "COM_LOW_BAT_ACT"):
        answered += script.hear(wire.int_param(name, int(params.get(name, 2))))
    answered += script.hear(wire.float_param("NAV_ACC_RAD", 2.0))
    answered += script.hear(wire.float_param("COM_OF_LOSS_T", 1.0))
    answered += script.hear(wire.int_param("COM_OBL_RC_ACT", 0))
    answered += script.hear(wire.int_param("COM_DL_LOSS_T", 10))
    answered += script.hear(wire.float_param("GF_MAX_HOR_DIST", 150.0))
    answered += script.hear(wire.float_param("GF_MAX_VER_DIST", 50.0))
    if "RTL_RETURN_ALT" in params:
        answered += script.hear(wire.float_param("RTL_RETURN_ALT", params["RTL_RETURN_ALT"]))
    else:
        answered += script.hear(wire.no_param("RTL_RETURN_ALT"))
    answered += script.hear(wire.int_param("RTL_TYPE", 0))
    answered += script.hear(wire.float_param("NAV_MC_ALT_RAD", params.get("NAV_MC_ALT_RAD", 0.8)))
    answered += script.hear(wire.float_param("MIS_TAKEOFF_ALT", 2.5))
    answered += script.hear(wire.float_param("MPC_XY_CRUISE", 5.0))
    return [*work, *answered]


def weak(work: list[Work]) -> list[bool]:
    """What the gate hears of the vehicle's own failsafes."""
    changed = [g for g in gate_inputs(work) if isinstance(g, inputs.ConditionChanged)]
    return [g.active for g in changed if g.condition is Condition.VEHICLE_FAILSAFE_WEAK]


def test_the_gate_is_told_the_return_height_and_that_nothing_is_weak() -> None:
    script = Script()
    work = settings(script, RTL_RETURN_ALT=45.0)
    assert inputs.ReturnHeightSeen(45.0) in gate_inputs(work)
    assert weak(work) == [False]
    assert (
        Level.INFO,
        "the vehicle's own failsafes: ground-station loss: return after 10 s; stick loss: return; "
        "offboard loss: position mode after 1 s; low battery: land when critical; "
        "geofence breach: hold; geofence: radius 150 m, height 50 m; return: at 45 m",
    ) in log(work)
    assert script.vehicle.telemetry is not None
    assert "low battery: land when critical" in script.vehicle.telemetry.failsafes
    assert script.vehicle.telemetry is not None
    assert script.vehicle.telemetry.return_up_m == 45.0


def test_a_return_height_that_the_vehicle_does_not_have_is_not_known() -> None:
    script = Script()
    work = settings(script)
    assert not any(isinstance(given, inputs.ReturnHeightSeen) for given in gate_inputs(work))
    assert script.vehicle.telemetry is not None
    assert script.vehicle.telemetry.return_up_m is None


def test_the_gate_is_told_how_near_its_height_the_vehicle_ends_a_climb() -> None:
    """PX4's own 0.8 m at first, then what the vehicle says."""
    work = settings(Script(), NAV_MC_ALT_RAD=2.5)
    within_m = [g.within_m for g in gate_inputs(work) if isinstance(g, inputs.ClimbEndSeen)]
    assert within_m == [0.8, 2.5]


def test_the_default_height_of_a_take_off_is_read_and_followed() -> None:
    """MAVSDK writes it before each take-off."""
    script = Script()
    settings(script)
    assert script.vehicle.parameters["MIS_TAKEOFF_ALT"] == 2.5
    script.hear(wire.float_param("MIS_TAKEOFF_ALT", 5.0))
    assert script.vehicle.parameters["MIS_TAKEOFF_ALT"] == 5.0


def test_a_failsafe_that_is_off_is_a_condition_and_not_called_on() -> None:
    work = settings(Script(), GF_ACTION=0, RTL_RETURN_ALT=30.0)
    assert weak(work) == [True]
    assert not any("all on" in text for _, text in log(work))


def test_what_an_autopilot_of_an_unknown_kind_does_by_itself_is_not_called_on() -> None:
    work = Script().hear(wire.heartbeat(99))
    assert weak(work) == [True]
    assert not any("all on" in text for _, text in log(work))


# ------------------------------------------------------------------------------- its words


@pytest.mark.parametrize(
    ("severity", "level"),
    [
        (0, Level.FATAL),  # MAV_SEVERITY_EMERGENCY
        (1, Level.ERROR),
        (2, Level.ERROR),
        (3, Level.ERROR),
        (4, Level.WARNING),
        (5, Level.INFO),
        (6, Level.INFO),
        (7, Level.DEBUG),
    ],
)
def test_what_the_vehicle_says_is_logged_as_severe_as_it_says(severity: int, level: Level) -> None:
    script = Script()
    script.hear(wire.heartbeat())
    assert log(script.hear(wire.text(severity, "words"))) == [(level, "words")]


def test_a_severity_that_no_standard_knows_is_words_all_the_same() -> None:
    script = Script()
    script.hear(wire.heartbeat())
    ((_, words),) = log(script.hear(wire.text(255, "words")))
    assert words == "words"


def test_a_picture_of_the_camera_component_is_heard() -> None:
    script = Script()
    script.hear(wire.heartbeat())
    work = script.hear(wire.picture(5), sender=Sender(1, 100))
    assert gate_inputs(work) == [inputs.PhotoSeen(5, True)]


@pytest.mark.parametrize("mavlink1", [False, True])
def test_it_may_speak_either_mavlink(mavlink1: bool) -> None:
    script = Script()
    script.hear(wire.heartbeat(), mavlink1=mavlink1)
    work = script.hear(wire.position(1, (1.0, 2.0, -3.0)), mavlink1=mavlink1)
    assert gate_inputs(work) == [inputs.PositionSeen((1.0, 2.0, -3.0), (0.0, 0.0, 0.0), 1)]


# -------------------------------------------------------------------- without the gate


def test_the_last_resort_holds_nothing_that_is_not_ours() -> None:
    script = Script()
    assert script.vehicle.hold_without_gate(script.now_ns) == []
    script.hear(wire.heartbeat(armed=True, mode=wire.POSCTL), wire.landed(wire.IN_AIR))
    script.hear(wire.position(script.now_ns // MS_NS, (0.0, 0.0, -5.0)))
    assert script.vehicle.hold_without_gate(script.now_ns) == []
