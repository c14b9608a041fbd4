"""Who flies: the library, one-shot commands, a MAVLink client through the bridge."""

import importlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gcs
from gcs import ipc
from gcs.operator import joined
from tests.real.autopilots import Kind
from tests.real.truth import Vector

STATION_PORT = 14600
CLIENT_PORT = 14601
LINK = f"udpin://127.0.0.1:{STATION_PORT}"
GCS = str(Path(sys.executable).with_name("gcs"))
LEG_S = 150.0


def outcome_of(request: Callable[[], object]) -> str:
    """What became of it: "complete", or the word and the code, and the sentence."""
    try:
        request()
    except gcs.Refused as refused:
        return f"refused {refused}"
    except gcs.GcsError as error:
        return f"not completed: {error}"
    return "complete"


class Library:
    """`gcs.connect`, with a station process of its own; `said` is what it told of its states."""

    def __init__(self, policy: Path, folder: Path) -> None:
        self.station = gcs.connect(LINK, policy=str(policy), log_dir=str(folder), timeout_s=60.0)
        self.said: list[str] = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        for event in self.station.events():
            if isinstance(event, ipc.StateEvent):
                self.said.append(f"{event.before}>{event.after}: {event.event}")

    def take(self) -> str:
        """Control of a vehicle that somebody else has flown, or that holds."""
        time.sleep(0.5)  # for the snapshot that shows it
        if self.station.state == "HOLDING":
            return outcome_of(lambda: self.station.resume(timeout_s=20.0))
        if self.station.snapshot.control == "OURS":
            return "complete"
        return outcome_of(lambda: self.station.control(timeout_s=20.0))

    def goto(self, goal: Vector) -> str:
        taken = self.take()
        if taken != "complete":
            return f"control {taken}"
        return outcome_of(lambda: self.station.goto(*goal, timeout_s=LEG_S))

    def kill(self) -> None:
        for one in joined.running_stations():
            os.kill(one.pid, signal.SIGKILL)

    def close(self) -> None:
        self.station.close()


class OneShot:
    """`gcs goto ...`: a station for each request, which ends with it."""

    def __init__(self, policy: Path, folder: Path, *options: str) -> None:
        self._options = ["--link", LINK, "--policy", str(policy), "--log-dir", str(folder)]
        self._options += options

    def run(self, *words: str, options: bool = True) -> tuple[int, str]:
        """Any command: its exit code, and what it says."""
        asked = [*self._options, "--timeout", "60"] if options else []
        options_at = words.index("--") if "--" in words else len(words)
        command = [GCS, *words[:options_at], *asked, *words[options_at:]]
        done = subprocess.run(command, capture_output=True, text=True, timeout=LEG_S + 90.0)
        return done.returncode, done.stdout or done.stderr

    def ask(self, word: str, *arguments: float) -> str:
        """A word with numbers, and what became of it."""
        code, told = self.run(word, "--", *(f"{number:.8f}" for number in arguments))
        if code == 0:
            return "complete"
        return f"{'refused' if code in (5, 6) else 'not completed:'} {' '.join(told.split())}"

    def goto(self, goal: Vector) -> str:
        return self.ask("goto", *goal)

    def close(self) -> None:
        """Nothing of it runs."""


class Bridge:
    """pymavlink through `gcs bridge`; what the client may do is in tests/clients/scripts."""

    def __init__(self, policy: Path, folder: Path, kind: Kind) -> None:
        command = [GCS, "bridge", "--vehicle", LINK, "--client", f"udpin://127.0.0.1:{CLIENT_PORT}"]
        command += ["--policy", str(policy), "--log-dir", str(folder), "--plain"]
        with (folder / "bridge.txt").open("ab") as output:
            self._process = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT)
        script = importlib.import_module("tests.clients.scripts.bridge_pymavlink")
        self.peer: Any = script.Peer(f"udpout:127.0.0.1:{CLIENT_PORT}", kind.personality)
        try:
            self._greet()
        except BaseException:
            self.close()
            raise

    def _greet(self) -> None:
        """As the script's own `connect`, but for a vehicle that is in the air, away from home."""
        peer = self.peer
        peer.wait("HEARTBEAT", lambda heard: heard.get_srcComponent() == 1)
        if peer.autopilot == "ardupilot":
            peer.link.mav.request_data_stream_send(1, 1, 0, 10, 1)
        peer.wait("GLOBAL_POSITION_INT", lambda fix: fix.lat != 0)
        peer.long(512, 242)
        home = peer.wait("HOME_POSITION")
        peer.home = (home.latitude / 1e7, home.longitude / 1e7)
        peer.sea_m = home.altitude / 1e3

    def goto_from_home(self, goal: Vector) -> str:
        """DO_REPOSITION, which is acknowledged at once."""
        east, north, up = goal
        ack = self.peer.goto(north, east, up)
        return "accepted" if ack.result == 0 else f"refused {ack.result} {self.peer.last_text()}"

    def close(self) -> None:
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(20.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self.peer.link.close()
