"""How the screen is left: a question while armed, a good-bye to the station, and the terminal as it
was."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
import threading
from typing import Final

from textual.app import App

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.operator.chosen_vehicle import ListenedVehicle
from gcs.operator.client import Listened
from gcs.tui.hang_up import on_hang_up
from gcs.tui.result import SessionResult
from gcs.tui.scene import Scene

LEAVE_WAIT_S: Final = 8.0
RESTORE_WAIT_S: Final = 5.0
"""For the screen to be given back.  A terminal that has closed, or that nobody reads, blocks every
write to it, and with it the loop: then the process ends by SIGALRM."""


class LeavingApp(App[None]):
    """An operator's screen on a station, as far as it begins and ends."""

    def __init__(self, connection: Listened) -> None:
        super().__init__()
        self._connection = ListenedVehicle(connection)
        self.scene = Scene()
        self.interrupted = False
        self._leaving = False
        self._station_gone = threading.Event()

    @property
    def result(self) -> SessionResult:
        """How it ended, once `run` has returned; waits for the station process to end."""
        self._end_within(0.0)
        talk = self.scene.talk
        if talk.ended is None:
            talk.told(self._connection.close())
        return SessionResult(talk, self._leaving)

    @property
    def heard_vehicle(self) -> bool:
        """Whether any vehicle was heard at all."""
        return self.scene.heard_vehicle

    def _leave_on_signals(self) -> None:
        """A signal, and a terminal that closes, leave in good order."""
        if self.is_headless or sys.platform == "win32":
            return
        loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            loop.add_signal_handler(number, self._leave, number.name)
            # The loop hears of it through a pipe; this runs even while it hangs in a write.
            signal.signal(number, lambda *_: self._end_within(LEAVE_WAIT_S + RESTORE_WAIT_S))
        on_hang_up(sys.__stdin__.fileno() if sys.__stdin__ else 0, self._leave_without_screen)

    def _leave_without_screen(self) -> None:
        """The terminal has closed: the station holds the vehicle, and this process ends with it.

        In a thread of its own.  The loop may be stuck in a write for ever.
        """
        self._connection.send(ipc.Leave("the terminal has closed"))
        self._station_gone.wait(LEAVE_WAIT_S)
        os._exit(ExitCode.INTERRUPTED)

    def action_leave(self) -> None:
        """Leave; with the vehicle armed the first time only ask."""
        question = self.query_one("#question")
        if self.scene.left_armed and not question.display and not self._leaving:
            question.display = True
        else:
            self._leave("quit")

    def _answered(self, *, leave: bool) -> bool:
        """Close the question, with its answer; whether it was open."""
        question = self.query_one("#question")
        asked = bool(question.display)
        question.display = False
        if asked and leave:
            self._leave("quit")
        return asked

    def _leave_without_vehicle(self) -> None:
        if not self.heard_vehicle:
            self._leave("no vehicle heard")

    def _leave(self, reason: str) -> None:
        """Once: say good-bye, show it, and exit when the station has ended, or after 8 s."""
        if self.scene.talk.ended is not None:
            self._give_back()
        elif not self._leaving:
            self._leaving = True
            self._connection.send(ipc.Leave(reason))
            self.query_one("#farewell").display = True
            self.set_timer(LEAVE_WAIT_S, self._give_back)

    def _give_back(self) -> None:
        """Give the screen back, and end."""
        self._end_within(RESTORE_WAIT_S)
        self.exit()

    def _end_within(self, seconds: float) -> None:
        """End the process by SIGALRM then, unless another time (0: none) is set before."""
        if not self.is_headless and sys.platform != "win32":
            signal.setitimer(signal.ITIMER_REAL, seconds)
