"""Flights in real time: each in a process of its own, in a private network where that is allowed.

So ports are free however many fly at a time, and nobody else hears the vehicle.  A flight and all
that it started are one group of processes, which ends when the pipe to it closes: nothing is left
of it, whatever ends whoever flies.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import ExitStack, closing
from pathlib import Path
from queue import SimpleQueue
from typing import IO, Final

import msgspec

from gcs.campaign.case import ERROR, STARVED, Case, Row
from gcs.campaign.flight import START_NS, fly
from gcs.campaign.real_autopilot import private_network
from gcs.campaign.simulators import real_time_factory

GUARD: Final = 'exec 3<&0; (read -r _; kill 0) <&3 & "$@" </dev/null 3<&-; kill 0'
"""Runs a command until that ends, or until nobody holds the other end of standard input."""
NO_NETWORK: Final = "only one at a time: this system allows no private network (unshare -n)"


class NoNetworkError(Exception):
    """Several at a time would hear each other."""


def fly_one(case: Case, record: Path) -> Row:
    """In this process and this network."""
    table = {**case.table, "start_ns": START_NS}
    with closing(real_time_factory(case.simulator)(table)) as simulator:
        row = fly(case, record, simulator)
        if row.outcome != ERROR and simulator.starved:
            row = msgspec.structs.replace(row, outcome=STARVED, error=simulator.starved)
    return row


def fly_apart(cases: Sequence[Case], at_once: int, records: Path) -> Iterator[Row]:
    """As they end; each is recorded, as it cannot be flown again.  Raises NoNetworkError."""
    network = private_network()
    if network is None and at_once > 1:
        raise NoNetworkError(NO_NETWORK)
    numbers: SimpleQueue[int] = SimpleQueue()
    for number in range(at_once):
        numbers.put(number)
    with ExitStack() as ends, ThreadPoolExecutor(at_once) as pool:

        def one(case: Case) -> Row:
            number = numbers.get()
            try:
                return _in_process(case, number, network or [], records, ends)
            finally:
                numbers.put(number)

        try:
            for future in as_completed([pool.submit(one, case) for case in cases]):
                yield future.result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
            ends.close()


def _in_process(
    case: Case, number: int, network: Sequence[str], records: Path, ends: ExitStack
) -> Row:
    case = msgspec.structs.replace(case, table={**case.table, "instance": number})
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        asked, became = Path(folder) / "case", Path(folder) / "row"
        asked.write_bytes(msgspec.msgpack.encode(case))
        record = records / f"{case.id:06d}.mcap"
        words = [sys.executable, "-m", __name__, str(asked), str(became), str(record)]
        process = subprocess.Popen(
            ["sh", "-c", GUARD, "sh", *network, *words],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            process_group=0,
        )
        assert process.stdin is not None
        assert process.stderr is not None
        ends.callback(_closed, process.stdin)
        with process:
            said = process.stderr.read().decode(errors="replace")
        if became.exists():
            return msgspec.msgpack.decode(became.read_bytes(), type=Row)
        return Row(id=case.id, inputs=case.inputs, outcome=ERROR, error=said[-2000:])


def _closed(pipe: IO[bytes]) -> None:
    pipe.close()


def main() -> None:
    asked, became, record = map(Path, sys.argv[1:])
    case = msgspec.msgpack.decode(asked.read_bytes(), type=Case)
    became.write_bytes(msgspec.msgpack.encode(fly_one(case, record)))


if __name__ == "__main__":
    main()
