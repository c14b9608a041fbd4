"""The Python library for asyncio: `gcs.aconnect`, and what it gives.

The types are in `async_station.pyi`, which is made of the classes that wait:
`python -m tests.unit.async_stub` writes it anew.
"""

from __future__ import annotations

import functools

from gcs.operator.async_proxy import asynchronous, in_thread
from gcs.operator.connect import connect
from gcs.operator.operation import Operation
from gcs.operator.station import Station
from gcs.operator.stream import Stream

AsyncOperation = asynchronous(
    Operation, "AsyncOperation", "As `Operation`; `wait` and `stop` are awaited."
)
AsyncStream = asynchronous(
    Stream, "AsyncStream", "As `Stream`, in an `async with` block; every method is awaited."
)
AsyncStation = asynchronous(
    Station,
    "AsyncStation",
    """As `Station`, in an `async with` block; what may wait is awaited.

    Cancelling a task stops its waiting, and aborts nothing by itself: what was asked for goes on.
    `await station.abort()`, or `await operation.stop()`, stops the vehicle.  Leaving the block
    holds it, as leaving a `with` block does.
    """,
)


class Connecting:
    """What `aconnect` returns: for `async with`, or to be awaited."""

    def __init__(self, *args, **named) -> None:
        self._call = functools.partial(connect, *args, **named)
        self._station = None

    async def _connected(self):
        self._station = AsyncStation(await in_thread(self._call, Station.close))
        return self._station

    def __await__(self):
        return self._connected().__await__()

    async def __aenter__(self):
        return await self._connected()

    async def __aexit__(self, *_) -> None:
        await self._station.close()


@functools.wraps(connect)
def aconnect(*args, **named) -> Connecting:
    return Connecting(*args, **named)


aconnect.__module__ = __name__
