"""Vehicles for other people's tests: a child process, its URL, its faults and its truth."""

from __future__ import annotations

import itertools
import json
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from queue import Empty, Queue
from typing import Final, Literal, TypeAlias

import msgspec

from vehicle_sim.autopilot.interface import Truth

Personality: TypeAlias = Literal["px4", "ardupilot"]

START_S: Final = 60.0
ANSWER_S: Final = 60.0
"""A machine that tests share may stop it for seconds; one that has ended is told at once."""
STOP_S: Final = 5.0
POLL_S: Final = 0.02
LOG_LINES: Final = 40
"""So many of the last are told with an error."""


class SimulatorError(Exception):
    """The simulator did not start, does not answer, or refused; the message has its own words."""


class SimVehicle:
    """One vehicle of a running simulator.

    `url` is where a client connects, in MAVSDK's form; `pymavlink_url` the same for
    `mavutil.mavlink_connection`.
    """

    def __init__(self, simulator: Simulator, system: int, url: str) -> None:
        self._simulator = simulator
        self.system: Final = system
        self.url: Final = url

    @property
    def personality(self) -> Personality:
        return self._simulator.personality

    @property
    def pymavlink_url(self) -> str:
        kind, _, place = self.url.partition("://")
        return f"{kind.removesuffix('out') if kind == 'tcpout' else kind}:{place}"

    @property
    def log(self) -> list[str]:
        """What the simulator has said so far."""
        return list(self._simulator.log)

    def inject(self, kind: str, **keys: object) -> None:
        """A fault, by the kinds and keys of a fault file: `inject("motor", motor=2)`."""
        self._simulator.ask(do="fault", kind=kind, keys=keys, vehicle=self.system)

    def mend(self, kind: str, **keys: object) -> None:
        """End such a fault: `mend("motor", motor=2)`."""
        self._simulator.ask(do="mend", kind=kind, keys=keys, vehicle=self.system)

    def truth(self) -> Truth:
        """What really is, now."""
        truth = self._simulator.ask(do="truth", vehicle=self.system)["truth"]
        return msgspec.convert(truth, Truth)

    def wait(self, holds: Callable[[Truth], bool], timeout_s: float = 60.0) -> Truth:
        """The first truth seen for which `holds` does; it is looked at 50 times a second.

        The time-out is in real seconds.  Raises TimeoutError with the last truth.
        """
        end = time.monotonic() + timeout_s
        while True:
            truth = self.truth()
            if holds(truth):
                return truth
            if time.monotonic() > end:
                raise TimeoutError(f"not within {timeout_s:g} s; at last {truth}")
            time.sleep(POLL_S)

    def stop(self) -> None:
        """End the simulator, with all its vehicles.  Twice does no harm."""
        self._simulator.stop()


class Simulator:
    """A `vehicle-sim` process of our own.  It ends with us, however we end."""

    def __init__(
        self,
        personality: Personality = "px4",
        count: int = 1,
        speedup: float = 1.0,
        seed: int = 1,
        options: Sequence[str] = (),
        params: Mapping[str, float] | None = None,
    ) -> None:
        """`params` of the vehicle; `options`: more words for the command line.

        Raises SimulatorError.
        """
        self.personality: Final = personality
        self.log: Final[list[str]] = []
        self._asking = threading.Lock()
        self._answers: Queue[dict[str, object]] = Queue()
        self._numbers = itertools.count(1)
        words = [sys.executable, "-m", "vehicle_sim", "--control", "--autopilot", personality]
        words += ["--count", str(count), "--speedup", str(speedup), "--seed", str(seed)]
        for name, value in (params or {}).items():
            words += ["--param", f"{name}={value}"]
        if not any(option.partition("=")[0] in ("--link", "--port") for option in options):
            words += ["--link", "udpin://127.0.0.1:0"]
        self._process = subprocess.Popen(
            [*words, *options],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        try:
            ready = self._next(START_S)["ready"]
        except (SimulatorError, KeyError) as error:
            self.stop()
            raise SimulatorError("vehicle-sim did not start:\n" + "\n".join(self.log)) from error
        assert isinstance(ready, list)
        self.vehicles: Final = tuple(
            SimVehicle(self, each["system"], each["urls"][0]) for each in ready
        )

    def ask(self, **words: object) -> dict[str, object]:
        """One question over the control line, from any thread.  Raises SimulatorError."""
        with self._asking:
            number = next(self._numbers)
            assert self._process.stdin is not None
            try:
                self._process.stdin.write(json.dumps({"id": number, **words}).encode() + b"\n")
                self._process.stdin.flush()
            except (OSError, ValueError) as error:
                raise self._ended() from error
            answer = self._next(ANSWER_S)
            while answer.get("id") != number:
                answer = self._next(ANSWER_S)
        if "error" in answer:
            raise SimulatorError(str(answer["error"]))
        return answer

    def stop(self) -> None:
        """Twice does no harm."""
        process = self._process
        assert process.stdin is not None
        assert process.stdout is not None
        with suppress(OSError):  # it has ended by itself, with something unread
            process.stdin.close()
        try:
            process.wait(STOP_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        self._reader.join()
        process.stdout.close()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for raw in self._process.stdout:
            line = raw.decode("utf-8", "replace").rstrip()
            answer = _object(line)
            if answer is None or "log" in answer:
                self.log.append(line if answer is None else str(answer["log"]))
            else:
                self._answers.put(answer)
        self._answers.put({"ended": True})

    def _next(self, timeout_s: float) -> dict[str, object]:
        try:
            answer = self._answers.get(timeout=timeout_s)
        except Empty:
            said = "\n".join(self.log[-LOG_LINES:])
            raise SimulatorError(
                f"no answer from vehicle-sim for {timeout_s:g} s:\n{said}"
            ) from None
        if "ended" in answer:
            self._answers.put(answer)  # whoever asks next is told so, too
            raise self._ended()
        return answer

    def _ended(self) -> SimulatorError:
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(STOP_S)
        said = "\n".join(self.log[-LOG_LINES:])
        return SimulatorError(f"vehicle-sim has ended ({self._process.returncode}):\n{said}")


def _object(line: str) -> dict[str, object] | None:
    """A line of the control protocol; None for anything else, such as a warning of Python's."""
    try:
        answer = json.loads(line)
    except ValueError:
        return None
    return answer if isinstance(answer, dict) else None
