"""`gcs bridge --lock` over several links: which vehicles it locks."""

from __future__ import annotations

import pytest

from gcs.cli.bridge import lock as bridge_lock
from gcs.cli.bridge.lock import LockOptions, lock_vehicles
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError
from gcs.protocol.lock_parameters import Locking
from gcs.protocol.lock_setup import Ending, LockSetup
from gcs.shell.clock import Clock
from gcs.wire.codec import FrameWriter
from gcs.wire.frame import Frame, split
from gcs.wire.messages import Heartbeat

OPTIONS = LockOptions(255, "default", set_fence=False, enforce_sysid=False)
LINKS = ("udpin://127.0.0.1:14540", "udpin://127.0.0.1:14541")
BEAT = Heartbeat(
    custom_mode=0, type=2, autopilot=12, base_mode=81, system_status=4, mavlink_version=3
)


def beat_of(sysid: int) -> Frame:
    (frame,) = split(FrameWriter(sysid, 1).write(BEAT))
    assert isinstance(frame, Frame)
    return frame


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The links that were spoken on: on each its own vehicle, whose parameters are right."""
    links: list[str] = []

    def over(setup: LockSetup, url: str, _clock: Clock) -> None:
        links.append(url)
        for sysid in HEARD[url]:
            setup.handle(beat_of(sysid), 0)
        setup.ending = Ending.DONE

    monkeypatch.setattr(bridge_lock, "over_link", over)
    return links


HEARD = {LINKS[0]: (1,), LINKS[1]: (2,), "shared": (1, 2)}


def test_the_vehicle_on_each_link_is_locked(
    opened: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    lock_vehicles(LINKS, "", OPTIONS, None, 1.0)
    assert opened == list(LINKS)
    told = capsys.readouterr().err
    assert "lock: vehicle 1/1: it has no key" in told
    assert "lock: vehicle 2/1: it has no key" in told


def test_with_a_vehicle_chosen_it_is_locked_alone(opened: list[str]) -> None:
    lock_vehicles(LINKS, "", OPTIONS, 1, 1.0)
    assert opened == [LINKS[0]]
    lock_vehicles(["shared"], "", OPTIONS, 1, 1.0)


def test_another_vehicle_on_the_same_link_is_not_passed_over_in_silence(opened: list[str]) -> None:
    with pytest.raises(ExitError) as refused:
        lock_vehicles(["shared", LINKS[0]], "", OPTIONS, None, 1.0)
    assert refused.value.exit_code == ExitCode.USAGE
    assert "vehicle 1/1 is locked, and 2 on the same link is not" in str(refused.value)
    assert "--target SYSID" in refused.value.hint
    assert opened == ["shared"]


def test_what_else_is_heard_is_what_the_set_up_says() -> None:
    setup = LockSetup(None, Locking(255, None, enforce_sysid=False), 0, 10**10)
    for sysid in (3, 7, 3, 7, 9):
        setup.handle(beat_of(sysid), 0)
    assert (setup.vehicle, setup.others) == ("3/1", {7, 9})
