"""DO_ORBIT of a MAVLink client: the station flies the circle itself, and the gate verifies it.

Where the vehicle is, is its own truth; the circles are asked for in pymavlink's bytes.
"""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from msgspec import structs
from pymavlink.dialects.v20 import all as dialect

from gcs import ipc
from gcs.audit.audit import audit
from gcs.audit.messages import Tape
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.gate.policy.zonespec import CircleSpec
from gcs.gate.states import State
from gcs.record.writer import Recorder
from gcs.session import inputs
from tests.loopback.boxed_stream import taken_off
from tests.loopback.bridged import VEHICLE, BridgedFlight, Client, joined
from tests.loopback.flight import Flight, Personality
from tests.loopback.observed import START_NS
from tests.loopback.plan_clients import Mavsdk, PlanFlight, mission
from tests.loopback.test_attitude_streams import blow

ACCEPTED, TEMPORARILY_REJECTED, DENIED, UNSUPPORTED = 0, 1, 2, 3
ARM, ORBIT, PAUSE, RTL, LAND, RELEASE = 400, 34, 193, 20, 21, 32100
MISSION_START = 300
NAN = math.nan
UNSET = 0x7FFFFFFF
GLOBAL = 0
UP_M = 10.0
NORTH_40 = (0.0, 40.0)
"""East and north of home."""

FIELD = CircleSpec(90.0, (0.0, 0.0), name="field", inclusion=True)
TOWER = CircleSpec(3.0, (0.0, 25.0), name="tower", inclusion=False)
"""25 m north of home."""


def flying(personality: Personality, policy: Policy = DEFAULT) -> tuple[BridgedFlight, Client]:
    """Taken off by the client, hovering above home."""
    flight, client = joined(BridgedFlight(personality, policy=policy))
    taken_off(flight, client, UP_M)
    return flight, client


def origin(flight: BridgedFlight) -> Origin:
    assert flight.session.telemetry is not None
    assert flight.session.telemetry.origin is not None
    return flight.session.telemetry.origin


def lat_lon(flight: BridgedFlight, centre: tuple[float, float]) -> tuple[float, float]:
    east_m, north_m = centre
    return Projection(origin(flight), flight.personality).lat_lon(north_m, east_m)


def orbit(
    client: Client,
    radius_m: float = NAN,
    speed_m_s: float = NAN,
    nose: float = NAN,
    turn_rad: float = NAN,
    centre: tuple[float, float] | None = None,
    up_m: float = NAN,
    frame: int = GLOBAL,
) -> None:
    """COMMAND_INT; the height is sent as above sea level."""
    x, y = UNSET, UNSET
    height_m = up_m + origin(client.flight).alt_amsl_m
    if centre is not None:
        lat_deg, lon_deg = lat_lon(client.flight, centre)
        x, y = round(lat_deg * 1e7), round(lon_deg * 1e7)
    client.send(
        dialect.MAVLink_command_int_message(
            *VEHICLE, frame, ORBIT, 0, 0, radius_m, speed_m_s, nose, turn_rad, x, y, height_m
        )
    )


def answers(client: Client) -> list[int]:
    """What the orbits of this client were answered."""
    return [ack.result for ack in client.acks(ORBIT) if ack.result != 5]


def asked(client: Client, *circle: float, **more: object) -> int:
    """Ask for one, and what it is answered."""
    before = len(answers(client))
    orbit(client, *circle, **more)  # type: ignore[arg-type]
    client.flight.until(lambda: len(answers(client)) > before, 5.0)
    return answers(client)[-1]


class Track:
    """The truth about a flight, 20 times a second."""

    def __init__(self, flight: BridgedFlight, centre: tuple[float, float]) -> None:
        self.flight = flight
        self.centre = centre
        self.places: list[tuple[float, float, float]] = []

    def fly(self, seconds: float) -> None:
        for count in range(round(seconds * 20)):
            if count % 20 == 0:
                for client in self.flight.clients.values():
                    client.beat()
            self.flight.run(0.05)
            self.places.append(self.flight.truth_enu())

    @property
    def away_m(self) -> list[float]:
        """From the centre."""
        return [math.dist(place[:2], self.centre) for place in self.places]

    @property
    def turned_rad(self) -> float:
        """About the centre, clockwise seen from above."""
        bearings = [
            math.atan2(east - self.centre[0], north - self.centre[1])
            for east, north, _ in self.places
        ]
        return sum(math.remainder(b - a, math.tau) for a, b in pairwise(bearings))


def circling(flight: BridgedFlight, centre: tuple[float, float], radius_m: float) -> Track:
    """Let it come to its circle, within 40 s, and fly 10 s more until it keeps to it."""
    track = Track(flight, centre)
    for _ in range(40):
        track.fly(1.0)
        if abs(track.away_m[-1] - radius_m) < 1.2:
            track.fly(10.0)
            return Track(flight, centre)
    raise AssertionError(track.away_m[::20])


# --------------------------------------------------------------------------------- it is flown


@pytest.mark.parametrize(
    ("radius_m", "speed_m_s"), [(20.0, 3.0), (-12.0, 2.0), (30.0, 7.0), (-2.0, 1.0)]
)
def test_a_circle_is_flown_at_its_radius_speed_and_height(
    personality: Personality, radius_m: float, speed_m_s: float
) -> None:
    """The truth stays within 0.6 m of the circle and 0.4 m of its height (0.48 m and 0.15 m were
    measured, of which up to 0.3 m and 0.1 m are the position that the vehicle believes)."""
    flight, client = flying(personality)
    assert asked(client, radius_m, speed_m_s, centre=NORTH_40, up_m=UP_M + 5.0) == ACCEPTED
    track = circling(flight, NORTH_40, abs(radius_m))
    track.fly(20.0)
    assert flight.is_in(State.STREAMING)
    assert max(abs(away - abs(radius_m)) for away in track.away_m) < 0.6
    assert max(abs(up - UP_M - 5.0) for *_, up in track.places) < 0.4
    flown_m = track.turned_rad * abs(radius_m)
    assert flown_m == pytest.approx(math.copysign(speed_m_s * 20.0, radius_m), rel=0.06)
    assert "refused" not in client.texts()


def test_a_fast_px4_keeps_to_its_circle_too() -> None:
    """Its velocity lags: 0.87 m were measured at 10 m/s."""
    flight, client = flying("px4")
    assert asked(client, 50.0, 10.0, centre=(0.0, 0.0)) == ACCEPTED
    track = circling(flight, (0.0, 0.0), 50.0)
    track.fly(30.0)
    assert max(abs(away - 50.0) for away in track.away_m) < 1.0


def test_wind_does_not_push_it_off(personality: Personality) -> None:
    flight, client = flying(personality)
    blow(flight, 5.0, -3.0)
    assert asked(client, 15.0, 3.0, centre=NORTH_40) == ACCEPTED
    track = circling(flight, NORTH_40, 15.0)
    track.fly(35.0)
    assert max(abs(away - 15.0) for away in track.away_m) < 1.0
    assert "refused" not in client.texts()


def test_as_command_long_about_a_place_above_sea_level(personality: Personality) -> None:
    """Degrees as float32 are up to 0.4 m off."""
    flight, client = flying(personality)
    lat_deg, lon_deg = lat_lon(flight, NORTH_40)
    up_m = origin(flight).alt_amsl_m + 12.0
    assert client.ask(ORBIT, 15.0, 3.0, 0.0, 0.0, lat_deg, lon_deg, up_m) == ACCEPTED
    track = circling(flight, NORTH_40, 15.0)
    track.fly(20.0)
    assert max(abs(away - 15.0) for away in track.away_m) < 1.6
    assert track.places[-1][2] == pytest.approx(12.0, abs=0.5)


def test_nothing_given_is_ten_metres_about_where_it_is(personality: Personality) -> None:
    flight, client = flying(personality)
    east_m, north_m, up_m = flight.truth_enu()
    assert asked(client) == ACCEPTED
    track = circling(flight, (east_m, north_m), 10.0)
    track.fly(20.0)
    assert max(abs(away - 10.0) for away in track.away_m) < 0.8
    assert track.turned_rad * 10.0 == pytest.approx(20.0, rel=0.1)
    assert track.places[-1][2] == pytest.approx(up_m, abs=0.5)


def test_what_is_not_given_is_as_it_is_flown(personality: Personality) -> None:
    flight, client = flying(personality)
    assert asked(client, -20.0, 4.0, centre=NORTH_40) == ACCEPTED
    circling(flight, NORTH_40, 20.0)
    assert asked(client, -25.0) == ACCEPTED
    track = circling(flight, NORTH_40, 25.0)
    track.fly(10.0)
    assert max(abs(away - 25.0) for away in track.away_m) < 0.6
    assert track.turned_rad * 25.0 == pytest.approx(-40.0, rel=0.06)
    assert asked(client, 25.0) == ACCEPTED
    back = circling(flight, NORTH_40, 25.0)
    back.fly(10.0)
    assert back.turned_rad * 25.0 == pytest.approx(40.0, rel=0.06)
    assert asked(client, -20.0, 4.0, centre=NORTH_40) == ACCEPTED
    first_again = circling(flight, NORTH_40, 20.0)
    first_again.fly(10.0)
    assert max(abs(away - 20.0) for away in first_again.away_m) < 0.6
    endings = [item for item in flight.decisions("complete") if item.word == "orbit"]
    assert len(endings) == 3, "the later ones; the first is flown on, as they have it"


def test_a_number_of_turns_is_flown_and_then_it_hovers(personality: Personality) -> None:
    flight, client = flying(personality)
    assert asked(client, 10.0, 3.0, turn_rad=1.5 * math.tau, centre=(0.0, 10.0)) == ACCEPTED
    track = Track(flight, (0.0, 10.0))
    track.fly(45.0)
    assert flight.is_in(State.HOVERING)
    assert track.turned_rad == pytest.approx(1.5 * math.tau, abs=0.5)
    assert [item.outcome for item in flight.decisions() if item.word == "orbit"] == [
        "accepted",
        "complete",
    ]


NOSES = [(0.0, math.pi), (NAN, math.pi), (3.0, 0.5 * math.pi)]
"""ORBIT_YAW_BEHAVIOUR, and where the nose points from the bearing of the vehicle, clockwise."""


@pytest.mark.parametrize(("behaviour", "from_bearing_rad"), NOSES)
def test_the_nose(personality: Personality, behaviour: float, from_bearing_rad: float) -> None:
    flight, client = flying(personality)
    assert asked(client, 20.0, 2.0, behaviour, centre=NORTH_40) == ACCEPTED
    circling(flight, NORTH_40, 20.0)
    for _ in range(10):
        client.beat()
        flight.run(1.0)
        east, north, _ = flight.truth_enu()
        bearing_rad = math.atan2(east - NORTH_40[0], north - NORTH_40[1])
        assert flight.session.telemetry is not None
        heading_rad = flight.session.telemetry.yaw_rad or 0.0
        off_rad = math.remainder(heading_rad - bearing_rad - from_bearing_rad, math.tau)
        assert abs(math.degrees(off_rad)) < 8.0


def test_the_nose_as_it_was(personality: Personality) -> None:
    flight, client = flying(personality)
    assert flight.session.telemetry is not None
    before_rad = flight.session.telemetry.yaw_rad or 0.0
    assert asked(client, 10.0, 3.0, 1.0) == ACCEPTED
    track = Track(flight, (0.0, 0.0))
    for _ in range(20):
        track.fly(1.0)
        turned = math.remainder((flight.session.telemetry.yaw_rad or 0.0) - before_rad, math.tau)
        assert abs(math.degrees(turned)) < 8.0


def test_who_asked_is_told_twice_a_second_what_is_flown(personality: Personality) -> None:
    flight, client = flying(personality)
    other = flight.join(246)
    assert asked(client, -20.0, 3.0, centre=NORTH_40, up_m=12.0) == ACCEPTED
    flight.beating(10.0)
    told = client.messages("ORBIT_EXECUTION_STATUS")
    assert len(told) == pytest.approx(20, abs=1)
    lat_deg, lon_deg = lat_lon(flight, NORTH_40)
    assert (told[-1].radius, told[-1].frame) == (-20.0, dialect.MAV_FRAME_GLOBAL)
    assert told[-1].x == pytest.approx(lat_deg * 1e7, abs=2)
    assert told[-1].y == pytest.approx(lon_deg * 1e7, abs=2)
    assert told[-1].z == pytest.approx(origin(flight).alt_amsl_m + 12.0, abs=0.1)
    assert (told[-1].get_srcSystem(), told[-1].get_srcComponent()) == VEHICLE
    assert not other.messages("ORBIT_EXECUTION_STATUS")


# ---------------------------------------------------------------------------------- refused


def refused(flight: BridgedFlight, client: Client, *words: str) -> None:
    """Nothing moves for it, and the client is told why."""
    texts = client.texts()
    for word in words:
        assert word in texts, texts
    before = flight.truth_enu()
    flight.beating(3.0)
    assert math.dist(before, flight.truth_enu()) < 0.5
    assert flight.is_in(State.HOVERING)
    assert not client.messages("ORBIT_EXECUTION_STATUS")
    assert [item.outcome for item in flight.decisions() if item.word == "orbit"] == ["refused"]


def test_one_that_leaves_the_fence_is_refused_with_the_finding(personality: Personality) -> None:
    """The nearest point of the circle is inside; 40 m + 60 m is not."""
    flight, client = flying(personality, structs.replace(DEFAULT, fence=(FIELD,)))
    assert asked(client, 60.0, 3.0, centre=NORTH_40) == DENIED
    refused(flight, client, "orbit: refused", "the circle of 60.0 m about", "field")
    (decision,) = [item for item in flight.decisions("refused") if item.word == "orbit"]
    assert decision.zone == "field"
    assert decision.numbers["outside_m"] == pytest.approx(10.0, abs=0.5)


def test_too_fast_is_refused_with_what_is_allowed(personality: Personality) -> None:
    """So tight a circle is flown at 4 m/s at most: v^2 / 8 m is then 2 m/s^2."""
    flight, client = flying(personality)
    assert asked(client, 8.0, 9.0, centre=(0.0, 8.0)) == DENIED
    refused(flight, client, "orbit: refused", "4.0 m/s")


def test_one_round_a_tower_is_flown(personality: Personality) -> None:
    policy = structs.replace(DEFAULT, fence=(FIELD, TOWER))
    flight, client = flying(personality, policy)
    assert asked(client, 12.0, 2.0, centre=(0.0, 25.0)) == ACCEPTED
    track = circling(flight, (0.0, 25.0), 12.0)
    track.fly(40.0)
    assert track.turned_rad > math.tau
    assert min(track.away_m) > 11.0
    assert "refused" not in client.texts()


def test_one_without_room_to_stop_is_refused_and_a_slower_one_flown(
    personality: Personality,
) -> None:
    """The circle itself ends 8 m before the fence."""
    flight, client = flying(personality, structs.replace(DEFAULT, fence=(FIELD,)))
    assert asked(client, 42.0, 9.0, centre=NORTH_40) == DENIED
    refused(flight, client, "the room to stop in", "circle of 42.0 m at 9.0 m/s", "field")
    assert asked(client, 42.0, 2.0, centre=NORTH_40) == ACCEPTED


def test_another_client_is_refused_and_changes_nothing(personality: Personality) -> None:
    flight, client = flying(personality)
    other = flight.join(246)
    assert asked(client, 20.0, 3.0, centre=NORTH_40) == ACCEPTED
    flight.beating(2.0)
    assert asked(other, 5.0, 1.0) == TEMPORARILY_REJECTED
    assert "OTHER_OPERATOR" in other.texts()
    track = circling(flight, NORTH_40, 20.0)
    track.fly(5.0)
    assert max(abs(away - 20.0) for away in track.away_m) < 0.6


def test_while_a_mission_is_flown_it_is_refused_as_a_goto_is(personality: Personality) -> None:
    flight, client = joined(PlanFlight(personality))
    items = mission(personality, (60.0, 0.0, 10.0))
    assert Mavsdk(flight, client, items).ended() == "complete", client.texts()
    assert client.ask(ARM, 1) == ACCEPTED
    client.command(MISSION_START)
    flight.until(lambda: flight.is_in(State.FLYING_MISSION), 10.0)
    flight.beating(10.0)
    assert asked(client, 10.0, 2.0) == TEMPORARILY_REJECTED
    assert "BUSY" in client.texts()
    assert flight.is_in(State.FLYING_MISSION)


# -------------------------------------------------------------------------------- it ends


def orbiting(personality: Personality) -> tuple[BridgedFlight, Client]:
    flight, client = flying(personality)
    assert asked(client, 15.0, 3.0, centre=NORTH_40) == ACCEPTED
    circling(flight, NORTH_40, 15.0)
    return flight, client


def told_no_more(flight: BridgedFlight, client: Client) -> None:
    """The orbit is over, and nothing of it comes back."""
    before = len(client.messages("ORBIT_EXECUTION_STATUS"))
    flight.beating(8.0)
    assert len(client.messages("ORBIT_EXECUTION_STATUS")) == before
    assert not flight.is_in(State.STREAMING)


def test_pause_ends_it_and_an_orbit_after_it_resumes(personality: Personality) -> None:
    flight, client = orbiting(personality)
    assert client.ask(PAUSE, 0.0) == ACCEPTED
    flight.beating(1.0)
    told_no_more(flight, client)
    assert flight.is_in(State.HOLDING)
    assert asked(client, 15.0, 3.0, centre=NORTH_40) == ACCEPTED
    track = circling(flight, NORTH_40, 15.0)
    track.fly(5.0)
    assert max(abs(away - 15.0) for away in track.away_m) < 0.6


@pytest.mark.parametrize(("command", "state"), [(RTL, State.RETURNING), (LAND, State.LANDING)])
def test_return_and_landing_end_it(personality: Personality, command: int, state: State) -> None:
    flight, client = orbiting(personality)
    assert client.ask(command) == ACCEPTED
    flight.beating(1.0)
    assert flight.is_in(state)
    told_no_more(flight, client)


def test_a_goto_ends_it(personality: Personality) -> None:
    flight, client = orbiting(personality)
    lat_deg, lon_deg = lat_lon(flight, (10.0, 10.0))
    client.fly_to(lat_deg, lon_deg, origin(flight).alt_amsl_m + UP_M)
    flight.beating(1.0)
    told_no_more(flight, client)
    flight.beating(20.0)
    assert math.dist(flight.truth_enu(), (10.0, 10.0, UP_M)) < 1.0


def test_a_client_that_falls_silent_is_held(personality: Personality) -> None:
    flight, _ = orbiting(personality)
    flight.run(8.5)
    assert flight.is_in(State.STREAMING), "it may be heard again, for client_gone_s"
    flight.run(3.0)
    assert flight.is_in(State.HOLDING)


def test_setpoints_of_its_own_are_flown_instead(personality: Personality) -> None:
    flight, client = orbiting(personality)
    before = flight.truth_enu()
    for count in range(100):
        if count % 20 == 0:
            client.beat()
        client.send(
            dialect.MAVLink_set_position_target_local_ned_message(
                0, *VEHICLE, 1, 0xDC7, 0, 0, 0, 0.0, -2.0, 0, 0, 0, 0, 0, 0
            )
        )
        flight.run(0.05)
    east_m, *_ = flight.truth_enu()
    assert east_m - before[0] == pytest.approx(-9.0, abs=3.0)
    told = len(client.messages("ORBIT_EXECUTION_STATUS"))
    assert asked(client, 15.0, 3.0, centre=NORTH_40) == ACCEPTED
    circling(flight, NORTH_40, 15.0)
    assert len(client.messages("ORBIT_EXECUTION_STATUS")) > told + 10
    assert client.ask(PAUSE, 0.0) == ACCEPTED
    told_no_more(flight, client)


def test_who_gives_control_up_ends_it(personality: Personality) -> None:
    flight, client = orbiting(personality)
    assert client.ask(RELEASE, 0.0) == ACCEPTED
    flight.beating(1.0)
    assert flight.is_in(State.HOLDING)
    told_no_more(flight, client)


def test_lost_positions_interrupt_it_and_it_goes_on(personality: Personality) -> None:
    flight, _ = orbiting(personality)
    flight.positions_lost = True
    flight.beating(0.8)
    flight.positions_lost = False
    flight.beating(5.0)
    assert flight.is_in(State.STREAMING)
    track = Track(flight, NORTH_40)
    track.fly(5.0)
    assert max(abs(away - 15.0) for away in track.away_m) < 0.8


def test_an_operator_of_the_station_orbits_by_json(personality: Personality) -> None:
    flight = Flight(personality).hovering(5.0)
    circle = ipc.Circle((0.0, 20.0, 8.0), -10.0, 3.0, 1.0, "along")
    flight.feed(inputs.OperatorLine(1, ipc.Ask(900, "orbit", orbit=circle)))
    assert flight.done(900, 90.0) == "complete"
    assert flight.is_in(State.HOVERING)
    told = flight.of(ipc.OrbitEvent)
    assert (told[-1].radius_m, told[-1].nose, told[-1].circling) == (-10.0, "along", True)
    assert told[-1].turns == pytest.approx(1.0, abs=0.06)
    assert told[-1].centre_enu == pytest.approx((0.0, 20.0, 8.0))
    wrong = ipc.Ask(901, "orbit", orbit=ipc.Circle(nose="backwards"))
    flight.feed(inputs.OperatorLine(1, wrong))
    assert flight.done(901) == "refused UNSUPPORTED"


def test_the_audit_of_its_record_finds_no_difference(monkeypatch: pytest.MonkeyPatch) -> None:
    tape = Tape()
    new = staticmethod(lambda: Recorder.without_file(tape, START_NS))
    monkeypatch.setattr(Flight, "new_recorder", new)
    flight, client = flying("px4")
    assert asked(client, 10.0, 3.0, turn_rad=3.0, centre=(0.0, 10.0)) == ACCEPTED
    assert asked(client, 500.0, 3.0) == DENIED
    flight.beating(14.0)
    assert flight.is_in(State.HOVERING)
    result = audit(tape.take(), tape.attachments, "test", "")
    assert result.good, (result.notes, result.first[:5])
    assert result.compared["frame sent"] > 400
