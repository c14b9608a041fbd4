"""What the requests of every subject stand on.

A method returns when its request is complete, or raises Refused or NotCompleted; with `wait=False`
it returns as soon as the request is accepted.  `timeout_s` is how long is waited, None: for ever;
what is not over by then goes on.  A wrong argument is a BadArgument, and nothing is asked for.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

from gcs import ipc
from gcs.operator.operation import Operation


class Asks(ABC):
    """Whoever can ask; `Station` is one."""

    @abstractmethod
    def request(self, ask: ipc.Ask, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Any request (`gcs.ipc.Ask`): until it is complete, or with `wait=False` accepted."""
