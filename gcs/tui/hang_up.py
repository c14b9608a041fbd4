"""Notices that the terminal of this process has closed, whatever else the process is stuck in.

A write to a terminal that has gone may wait for ever, and with it the loop of the screen and all
that it would do, a signal's handler included.  So this waits in a thread of its own.
"""

from __future__ import annotations

import os
import select
import sys
import threading
from collections.abc import Callable


def on_hang_up(fd: int, act: Callable[[], None]) -> None:
    """Call `act`, in a thread of its own, once the terminal of `fd` has closed.

    Not on Windows, which ends the programs of a console that closes.
    """
    if sys.platform != "win32" and os.isatty(fd):
        threading.Thread(target=_wait, args=(fd, act), name="hang-up", daemon=True).start()


def _wait(fd: int, act: Callable[[], None]) -> None:
    poll = select.poll()
    poll.register(fd, 0)  # a hang-up is told unasked, and nothing else here
    for _, events in poll.poll():
        if events & select.POLLHUP:
            act()
