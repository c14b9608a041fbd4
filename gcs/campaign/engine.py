"""Flights on Dask: local processes of our own, or the workers of a scheduler that runs.

A task is the whole plan as bytes, the number of a flight and its inputs; so whoever takes it over
from a worker that died needs nothing else.  As many tasks as `WINDOW` a worker are out at a time:
the memory of a campaign does not grow with its flights.
"""

from __future__ import annotations

import logging
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias

from gcs.campaign.case import ERROR, Row, Value
from gcs.campaign.plan import Plan, decode, encode

if TYPE_CHECKING:
    from distributed import Client

WINDOW: Final = 4
RETRIES: Final = 5
CONNECT_WAIT_S: Final = 30.0

SPARING: Final = {
    "distributed.logging.distributed": "critical",
    "distributed.worker.memory.pause": False,  # a flight ends before anything could be spilled
    "distributed.worker.memory.spill": False,
    "distributed.worker.memory.target": False,
    "distributed.worker.profile.enabled": False,  # a hundred looks a second at what is flown
    "distributed.admin.system-monitor.interval": "10s",
    "distributed.admin.system-monitor.gil.enabled": False,
}
"""What Dask watches beside, nobody looks at here."""
DEAF: Final = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)"
"""A Ctrl-C is for whoever started the campaign, which ends its workers in order."""

Flight: TypeAlias = "tuple[int, dict[str, Value]]"
"""Its number and its inputs."""
Flown: TypeAlias = "tuple[Row, bytes]"
"""The row, and the record where one was asked for."""


class NoWorkersError(Exception):
    """The scheduler cannot be reached, or has no worker."""


@lru_cache(maxsize=2)
def _plan(data: bytes) -> Plan:
    return decode(data)


def fly_one(plan: bytes, number: int, inputs: dict[str, Value], recorded: bool) -> Flown:
    """What a worker does."""
    from gcs.campaign.flight import fly

    case = _plan(plan).case(number, inputs)
    if not recorded:
        return fly(case), b""
    with tempfile.TemporaryDirectory() as folder:
        record = Path(folder) / f"{number}.mcap"
        row = fly(case, record)
        return row, record.read_bytes() if record.exists() else b""


@contextmanager
def workers(count: int, scheduler: str) -> Iterator[Client]:
    """Processes that end with the block; or those of `scheduler`, which go on.

    Raises NoWorkersError.
    """
    import dask
    from distributed import Client, LocalCluster

    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    with dask.config.set(SPARING):
        if scheduler:
            try:
                client = Client(scheduler, timeout=CONNECT_WAIT_S)
                client.wait_for_workers(1, timeout=CONNECT_WAIT_S)
            except (OSError, TimeoutError, ValueError) as error:
                raise NoWorkersError(f"{scheduler}: {error}") from error
            with client:
                yield client
            return
        with (
            tempfile.TemporaryDirectory() as folder,
            LocalCluster(
                n_workers=count,
                threads_per_worker=1,
                host="127.0.0.1",
                dashboard_address="127.0.0.1:0",
                local_directory=folder,
                silence_logs=logging.CRITICAL,
                preload=DEAF,
            ) as cluster,
            Client(cluster) as client,
        ):
            yield client


def flown(
    client: Client, plan: Plan, flights: Iterable[Flight], *, recorded: bool = False
) -> Iterator[Flown]:
    """As they end, in no order.  A flight that no worker survives is a row of its own."""
    from distributed import as_completed

    data = encode(plan)
    waiting = iter(flights)
    inputs_of: dict[str, Flight] = {}

    def submit(flight: Flight) -> None:
        number, inputs = flight
        key = f"{'record' if recorded else 'flight'}-{plan.digest}-{number}"
        inputs_of[key] = flight
        arguments = (data, number, inputs, recorded)
        ended.add(client.submit(fly_one, *arguments, key=key, retries=RETRIES))

    ended = as_completed()
    for _ in range(WINDOW * max(1, len(client.scheduler_info()["workers"]))):
        if (flight := next(waiting, None)) is not None:
            submit(flight)
    for future in ended:
        number, inputs = inputs_of.pop(future.key)
        error = future.exception()
        if (flight := next(waiting, None)) is not None:
            submit(flight)
        if error is None:
            yield future.result()
        else:
            yield Row(id=number, inputs=inputs, outcome=ERROR, error=f"no worker: {error}"), b""
