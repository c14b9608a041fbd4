"""A setpoint stream of a Python program: it begins, is fed sample by sample, and ends.

Nothing is sent behind the program's back: a sample counts half a second (the policy's dead-man's
time), and a program that hangs is a stream that falls silent, so that the vehicle is held.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from types import TracebackType
from typing import Protocol

from gcs import ipc
from gcs.operator import arguments
from gcs.operator.conversation import Conversation
from gcs.operator.failures import Disconnected, NotCompleted

PERIOD_S = 0.1
"""From one sample to the next: five of them count at a time."""


class Running(Protocol):
    """The operation of a stream: whether it is under way, and how it has ended."""

    @property
    def state(self) -> str: ...
    def wait(self, timeout_s: float | None = None) -> object: ...


class Streaming(Protocol):
    """What a stream needs of the station."""

    talk: Conversation

    def request(
        self, ask: ipc.Ask, wait: bool = True, timeout_s: float | None = None
    ) -> Running: ...
    def tell(self, command: ipc.Command) -> None: ...
    def wait_until(self, done: Callable[[], bool], timeout_s: float | None) -> None: ...


@arguments.all_called_right
class Stream:
    """Made by `Station.stream`; a `with` block begins it, and ends it in good order.

    East, north and up are metres, and metres per second; yaw is degrees clockwise from north.
    """

    def __init__(self, station: Streaming) -> None:
        self._station = station
        self._operation: Running | None = None

    def __enter__(self) -> Stream:
        self._station.talk.stream_verdict = None
        self._operation = self._station.request(ipc.Ask(0, "stream_begin"), wait=False)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._ended or isinstance(error, Disconnected):
            return
        self._station.request(ipc.Ask(0, "stream_end"))

    @property
    def refusal(self) -> ipc.StreamVerdictEvent | None:
        """Why the samples are refused and the vehicle is held in its place; None: they are flown,
        or nothing was told yet."""
        told = self._station.talk.stream_verdict
        return None if told is None or told.outcome == "accepted" else told

    @property
    def _ended(self) -> bool:
        return self._operation is None or self._operation.state != "running"

    def velocity(
        self,
        east_m_s: float,
        north_m_s: float,
        up_m_s: float,
        *,
        yaw_deg: float | None = None,
        yaw_rate_deg_s: float | None = None,
    ) -> None:
        """Fly this fast until the next sample comes.  Raises NotCompleted where the stream has
        ended, as by a hold, and Disconnected."""
        v_enu = arguments.numbers("velocity", east_m_s=east_m_s, north_m_s=north_m_s, up_m_s=up_m_s)
        yaw = arguments.optional("velocity", yaw_deg=yaw_deg)
        rate = arguments.optional("velocity", yaw_rate_deg_s=yaw_rate_deg_s)
        self.send(ipc.Stream(v_enu=v_enu, yaw_deg=yaw, yaw_rate_deg_s=rate))

    def position(
        self, east_m: float, north_m: float, up_m: float, *, yaw_deg: float | None = None
    ) -> None:
        """Fly there until the next sample comes.  Raises NotCompleted, Disconnected."""
        pos_enu = arguments.numbers("position", east_m=east_m, north_m=north_m, up_m=up_m)
        yaw = arguments.optional("position", yaw_deg=yaw_deg)
        self.send(ipc.Stream(pos_enu=pos_enu, yaw_deg=yaw))

    def attitude(
        self,
        roll_deg: float,
        pitch_deg: float,
        yaw_deg: float,
        thrust: float,
        *,
        yaw_rate_deg_s: float | None = None,
    ) -> None:
        """Lean so until the next sample comes: roll to the right, nose up, heading clockwise from
        north.  `thrust` is 0 to 1: of a PX4's full thrust, or an ArduCopter's climb rate with 0.5
        for none.  Refused unless the policy's `[stream] tilt_deg` lets it.  Raises NotCompleted,
        Disconnected."""
        self.send(
            ipc.Stream(
                roll_deg=arguments.number("attitude", roll_deg=roll_deg),
                pitch_deg=arguments.number("attitude", pitch_deg=pitch_deg),
                yaw_deg=arguments.number("attitude", yaw_deg=yaw_deg),
                yaw_rate_deg_s=arguments.optional("attitude", yaw_rate_deg_s=yaw_rate_deg_s),
                thrust=arguments.number("attitude", thrust=thrust),
            )
        )

    def send(self, sample: ipc.Stream) -> None:
        """Any sample.  Raises NotCompleted, Disconnected."""
        self.check()
        self._station.tell(sample)

    def check(self) -> None:
        """Raises NotCompleted where the stream is not flown any more, Disconnected."""
        if self._operation is None:
            raise NotCompleted("refused", "NOT_RUNNING", "the stream begins with a `with` block")
        if self._ended:
            self._operation.wait(0.0)  # raises how it has ended
            raise NotCompleted("complete", "NOT_RUNNING", "the stream is over")

    def ticks(self, seconds: float = math.inf, period_s: float = PERIOD_S) -> Iterator[float]:
        """For one sample each: how many seconds the stream is old, for so many seconds.

        Ends sooner where the stream ends.
        """
        arguments.positive("ticks", seconds=seconds)
        arguments.positive("ticks", period_s=period_s)
        begun_s = time.monotonic()
        while not self._ended and (past_s := time.monotonic() - begun_s) < seconds:
            yield past_s
            left_s = begun_s + seconds - time.monotonic()
            self._station.wait_until(lambda: self._ended, max(0.0, min(period_s, left_s)))
