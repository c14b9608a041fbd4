"""How long from a key to the screen: `python tools/key_to_screen.py [KEYS]`, in a real terminal.

Starts `gcs fly --sim` in a pseudo-terminal of 80x24 and of 200x60, takes off, and presses arrow
keys while the vehicle flies.  A key counts as shown when the bytes with the new pending goal have
been read from the terminal.  Prints milliseconds.
"""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import termios
import time

SIZES = ((80, 24), (120, 40), (200, 60))
ESCAPES = re.compile(rb"\x1b\[[0-9;?]*[ -/]*[@-~]")
PENDING = rb"pending E ([+-][0-9.]+)"
PATIENCE_S = 3.0
PAUSE_S = 0.23


class Screen:
    """A program in a terminal of its own."""

    def __init__(self, argv: list[str], columns: int, rows: int) -> None:
        self.fd, end = pty.openpty()
        fcntl.ioctl(end, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        env = {**os.environ, "TERM": "xterm-256color", "COLORTERM": "truecolor"}
        self.process = subprocess.Popen(
            argv, stdin=end, stdout=end, stderr=end, env=env, start_new_session=True
        )
        os.close(end)
        self._seen = b""

    def press(self, keys: bytes) -> None:
        os.write(self.fd, keys)

    def until(self, wanted: bytes, within_s: float = PATIENCE_S) -> float:
        """Seconds until this pattern is on the screen; inf if it does not come."""
        start_s = time.perf_counter()
        self._seen = b""
        while (left_s := start_s + within_s - time.perf_counter()) > 0:
            if not select.select([self.fd], [], [], left_s)[0]:
                break
            self._seen += os.read(self.fd, 65536)
            if re.search(wanted, ESCAPES.sub(b"", self._seen)):
                return time.perf_counter() - start_s
        return float("inf")

    def rest(self, for_s: float) -> None:
        """Read on meanwhile, as every terminal does: else the next key waits for a full pipe."""
        self.until(rb"(?!)", for_s)

    def last(self, pattern: bytes) -> bytes:
        """What the pattern's group was when it was read last."""
        found: list[bytes] = re.findall(pattern, ESCAPES.sub(b"", self._seen))
        return found[-1]

    def end(self) -> None:
        self.process.send_signal(signal.SIGTERM)
        while self.process.poll() is None:
            if select.select([self.fd], [], [], 0.1)[0]:
                try:
                    os.read(self.fd, 65536)
                except OSError:
                    break
        self.process.wait()


def measured(columns: int, rows: int, keys: int) -> list[float]:
    """Seconds of each key, in flight."""
    with tempfile.TemporaryDirectory() as logs:
        argv = [sys.executable, "-m", "gcs", "fly", "--sim", "--log-dir", logs]
        screen = Screen(argv, columns, rows)
        try:
            assert screen.until(b"GROUNDED", 30.0) < 30.0, "no vehicle on the ground"
            screen.rest(3.0)
            screen.press(b"m")
            assert screen.until(b"arm: complete", 10.0) < 10.0, "not armed"
            screen.press(b"t")
            assert screen.until(b"takeoff 1.5: complete", 20.0) < 20.0, "not up"
            screen.press(b"x\x1b[C")
            screen.until(PENDING)
            took, shown = [], screen.last(PENDING)
            screen.rest(1.0)
            for n in range(keys):
                right = n // 8 % 2 == 0
                screen.press(b"\x1b[C" if right else b"\x1b[D")
                if n == 4:
                    screen.press(b"\r")  # the vehicle flies while the keys are pressed
                wanted = rb"pending E (?!" + re.escape(shown) + rb")([+-][0-9.]+)"
                took.append(screen.until(wanted))
                shown = screen.last(PENDING)
                screen.rest(PAUSE_S)
            return took
        finally:
            screen.end()


def main() -> None:
    keys = int(sys.argv[1]) if len(sys.argv) > 1 else 60
    for columns, rows in SIZES:
        took = sorted(1e3 * each for each in measured(columns, rows, keys))
        p50, p95 = statistics.median(took), took[int(0.95 * (len(took) - 1))]
        told = f"p50 {p50:.0f} ms, p95 {p95:.0f} ms, most {took[-1]:.0f} ms"
        print(f"{columns}x{rows}: {told}", flush=True)


if __name__ == "__main__":
    main()
