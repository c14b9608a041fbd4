"""Once or streamed: scripts, DroneKit and MAVProxy send once, MAVSDK and MAVROS at 20 Hz."""

from __future__ import annotations

from dataclasses import replace

from gcs.bridge.translate.meaning import Forward, Sample, Seen, Sticks, Words
from gcs.bridge.translate.settling import Pace
from gcs.bridge.translate.translate import meaning_of
from gcs.frames import Vec3
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT, PX4
from gcs.wire.ids import MavFrame
from gcs.wire.messages import SetPositionTargetLocalNed
from tests.unit.bridge.vehicles import flying

MS = 1_000_000
A, B = (10.0, 0.0, -22.0), (20.0, 0.0, -22.0)


class Client:
    """Sends positions and hears what they were taken for."""

    def __init__(self, seen: Seen, within_ms: int = 500) -> None:
        self.seen, self.pace, self.now_ns = seen, Pace(within_ms * MS), 0

    def sends(self, place: Vec3, after_ms: int) -> str:
        self.now_ns += after_ms * MS
        message = SetPositionTargetLocalNed(
            0, *place, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3576, 1, 1, MavFrame.LOCAL_NED
        )
        meant = meaning_of(message, self.seen)
        assert not isinstance(meant, Sticks)
        meaning = self.pace.settle(meant, self.now_ns)
        if isinstance(meaning, Sample):
            return "sample"
        assert isinstance(meaning, Words)
        assert meaning.if_repeated is None
        return meaning.asks[0].word if meaning.asks else "nothing"

    def gate(self, state: State, goal: Vec3) -> None:
        """What the gate made of it."""
        self.seen = replace(self.seen, state=state, goal_ned=goal)


def test_a_target_that_is_sent_once_is_a_go_to() -> None:
    client = Client(flying(ARDUPILOT))
    assert client.sends(A, 0) == "goto"
    client.gate(State.MOVING, A)
    assert client.sends(B, 2000) == "goto"


def test_a_target_that_is_repeated_for_safety_is_one_go_to() -> None:
    """At once, before the gate's tick, and after it."""
    client = Client(flying(ARDUPILOT))
    assert [client.sends(A, ms) for ms in (0, 10, 10)] == ["goto", "nothing", "nothing"]
    client.gate(State.MOVING, A)
    assert [client.sends(A, ms) for ms in (50, 50, 1000, 1000)] == ["nothing"] * 4


def test_a_position_that_moves_is_a_stream() -> None:
    client = Client(flying(ARDUPILOT))
    assert client.sends(A, 0) == "goto"
    assert [client.sends((10.0, y, -22.0), 50) for y in (0.1, 0.2, 0.3)] == ["sample"] * 3


def test_what_is_slower_than_one_sample_counts_is_no_stream() -> None:
    """`[stream] deadman_s` of the policy: 0.5 s, or as it is set."""
    for within_ms, slower, then in (
        (500, 450, "sample"),
        (500, 550, "goto"),
        (1000, 550, "sample"),
    ):
        client = Client(flying(ARDUPILOT), within_ms)
        assert client.sends(A, 0) == "goto"
        client.gate(State.MOVING, A)
        assert client.sends(B, slower) == then


def test_a_stream_that_stands_is_a_go_to_until_it_moves_on() -> None:
    client = Client(flying(ARDUPILOT))
    client.sends(A, 0)
    client.gate(State.MOVING, A)
    assert {client.sends(A, 50) for _ in range(40)} == {"nothing"}
    client.gate(State.HOVERING, A)
    assert client.sends(B, 50) == "sample"
    client.gate(State.STREAMING, B)
    assert {client.sends(B, 50) for _ in range(40)} == {"sample"}


def test_a_go_to_that_was_refused_is_tried_as_a_stream_by_who_streams() -> None:
    """It began on the ground; once the vehicle hovers it is flown."""
    client = Client(flying(ARDUPILOT, state=State.GROUNDED, goal_ned=None))
    assert client.sends(A, 0) == "goto"
    assert [client.sends(A, 50) for _ in range(5)] == ["nothing"] * 3 + ["sample"] * 2


def test_px4_and_velocities_are_samples_from_the_first_on() -> None:
    assert Client(flying(PX4)).sends(A, 0) == "sample"


def test_what_is_no_target_is_left_as_it_is() -> None:
    pace, hold = Pace(500 * MS), Words(())
    assert pace.settle(Forward(), 0) == Forward()
    assert pace.settle(hold, 0) is hold


def test_a_position_after_velocities_is_a_sample_too() -> None:
    """MAVSDK changes from one kind of setpoint to another within one stream."""
    client = Client(flying(ARDUPILOT))
    client.pace.settle(Sample(v_ned=(1.0, 0.0, 0.0)), 0)
    assert client.sends(A, 50) == "sample"
