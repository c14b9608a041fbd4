"""A real autopilot with its own simulation, in real time, as a simulator of flights.

The factories of the entry points `px4-sitl` and `arducopter-sitl`.  Its process starts when it is
first asked for something, and is then waited for until it says that it can be armed: what flies it
finds a vehicle as ready as one that is simulated here.  The station has one of its links; on the
other one its simulation's truth is asked for, so that nothing that is recorded differs by it.
"""

from __future__ import annotations

import os
import select
import shlex
import shutil
import socket
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

import msgspec

from gcs.campaign.real_truth import HERTZ, RealTruth
from gcs.wire.codec import FrameWriter
from gcs.wire.dialect import MESSAGES
from gcs.wire.frame import Frame, split
from gcs.wire.ids import Cmd, ParamType
from gcs.wire.messages import CommandLong, Message, ParamSet

OBSERVER: Final = 250, 190
"""Another system and component than the station's."""
READY_WAIT_S: Final = 60.0
SET_WAIT_S: Final = 10.0
ASK_EVERY_S: Final = 1.0
LEAST_SHARE: Final = 0.85
MOST_HELD_UP_NS: Final = 500_000_000
STEP_NS: Final = 5_000_000
"""How long datagrams lie at most before the station is told."""
MAX_DATAGRAM: Final = 65_535
GROUND_PORT: Final = 14_550
ONBOARD_PORT: Final = 14_540


@dataclass(frozen=True)
class Kind:
    """`runs` is the first word of `run`; `variable` names what starts it."""

    runs: str
    variable: str
    autopilot: str


PX4 = Kind("px4", "MAVGATE_PX4", "px4")
ARDUCOPTER = Kind("arducopter", "MAVGATE_ARDUCOPTER", "ardupilot")
OWN = ("start_ns", "seed", "firmware", "airframe", "sensors", "instance")
"""Keys that its simulation has nothing to do with: it has chance, airframe and sensors of its own.
`instance` is the number of a PX4 among those of the machine."""
WIND = {"wind_m_s": "SIM_WIND_SPD", "wind_from_deg": "SIM_WIND_DIR", "gust_m_s": "SIM_WIND_TURB"}
STEADY_WIND, SPEEDUP = "SIM_WIND_T", "SIM_SPEEDUP"
"""1 of the first: the same wind at every height, which grows to 60 m without it."""
FAST: Final = 8.0
"""ArduCopter gets ready so many times faster; it flies in real time."""


class NoAutopilotError(Exception):
    """None is there, or it does not get ready."""


def command(kind: Kind) -> list[str]:
    """What starts it but for the folder and what comes behind.  Raises NoAutopilotError."""
    named = os.environ.get(kind.variable, "")
    words = shlex.split(named)
    if Path(named).is_dir():
        words = [str(Path(named) / "run"), kind.runs]
    if not words or shutil.which(words[0]) is None:
        hint = f"{kind.variable} names a folder with a program `run`, or a command"
        raise NoAutopilotError(f"{kind.runs}: none is there; {hint}")
    return words


def installed(simulator: str) -> None:
    """Raises NoAutopilotError where this entry point of ours has no autopilot to start."""
    for kind in (PX4, ARDUCOPTER):
        if simulator == f"{kind.runs}-sitl":
            command(kind)


def start(kind: Kind, folder: Path, instance: int = 0) -> subprocess.Popen[bytes]:
    """It sends to `GROUND_PORT` and `ONBOARD_PORT` of this machine, a PX4 to the second one plus
    `instance`; what it prints goes to `folder/output.txt`.  Raises NoAutopilotError."""
    words = command(kind)
    folder.mkdir(parents=True, exist_ok=True)
    arguments = [str(GROUND_PORT), "--serial1", f"udpclient:127.0.0.1:{ONBOARD_PORT}"]
    if kind is PX4:
        arguments = [str(instance)]
    with (folder / "output.txt").open("wb") as output:
        return subprocess.Popen(
            [*words, str(folder), *arguments],
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
        )


def end(process: subprocess.Popen[bytes]) -> None:
    if process.poll() is None:
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def private_network() -> list[str] | None:
    """What runs a command in a network of its own, or None where the system allows none."""
    if shutil.which("unshare") is None or shutil.which("ip") is None:
        return None
    unshare = ["unshare", "-n"] if os.geteuid() == 0 else ["unshare", "-rn"]
    words = [*unshare, "sh", "-c", 'ip link set lo up && exec "$@"', "sh"]
    allowed = subprocess.run([*words, "true"], capture_output=True, check=False).returncode == 0
    return words if allowed else None


def px4(table: Mapping[str, object]) -> RealAutopilot:
    """Raises ValueError: a key that it cannot do as asked."""
    return RealAutopilot(PX4, table)


def arducopter(table: Mapping[str, object]) -> RealAutopilot:
    """Raises ValueError: a key that it cannot do as asked."""
    return RealAutopilot(ARDUCOPTER, table)


def asked_of(kind: Kind, table: Mapping[str, object]) -> dict[str, float]:
    """The parameters that make its simulation what the table says.

    Raises ValueError.  What is "" or 0 is asked of nobody.
    """
    found: dict[str, float] = {STEADY_WIND: 1.0} if kind is ARDUCOPTER else {}
    for key, value in table.items():
        if key == "autopilot":
            if value != kind.autopilot:
                raise ValueError(f"autopilot: this is a real {kind.autopilot}")
        elif kind is ARDUCOPTER and key in WIND and isinstance(value, int | float):
            found[WIND[key]] = value % 360.0 if key == "wind_from_deg" else value
        elif value and key not in OWN and key != "wind_from_deg":
            raise ValueError(f"{key}: a real {kind.runs} with its own simulation has no such thing")
    return found


class RealAutopilot:
    """See the module.  `close` ends its process."""

    def __init__(self, kind: Kind, table: Mapping[str, object]) -> None:
        instance = msgspec.convert(table.get("instance", 0), int)
        self._kind, self._instance = kind, instance
        self._sysid = 1 + instance if kind is PX4 else 1
        self._set = asked_of(kind, table)
        self._start_ns = msgspec.convert(table["start_ns"], int)
        self._truth = RealTruth(kind.autopilot)
        self._write = FrameWriter(*OBSERVER).write
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._process: subprocess.Popen[bytes] | None = None
        # A PX4 has a set of streams for each link: the station has the one of programs on board.
        ports = (
            (ONBOARD_PORT + instance, GROUND_PORT) if kind is PX4 else (GROUND_PORT, ONBOARD_PORT)
        )
        self._link, self._beside = _Link(ports[0]), _Link(ports[1])
        self._began_ns = self._heard_ns = 0
        self._clock_began_ms = 0
        self._late_ns = self._silent_ns = self._spoke_ns = 0
        """How late the station was, and how long the truth was not told, at most."""

    # --------------------------------------------------------------- as whoever flies it has it

    @property
    def deadline_ns(self) -> int:
        return self._heard_ns + STEP_NS

    def handle(self, now_ns: int, datagrams: Sequence[bytes] = ()) -> list[bytes]:
        """Wait until it is `now_ns`; what came in the meantime."""
        self._begin()
        for data in datagrams:
            self._link.send(data)
        self._late_ns = max(self._late_ns, self._now_ns() - now_ns)
        heard = self._hear(lambda: (now_ns - self._now_ns()) / 1e9)
        self._heard_ns = now_ns
        return heard

    def truth(self) -> dict[str, object]:
        """As any simulator's; `home` is where its simulation really placed it."""
        self._begin()
        found: dict[str, object] = msgspec.structs.asdict(self._truth.truth())
        return found

    # ------------------------------------------------------------------------------- beyond that

    @property
    def starved(self) -> str:
        """In which way the machine was too slow, so that what was flown says nothing; or nothing.

        A simulation that gets too little of it runs slower than real time, or stops for a while;
        a station then finds its positions too old, or decides late.
        """
        wall_ms = (time.monotonic_ns() - self._began_ns) / 1e6
        if self._process is None or wall_ms < 1e3 * ASK_EVERY_S:
            return ""
        share = (self._truth.clock_ms - self._clock_began_ms) / wall_ms
        if share < LEAST_SHARE:
            return f"the vehicle's clock ran at {share:.2f} of real time"
        for who, worst_ns in (("vehicle", self._silent_ns), ("station", self._late_ns)):
            if worst_ns > MOST_HELD_UP_NS:
                return f"the {who} was held up for {worst_ns / 1e9:.1f} s"
        return ""

    def close(self) -> None:
        if self._process is not None:
            end(self._process)
        self._link.close()
        self._beside.close()
        if self._folder is not None:
            self._folder.cleanup()

    def _now_ns(self) -> int:
        return self._start_ns + time.monotonic_ns() - self._began_ns

    def _begin(self) -> None:
        if self._process is not None:
            return
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self._link.open()
        self._beside.open()
        folder = Path(self._folder.name)
        self._process = start(self._kind, folder, self._instance)
        fast = {SPEEDUP: FAST} if self._kind is ARDUCOPTER else {}
        self._until(lambda: self._truth.known, READY_WAIT_S, "tells no truth")
        self._set_all({**self._set, **fast})
        self._until(lambda: self._truth.ready, READY_WAIT_S, "cannot be armed")
        self._set_all(dict.fromkeys(fast, 1.0))
        clock_ms = self._truth.clock_ms
        self._until(lambda: self._truth.clock_ms > clock_ms, READY_WAIT_S, "tells no time")
        self._began_ns = time.monotonic_ns()
        self._heard_ns, self._clock_began_ms = self._start_ns, self._truth.clock_ms

    def _set_all(self, values: Mapping[str, float]) -> None:
        for name, value in values.items():
            self._truth.parameters.pop(name, None)
            self._until(
                partial(self._is_set, name, value),
                SET_WAIT_S,
                f"does not take {name}",
                [ParamSet(value, self._sysid, 1, name, ParamType.REAL32)],
            )

    def _is_set(self, name: str, value: float) -> bool:
        told = self._truth.parameters.get(name)
        return told is not None and abs(told - value) < 1e-3 * max(1.0, value)

    def _until(
        self,
        condition: Callable[[], bool],
        seconds: float,
        wrong: str,
        ask: Iterable[Message] | None = None,
    ) -> None:
        """Ask every second, until it is so.  Raises NoAutopilotError."""
        assert self._process is not None
        last_s = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > last_s or self._process.poll() is not None:
                raise NoAutopilotError(f"{self._kind.runs}: {wrong}; {self._told()}")
            for message in self._streams() if ask is None else ask:
                self._beside.send(self._write(message))
            self._hear(partial(_left_s, condition, time.monotonic() + ASK_EVERY_S))

    def _streams(self) -> Iterable[Message]:
        for definition in MESSAGES.values():
            if hertz := HERTZ.get(definition.name):
                words = (float(definition.msgid), 1e6 / hertz, 0.0, 0.0, 0.0, 0.0, 0.0)
                number = Cmd.SET_MESSAGE_INTERVAL
                yield CommandLong(*words, number, self._sysid, 1, 0)

    def _told(self) -> str:
        """The last lines that it printed."""
        assert self._folder is not None
        said = (Path(self._folder.name) / "output.txt").read_text(errors="replace")
        return " | ".join(said.split("\n")[-4:])

    def _hear(self, left_s: Callable[[], float]) -> list[bytes]:
        """All that comes to the station's link, while there is time left."""
        found: list[bytes] = []
        waits = [self._link.socket, self._beside.socket]
        while True:
            ready, _, _ = select.select(waits, [], [], max(0.0, left_s()))
            if not ready:
                return found
            for link in (self._link, self._beside):
                if link.socket in ready:
                    data = link.read()
                    self._take(split(data))
                    if link is self._beside:
                        self._spoken()
                    else:
                        found.append(data)

    def _spoken(self) -> None:
        now_ns = time.monotonic_ns()
        if self._began_ns:
            self._silent_ns = max(self._silent_ns, now_ns - max(self._spoke_ns, self._began_ns))
        self._spoke_ns = now_ns

    def _take(self, items: Iterable[object]) -> None:
        for item in items:
            if isinstance(item, Frame):
                self._truth.take(item)


def _left_s(condition: Callable[[], bool], until_s: float) -> float:
    """Until then, or nothing once it is so."""
    return 0.0 if condition() else until_s - time.monotonic()


class _Link:
    """A port of this machine to which the vehicle sends."""

    def __init__(self, port: int) -> None:
        self._port = port
        self._peer: tuple[str, int] | None = None
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def open(self) -> None:
        self.socket.bind(("127.0.0.1", self._port))

    def read(self) -> bytes:
        data, self._peer = self.socket.recvfrom(MAX_DATAGRAM)
        return data

    def send(self, data: bytes) -> None:
        """Dropped while nothing has come."""
        if self._peer is not None:
            self.socket.sendto(data, self._peer)

    def close(self) -> None:
        self.socket.close()
