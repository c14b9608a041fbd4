"""QGroundControl's "start mission" on a PX4: the mode of a mission, then the arming.

That a disarmed PX4 accepts the mode and flies as soon as it is armed is recorded (of 1.14.3, rows
C6_plan_without_takeoff and F7_mission_through_fence).  The order, and how long QGroundControl waits
for what, is from memory of its `PX4FirmwarePlugin::startMission`: the mode three times, 1.3 s each,
then one arming, which it wants to see within 3 s.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.states import State
from gcs.record.writer import Recorder
from gcs.session import inputs
from tests.audits import audited, read
from tests.loopback.bridged import VEHICLE, Client, joined
from tests.loopback.flight import Personality
from tests.loopback.lossy_link import Weather
from tests.loopback.observed import START_NS
from tests.loopback.plan_clients import PlanFlight, QGroundControl, mission
from tests.loopback.test_takeoff_then_arm import commands_sent

ACCEPTED, TEMPORARILY_REJECTED, DENIED = 0, 1, 2
ARM, TAKE_OFF, PAUSE, SET_MODE, MISSION_START, REQUEST_CONTROL = 400, 22, 193, 176, 300, 32100
CUSTOM_MODE = 1
AUTO, LOITER, MISSION = 4, 3, 4
GUIDED, ARDUPILOTS_AUTO = 4, 3
MISSION_MODE, HOLD_MODE = "AUTO.MISSION", "AUTO.LOITER"
WAITS_FOR_MODE_S, WAITS_FOR_ARMED_S = 1.3, 3.0
PLACES = ((20.0, 0.0, 10.0), (20.0, 15.0, 10.0))
"""North, east, up of home, metres."""


def with_mission(personality: Personality = "px4") -> tuple[PlanFlight, Client]:
    """On the ground, a mission brought on board and verified."""
    flight, client = joined(PlanFlight(personality))
    upload = QGroundControl(flight, client, mission(personality, *PLACES))
    assert upload.ended() == "complete", client.texts()
    flight.beating(1.5)
    return flight, client


def set_mode(client: Client, sub_mode: int = MISSION) -> None:
    client.command(SET_MODE, CUSTOM_MODE, AUTO, sub_mode)


def shows(client: Client, custom_mode: int, armed: bool | None = None) -> bool:
    """By the last heartbeat of the vehicle that the client heard."""
    beats = client.messages("HEARTBEAT")
    if not beats or beats[-1].custom_mode != custom_mode:
        return False
    return armed is None or bool(beats[-1].base_mode & 128) is armed


def in_mission_mode(flight: PlanFlight, client: Client) -> None:
    """As `_setFlightModeAndValidate`: three tries."""
    for _ in range(3):
        set_mode(client)
        limit_ns = flight.now_ns + round(WAITS_FOR_MODE_S * 1e9)
        while flight.now_ns < limit_ns:
            flight.run(0.1)
            if shows(client, AUTO << 16 | MISSION << 24):
                return
    raise AssertionError(f"the mode is not shown: {client.texts()}")


def is_armed(client: Client) -> bool:
    beats = client.messages("HEARTBEAT")
    return bool(beats) and bool(beats[-1].base_mode & 128)


def flies(flight: PlanFlight) -> None:
    flight.until(lambda: flight.is_in(State.FLYING_MISSION), 5.0)
    flight.beating(15.0)
    assert flight.truth_enu()[2] > 5.0
    assert flight.is_in(State.FLYING_MISSION)


def stays_down(flight: PlanFlight, seconds: float = 8.0) -> None:
    flight.beating(seconds)
    assert flight.truth_enu()[2] < 0.2
    assert not flight.is_in(State.FLYING_MISSION)


def test_qgroundcontrols_start_of_a_mission_flies_it() -> None:
    flight, client = with_mission()
    in_mission_mode(flight, client)
    assert [ack.result for ack in client.acks(SET_MODE)] == [ACCEPTED]
    assert "mission: begins when you arm, within 10 s" in client.texts()
    client.command(ARM, 1)
    flight.until(lambda: is_armed(client), WAITS_FOR_ARMED_S)
    flight.until(lambda: bool(client.acks(ARM)), 1.0)
    flies(flight)
    assert [ack.result for ack in client.acks(ARM)] == [ACCEPTED]
    asked = [one.word for one in flight.decisions("accepted")]
    assert asked[-3:] == ["mission_check", "arm", "mission_start"]
    assert not any(record.word == "hold" for record in flight.decisions())


def test_the_old_set_mode_is_taken_as_well() -> None:
    """A SET_MODE has no acknowledgement; the heartbeat tells."""
    flight, client = with_mission()
    flags = dialect.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
    client.send(dialect.MAVLink_set_mode_message(VEHICLE[0], flags, AUTO << 16 | MISSION << 24))
    flight.beating(2.0)
    assert flight.vehicle.mode_name == MISSION_MODE
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    flies(flight)


def test_a_mode_that_would_arm_too_is_not_sent_on() -> None:
    """MAV_MODE_FLAG_SAFETY_ARMED in a SET_MODE: MAVLink's old way to arm, which no PX4 since 1.6
    takes (from memory); nobody has judged such an arming."""
    flight, client = with_mission()
    armed = dialect.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | dialect.MAV_MODE_FLAG_SAFETY_ARMED
    client.send(dialect.MAVLink_set_mode_message(VEHICLE[0], armed, AUTO << 16 | MISSION << 24))
    client.command(SET_MODE, armed, AUTO, MISSION)
    flight.beating(2.0)
    assert flight.vehicle.mode_name == HOLD_MODE
    assert not flight.to_vehicle("SET_MODE")
    assert client.acks(SET_MODE)[-1].result != ACCEPTED


def test_an_arming_in_the_same_moment_waits_until_the_mode_is_shown() -> None:
    """A script that does not wait: the vehicle shows its mode once a second."""
    flight, client = with_mission()
    set_mode(client)
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    flies(flight)


def test_qgroundcontrols_start_on_an_ardupilot_flies_it() -> None:
    """GUIDED, the arming, MISSION_START (from memory of `APMFirmwarePlugin::startMission`): an
    ArduCopter arms in GUIDED, and not in AUTO (recorded of 4.7, C3 and C5)."""
    flight, client = with_mission("ardupilot")
    client.command(SET_MODE, CUSTOM_MODE, GUIDED)
    flight.until(lambda: shows(client, GUIDED), WAITS_FOR_MODE_S)
    client.command(ARM, 1)
    flight.until(lambda: is_armed(client), WAITS_FOR_ARMED_S)
    flight.until(lambda: bool(client.acks(ARM)), 2.0)
    assert client.ask(MISSION_START) == ACCEPTED
    flies(flight)


def test_auto_before_the_arming_of_an_ardupilot_is_refused_and_the_arming_is_not() -> None:
    """MAVProxy's `mode auto`, `arm throttle`: ArduCopter itself says "Auto mode not armable"
    (recorded of 4.7, C3); the gate arms in GUIDED, and `mode auto` then flies."""
    flight, client = with_mission("ardupilot")
    flags = dialect.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
    to_auto = dialect.MAVLink_set_mode_message(VEHICLE[0], flags, ARDUPILOTS_AUTO)
    client.send(to_auto)
    flight.beating(2.0)
    assert not shows(client, ARDUPILOTS_AUTO)
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    stays_down(flight, 3.0)
    client.send(to_auto)
    flies(flight)


def another_mission(flight: PlanFlight) -> None:
    """Put on board past the station: of as many items, its waypoints 5 m lower."""
    vehicle = flight.vehicle
    vehicle.load_plan(tuple(replace(item, z=item.z - 5.0) for item in vehicle.plan))


def test_what_is_wrong_with_the_mission_the_arming_is_refused_with() -> None:
    flight, client = with_mission()
    in_mission_mode(flight, client)
    another_mission(flight)
    assert client.ask(ARM, 1) == DENIED
    (ack,) = client.acks(ARM)
    assert ack.result_param2 == 23  # BAD_MISSION
    assert "another mission is on board than was verified" in client.texts()
    assert not flight.vehicle.armed
    flight.beating(12.0)
    assert flight.vehicle.mode_name == HOLD_MODE


def test_a_mission_that_is_not_known_is_read_by_the_first_try() -> None:
    """Put on board before this station was there: QGroundControl tries the mode three times."""
    items = with_mission()[0].vehicle.plan
    flight, client = joined(PlanFlight("px4"))
    flight.vehicle.load_plan(items)
    in_mission_mode(flight, client)
    assert [ack.result for ack in client.acks(SET_MODE)] == [TEMPORARILY_REJECTED, ACCEPTED]
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    flies(flight)


def test_without_a_mission_the_mode_is_refused() -> None:
    flight, client = joined(PlanFlight("px4"))
    set_mode(client)
    flight.until(lambda: bool(client.acks(SET_MODE)), 5.0)
    assert client.acks(SET_MODE)[0].result != ACCEPTED
    assert flight.vehicle.mode_name == HOLD_MODE


def test_an_arming_that_comes_too_late_starts_nothing_and_the_mode_is_taken_back() -> None:
    """Whoever arms the vehicle past the station then, the pilot for one, flies no mission."""
    flight, client = with_mission()
    in_mission_mode(flight, client)
    flight.beating(11.0)
    assert client.texts().count("mission: forgotten: not armed in time") == 1
    assert flight.vehicle.mode_name == HOLD_MODE
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    stays_down(flight)


def another_takes_control(flight: PlanFlight, client: Client, other: Client) -> None:
    client.command(REQUEST_CONTROL, 1, 1)  # lets others take it over
    flight.beating(1.0)
    other.command(REQUEST_CONTROL, 1, 1)
    flight.beating(1.0)
    assert other.ask(ARM, 1, within_s=10) == ACCEPTED


def another_stops(flight: PlanFlight, client: Client, other: Client) -> None:
    other.command(PAUSE, 0)
    flight.beating(1.5)
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED


def sets_another_mode(flight: PlanFlight, client: Client, other: Client) -> None:
    set_mode(client, LOITER)
    flight.beating(1.5)
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED


def chooses_a_take_off(flight: PlanFlight, client: Client, other: Client) -> None:
    client.command(TAKE_OFF, -1, 0, 0, 0, 0, 0, 0)
    flight.beating(1.5)
    client.command(PAUSE, 0)
    flight.beating(1.5)
    assert "takeoff: forgotten" in client.texts()
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED


@pytest.mark.parametrize(
    "ends", [another_takes_control, another_stops, sets_another_mode, chooses_a_take_off]
)
def test_something_else_ends_the_choice(
    ends: Callable[[PlanFlight, Client, Client], None],
) -> None:
    flight, client = with_mission()
    other = flight.join(246)
    in_mission_mode(flight, client)
    ends(flight, client, other)
    stays_down(flight)
    assert client.texts().count(": forgotten: ") == 1


def test_who_is_not_in_control_sets_no_mode() -> None:
    flight, _ = with_mission()
    other = flight.join(246)
    set_mode(other)
    flight.until(lambda: bool(other.acks(SET_MODE)), 5.0)
    assert other.acks(SET_MODE)[0].result != ACCEPTED
    flight.beating(2.0)
    assert flight.vehicle.mode_name == HOLD_MODE


def test_a_client_that_goes_leaves_no_mode_behind() -> None:
    flight, client = with_mission()
    in_mission_mode(flight, client)
    flight.feed(inputs.ClientGone(client.link, "closed"))
    flight.run(2.0)
    assert flight.vehicle.mode_name == HOLD_MODE


def test_a_station_that_ends_leaves_no_mode_behind() -> None:
    """It waits for the vehicle's answer, and sends the hold again where that was lost."""
    flight, client = with_mission()
    in_mission_mode(flight, client)
    flight.up.weather, clear = Weather(loss=1.0), flight.up.weather
    flight.feed(inputs.SignalCame("SIGTERM"))
    flight.run(0.3)
    flight.up.weather = clear
    flight.run(3.0)
    assert flight.finish is not None
    assert flight.vehicle.mode_name == HOLD_MODE


@pytest.mark.parametrize("landed", [0, 2], ids=["undefined", "in the air"])
def test_a_landed_state_that_is_wrong_for_a_moment_keeps_no_mode(landed: int) -> None:
    """Disarmed it stays where it is, whatever its land detector says."""
    flight, client = with_mission()
    in_mission_mode(flight, client)
    says = dialect.MAVLink(None, srcSystem=VEHICLE[0], srcComponent=VEHICLE[1])
    flight.feed(
        inputs.Datagram(0, dialect.MAVLink_extended_sys_state_message(0, landed).pack(says))
    )
    flight.beating(12.0)
    assert flight.vehicle.mode_name == HOLD_MODE


def bursts(flight: PlanFlight, client: Client) -> None:
    """Not waiting for anything: the arming comes before any heartbeat can show the mode."""
    set_mode(client)
    client.command(TAKE_OFF, -1, 0, 0, 0, 0, 0, 0)
    client.command(PAUSE, 1)
    client.command(ARM, 1)


def arms_without_answer(flight: PlanFlight, client: Client) -> None:
    """An arming is lost on the way; one that is only late would start the mission."""
    deaf, flight.up.weather = flight.up.weather, Weather(loss=1.0)
    client.command(ARM, 1)
    flight.beating(6.0)
    flight.up.weather = deaf
    set_mode(client)
    flight.beating(2.0)
    assert flight.vehicle.mode_name == HOLD_MODE


def is_armed_unseen(flight: PlanFlight, client: Client) -> None:
    """The vehicle accepts an arming, and the heartbeats that would show it do not come.

    It disarms by itself after 10 s on the ground (COM_DISARM_PRFLT, recorded)."""
    flight.heartbeats_lost = True
    client.command(ARM, 1)
    flight.beating(7.0)
    assert flight.vehicle.armed
    set_mode(client)
    flight.beating(2.0)
    assert flight.vehicle.mode_name == HOLD_MODE
    flight.heartbeats_lost = False


@pytest.mark.parametrize("does", [bursts, arms_without_answer, is_armed_unseen])
def test_no_mission_begins_without_its_verdict(
    does: Callable[[PlanFlight, Client], None],
) -> None:
    flight, client = with_mission()
    does(flight, client)
    stays_down(flight)
    assert not [one for one in flight.decisions("accepted") if one.word == "mission_start"]


def test_an_arming_that_the_gate_has_refused_keeps_no_mission_from_being_started() -> None:
    """Nothing was sent, so nothing comes late: whoever tries again need not wait."""
    flight, client = with_mission()
    flight.positions_lost = True
    flight.beating(3.0)
    assert client.ask(ARM, 1) == TEMPORARILY_REJECTED
    flight.positions_lost = False
    flight.beating(1.0)
    in_mission_mode(flight, client)
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    flies(flight)


def heartbeats_lost(flight: PlanFlight, client: Client) -> None:
    """The mode is set, and the heartbeats that would show it do not come, while all else does."""
    client.command(REQUEST_CONTROL, 1, 1)  # lets others take it over
    flight.beating(1.0)
    flight.heartbeats_lost = True
    set_mode(client)
    flight.beating(3.2)
    assert flight.vehicle.mode_name == MISSION_MODE
    assert flight.session.telemetry is not None
    assert flight.session.telemetry.mode_name == HOLD_MODE


def test_an_arming_waits_for_a_heartbeat_however_many_are_lost() -> None:
    """Nobody knows the vehicle's mode then: an arming without a hold before it starts the mission,
    which the client that arms has not asked for."""
    flight, client = with_mission()
    other = flight.join(246)
    heartbeats_lost(flight, client)
    other.command(REQUEST_CONTROL, 1, 1)
    flight.beating(0.1)
    assert other.ask(ARM, 1) == TEMPORARILY_REJECTED
    assert "the vehicle does not show it yet" in other.texts()
    flight.heartbeats_lost = False
    flight.beating(1.5)
    assert other.ask(ARM, 1, within_s=10) == ACCEPTED
    stays_down(flight)


def test_armed_first_the_mode_starts_the_mission_as_ever() -> None:
    """What waits for nothing: the mode is asked for while the arming is under way."""
    flight, client = with_mission()
    client.command(ARM, 1)
    set_mode(client)
    flies(flight)
    assert [one.word for one in flight.decisions("accepted")][-2:] == ["arm", "mission_start"]
    modes = [
        frame for frame in flight.to_vehicle("COMMAND_LONG") if frame.sysid == client.mav.srcSystem
    ]
    assert not modes, "the mode itself is not forwarded"


@pytest.mark.parametrize("arms", ["operator", "pilot"])
def test_whoever_else_arms(arms: str) -> None:
    """An arming of this station sets hold first.  Who arms past it, as a pilot does, flies: the
    gate sees that nobody asked it."""
    flight, client = with_mission()
    in_mission_mode(flight, client)
    if arms == "pilot":
        assert flight.vehicle.arm(False) == ACCEPTED
        flight.until(lambda: flight.is_in(State.EXTERNAL), 10.0)
        return
    client.command(REQUEST_CONTROL, 0)
    flight.run(0.5)
    flight.do("station_take")
    flight.do("arm")
    stays_down(flight)


def test_the_mode_is_taken_back_from_a_vehicle_that_a_pilot_had_armed_unseen() -> None:
    """The mode comes right after the arming, which no heartbeat has told: the vehicle takes off."""
    flight, client = with_mission()
    beats = len(client.messages("HEARTBEAT"))
    flight.until(lambda: len(client.messages("HEARTBEAT")) > beats, 2.0)
    assert flight.vehicle.arm(False) == ACCEPTED
    set_mode(client)
    flight.until(lambda: shows(client, AUTO << 16 | LOITER << 24, armed=True), 4.0)
    flight.beating(8.0)
    assert flight.truth_enu()[2] < 3.0
    assert shows(client, AUTO << 16 | LOITER << 24, armed=True)


def test_where_no_heartbeat_was_heard_lately_the_mode_is_refused() -> None:
    flight, client = with_mission()
    flight.heartbeats_lost = True
    flight.beating(2.5)
    set_mode(client)
    flight.beating(2.0)
    assert flight.to_vehicle("COMMAND_LONG")[-1].sysid != client.mav.srcSystem
    assert client.acks(SET_MODE)[-1].result != ACCEPTED


def test_the_audit_of_a_chosen_start_finds_the_same(tmp_path: Path) -> None:
    recorder = Recorder.open(tmp_path, "mission", "20260101-000000", START_NS, sealed=True)
    flight = PlanFlight()
    flight.recorder = recorder
    flight.feed(inputs.LinkEvent(0, "open"))
    client = flight.join()
    flight.connected()
    assert QGroundControl(flight, client, mission("px4", *PLACES)).ended() == "complete"
    in_mission_mode(flight, client)
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    flight.beating(4.0)
    assert commands_sent(flight, MISSION_START) == 1
    flight.feed(inputs.SignalCame("SIGTERM"))
    flight.run(1.0)
    assert recorder.close(flight.now_ns)
    result = audited(*read(recorder.path))
    assert result.good, result.first
    assert result.inputs
