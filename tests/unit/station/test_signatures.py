"""What the log has of frames that were wrongly signed, however often their senders come and go."""

from __future__ import annotations

from gcs.station.signatures import TELL_EVERY_NS, Keys, Signatures
from gcs.wire.codec import FrameWriter
from gcs.wire.frame import Frame, split
from gcs.wire.messages import CommandLong, Heartbeat, SetPositionTargetLocalNed
from gcs.wire.signing import EPOCH_NS, Bad, Checker, Reason, SecretKey

S = 1_000_000_000
START_NS = EPOCH_NS + 1_000_000 * S
LINK = 1
BEAT = Heartbeat(custom_mode=0, type=6, autopilot=8, base_mode=0, system_status=4)


def unsigned() -> Frame:
    (frame,) = split(FrameWriter(246, 190).write(BEAT))
    assert isinstance(frame, Frame)
    return frame


def test_who_comes_anew_again_and_again_is_told_as_one_who_stays() -> None:
    signatures = Signatures(Keys(client=SecretKey(bytes(32))), 255, 191, 1)
    told: list[int] = []
    for second in range(25):
        now_ns = START_NS + second * S
        assert signatures.refused(LINK, unsigned(), now_ns) is Reason.UNSIGNED
        assert signatures.counts(LINK) == {Reason.UNSIGNED: 1}
        told += [second for _ in signatures.second(now_ns)]
        signatures.forget(LINK)
    every = TELL_EVERY_NS // S
    assert told == [0, every, 2 * every]


def test_a_command_that_a_setpoint_overtakes_is_no_replay_to_the_vehicle() -> None:
    """They leave in the same turn, and the link may bring the setpoint first."""
    key = SecretKey(bytes(range(32)))
    signatures = Signatures(Keys(vehicle=key), 255, 190, 1)
    writer = FrameWriter(255, 190)
    command = CommandLong(1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 400, 1, 1, 0)
    at, still = (0.0, 0.0, -5.0), (0.0, 0.0, 0.0)
    setpoint = SetPositionTargetLocalNed(0, *at, *still, *still, 0.0, 0.0, 0xDF8, 1, 1, 1)
    sent = [signatures.outgoing(0, writer.write(each), START_NS) for each in (command, setpoint)]
    vehicle = Checker(key)
    for raw in reversed(sent):
        (frame,) = split(raw)
        assert isinstance(frame, Frame)
        assert not isinstance(vehicle.check(frame, START_NS), Bad), frame.name
        assert isinstance(vehicle.check(frame, START_NS), Bad), "a second time it is one"


def test_the_page_tells_of_one_that_has_sent_nothing_only_that_it_is_not_verified() -> None:
    signatures = Signatures(Keys(client=SecretKey(bytes(32))), 255, 191, 1)
    assert signatures.told(LINK, verified=False) == ""
    assert signatures.told(LINK) == "signed"
    signatures.refused(LINK, unsigned(), START_NS)
    assert signatures.told(LINK, verified=False) == "1 unsigned"
