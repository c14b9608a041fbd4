"""A terminal of the test's own: a program in a pty, real keys, and the bytes of its screen."""

from __future__ import annotations

import os
import re
import struct
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress

if sys.platform != "win32":
    import fcntl
    import pty
    import termios

from tests.system.patience import PATIENT_S, until
from tests.system.programs import alive, all_gone, family

ROWS, COLUMNS = 50, 160
SIZES = ("LINES", "COLUMNS")
"""A terminal's size is asked of it, not of these."""
LONGEST_ESCAPE = 64

_ON_A_TERMINAL = (
    "import fcntl, os, sys, termios;"
    "sys.argv[1] == 'controlling' and fcntl.ioctl(0, termios.TIOCSCTTY, 0);"
    "os.execv(sys.argv[2], sys.argv[2:])"
)
"""Makes the pty the controlling terminal, as a login does, and becomes the program."""

_ESCAPE = re.compile(rb"\x1b(?:\[[0-?]*[ -/]*[@-~]|\][^\x07\x1b]*(?:\x07|\x1b\\)|[@-Z\\-_])")


def environment() -> dict[str, str]:
    """For a program on a terminal."""
    kept = {name: value for name, value in os.environ.items() if name not in SIZES}
    return {**kept, "TERM": "xterm-256color"}


class Terminal:
    """`seen` is every byte that the program has written; `text` is what of it can be read."""

    def __init__(self, command: Sequence[str], *, controlling: bool = True) -> None:
        """`controlling`: a hang-up is told by a signal as well."""
        self._screen, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
        self._slave = slave
        self._controlling = controlling
        self.settings_before = self.settings
        self.process = subprocess.Popen(
            [
                sys.executable,
                "-c",
                _ON_A_TERMINAL,
                "controlling" if controlling else "other",
                *command,
            ],
            stdin=slave,
            stdout=slave,
            stderr=slave,
            start_new_session=True,
            env=environment(),
        )
        self.seen = bytearray()
        self.text = ""
        self._since = 0
        self._hung_up = False
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        rest = b""
        with suppress(OSError):  # what a pty answers once its other side is closed
            while not self._hung_up and (data := os.read(self._screen, 65_536)):
                self.seen += data
                ready = rest + data
                # A sequence may come in two pieces: what could be its beginning waits.
                last = ready.rfind(b"\x1b", -LONGEST_ESCAPE)
                rest = ready[last:] if last >= 0 and not _ESCAPE.match(ready, last) else b""
                ready = ready.removesuffix(rest)
                self.text += _ESCAPE.sub(b"", ready).decode(errors="replace")

    @property
    def settings(self) -> list[object]:
        """As `stty -a` tells them."""
        return termios.tcgetattr(self._slave)

    def press(self, keys: str) -> None:
        self._since = len(self.text)
        os.write(self._screen, keys.encode())

    def shows(self, text: str) -> bool:
        """Whether it has been written since the last key."""
        return self.text.find(text, self._since) >= 0

    def until_text(self, *texts: str, timeout_s: float = PATIENT_S) -> None:
        until(lambda: all(map(self.shows, texts)), f"{texts} on screen", timeout_s)

    def until_either(self, *texts: str, timeout_s: float = PATIENT_S) -> str:
        """The first of the texts that shows."""
        until(lambda: any(map(self.shows, texts)), f"one of {texts} on screen", timeout_s)
        return next(filter(self.shows, texts))

    def hang_up(self) -> None:
        """Closes the terminal, as its window does; the program's next drawing is the last."""
        self._hung_up = True
        self._reader.join()
        os.close(self._screen)
        if not self._controlling:
            os.close(self._slave)

    def close(self) -> None:
        started = family(self.process.pid)
        try:
            until(lambda: self.process.poll() is not None, "the end of the program", 0.1)
        except AssertionError:
            self.process.kill()
        self.process.wait()
        try:
            until(lambda: all_gone(started), "the end of its processes")
        finally:
            for pid in filter(alive, started):
                os.kill(pid, 9)
            if self._controlling or not self._hung_up:
                os.close(self._slave)
            if not self._hung_up:
                self._reader.join()
                os.close(self._screen)


@contextmanager
def terminal(*command: str, controlling: bool = True) -> Iterator[Terminal]:
    """A program on a terminal, gone at the end with everything that it started."""
    made = Terminal(command, controlling=controlling)
    try:
        yield made
    finally:
        made.close()
