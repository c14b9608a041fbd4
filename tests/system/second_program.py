"""A second program that aborts, when it had asked, and when it was told that it is done."""

from __future__ import annotations

import random
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

from pymavlink.dialects.v20 import all as dialect

from tests.system.patience import until
from tests.system.programs import LONGEST_S
from tests.system.wire_tap import Crossing, WireTap

PX4_AUTO, PX4_LOITER = 4, 3

_NOTED = """
import sys, time
from gcs.operator.conversation import Conversation
from gcs.operator.joined import JoinedStation
from gcs import ipc
sent = []
send, told = JoinedStation.send, Conversation.told
def noting_send(self, command):
    went = send(self, command)
    if isinstance(command, ipc.Ask):
        sent.append(time.monotonic_ns())
    return went
def noting_told(self, event):
    if isinstance(event, ipc.EndingEvent) and event.ended == "complete":
        sent.append(time.monotonic_ns())
    return told(self, event)
JoinedStation.send, Conversation.told = noting_send, noting_told
"""
_PROGRAMS = {
    "gcs abort": "from gcs.cli.main import run\nassert run(['abort']) == 0\n",
    "python": "import gcs\nwith gcs.connect() as station:\n    station.abort()\n",
}
"""The program as it is; around it only the moments of sending and of hearing are noted."""


@dataclass(frozen=True, slots=True)
class Noted:
    """ns of the monotonic clock, which all processes share; `sent_ns`: the station has it."""

    sent_ns: int
    complete_ns: int


def noted_ns(program: str) -> Noted:
    """Run it to its end."""
    code = _NOTED + _PROGRAMS[program] + "print('noted', *sent)\n"
    ended = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=LONGEST_S, check=False
    )
    assert ended.returncode == 0, ended.stderr
    (noted,) = (line for line in ended.stdout.splitlines() if line.startswith("noted "))
    sent_ns, complete_ns = map(int, noted.split()[1:])
    return Noted(sent_ns, complete_ns)


class HoldWatch:
    """Notes when a command to hold passes."""

    def __init__(self) -> None:
        self.passed_ns: list[int] = []

    def hear(self, crossing: Crossing) -> None:
        message = dialect.MAVLink(None).parse_char(crossing.data)
        if message is not None and message.get_type() == "COMMAND_LONG":
            asked = (message.command, message.param2, message.param3)
            if asked == (dialect.MAV_CMD_DO_SET_MODE, PX4_AUTO, PX4_LOITER):
                self.passed_ns.append(crossing.at_ns)


class Stopwatch(HoldWatch):
    """How long it takes from an abort to the hold command."""

    def __init__(self) -> None:
        super().__init__()
        self._moments = random.Random(1)

    def latency_ms(self, abort: Callable[[], object]) -> float:
        time.sleep(self._moments.uniform(0.0, 0.2))
        known = len(self.passed_ns)
        start_ns = time.monotonic_ns()
        abort()
        until(lambda: len(self.passed_ns) > known, "the hold command")
        return (self.passed_ns[known] - start_ns) / 1e6


def loiter_seen_ns(tap: WireTap, custom_mode: int, after_ns: int = 0) -> int:
    """When the first heartbeat with that mode came to the station."""
    for crossing in tap.to_station:
        if crossing.at_ns < after_ns:
            continue
        for message in dialect.MAVLink(None).parse_buffer(crossing.data) or ():
            seen = message.get_type() == "HEARTBEAT" and message.custom_mode == custom_mode
            if seen and message.get_srcComponent() == 1:
                return crossing.at_ns
    raise AssertionError("the mode was never seen")
