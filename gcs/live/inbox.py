"""From the server's threads to the one that decides: bounded, and neither side ever waits.

The callbacks of the WebSocket server run on its own threads.  They put values here and return; a
call of a service waits for its answer, on the server's thread, and only as long as it may.
"""

from __future__ import annotations

import contextlib
import itertools
import queue
import socket
import threading
from collections import Counter, deque

from gcs.live.inputs import Called, Gone, Published
from gcs.live.services import Answer

MAX_ITEMS = 256
MAX_OF_A_VIEWER = 16
MAX_CALLS = 32
"""Threads of the server that wait for an answer at the same time."""

Item = Called | Published | Gone


class Inbox:
    """`fileno()` is readable when there is something to take."""

    def __init__(self) -> None:
        self._read, self._write = socket.socketpair()
        self._read.setblocking(False)
        self._write.setblocking(False)
        self._lock = threading.Lock()
        self._items: deque[Item] = deque()
        self._of_viewer: Counter[int] = Counter()
        self._answers: dict[int, queue.SimpleQueue[Answer]] = {}
        self._numbers = itertools.count(1)

    def fileno(self) -> int:
        return self._read.fileno()

    def put(self, item: Item) -> bool:
        """From any thread; False if there is no room for it.  That a viewer has gone always fits:
        there are no more of these than viewers that have come."""
        with self._lock:
            if not isinstance(item, Gone):
                too_many = self._of_viewer[item.viewer] >= MAX_OF_A_VIEWER
                if too_many or len(self._items) >= MAX_ITEMS:
                    return False
            self._items.append(item)
            self._of_viewer[item.viewer] += 1
        self.wake()
        return True

    def wake(self) -> None:
        """`fileno()` becomes readable; that it is already is as good."""
        with contextlib.suppress(BlockingIOError, OSError):
            self._write.send(b"!")

    def call(
        self, viewer: int, service: str, payload: bytes, *, watching: bool, wait_s: float
    ) -> Answer:
        """Hand a call on and wait for its answer."""
        answers: queue.SimpleQueue[Answer] = queue.SimpleQueue()
        with self._lock:
            number = next(self._numbers)
            busy = len(self._answers) >= MAX_CALLS
            if not busy:
                self._answers[number] = answers
        if busy:
            return Answer(False, "too many viewers call at once", "BUSY")
        try:
            if not self.put(Called(viewer, number, service, payload, watching)):
                return Answer(False, "too many viewers ask at once", "BUSY")
            return answers.get(timeout=wait_s)
        except queue.Empty:
            return Answer(False, f"no answer within {wait_s:g} s", "NO_ANSWER")
        finally:
            with self._lock:
                del self._answers[number]

    def answer(self, call: int, answer: Answer) -> None:
        """Wake whoever waits for it; nobody may, any more."""
        with self._lock:
            answers = self._answers.get(call)
        if answers is not None:
            answers.put(answer)

    def take(self) -> list[Item]:
        """All that came, in order."""
        with contextlib.suppress(BlockingIOError):
            self._read.recv(4_096)
        with self._lock:
            items, self._items = list(self._items), deque()
            self._of_viewer.clear()
        return items

    def close(self) -> None:
        self._read.close()
        self._write.close()
