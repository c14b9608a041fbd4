"""Finished logs: columns and import, beside pymavlink, mcap's reader and mavio on the same files.

Run: python -m tools.bench_logfile [rounds]

The log is made here: an hour of a vehicle that sends as much as PX4 does to a program on board,
1,000,000 messages of 12 kinds in MAVLink 2.  Each figure is the median of the rounds' ratios; in a
round both sides run one after the other, each in a process of its own that does nothing else:

  whole process   from the start of Python to its end
  within          what the process says that the work took, without start and imports

mavio runs where `make bench` has installed it (.clients/mavio), on a quarter of the log.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np
from pymavlink.dialects.v20 import all as dialect

MESSAGES = 1_000_000
SHARE = 4
START_US = 1_767_225_600_000_000
HZ = 280
MAVIO = Path(__file__).parents[2] / ".clients" / "mavio" / "bin" / "mavio"
NAME = "LOCAL_POSITION_NED"

OUR_COLUMNS = """
import sys, time, gcs.record
columns = gcs.columns
began = time.perf_counter()
found = columns(sys.argv[1], sys.argv[2])
print(len(found), time.perf_counter() - began)
"""
OUR_IMPORT = "import sys; from gcs.__main__ import main; sys.exit(main())"
PYMAVLINK_COLUMNS = """
import sys, time
import numpy as np
from pymavlink import mavutil
began = time.perf_counter()
log = mavutil.mavlogfile(sys.argv[1])
rows = []
while (m := log.recv_match(type=sys.argv[2])) is not None:
    rows.append((m._timestamp, m.time_boot_ms, m.x, m.y, m.z, m.vx, m.vy, m.vz))
found = np.array(rows)
print(len(found), time.perf_counter() - began)
"""
PYMAVLINK_READ = """
import sys, time
from pymavlink import mavutil
began = time.perf_counter()
log = mavutil.mavlogfile(sys.argv[1])
count = 0
while log.recv_msg() is not None:
    count += 1
print(count, time.perf_counter() - began)
"""
MCAP_COLUMNS = """
import struct, sys, time
import numpy as np
from mcap.reader import make_reader
began = time.perf_counter()
unpack = struct.Struct("<13xI6f").unpack_from
with open(sys.argv[1], "rb") as file:
    messages = make_reader(file).iter_messages(topics=["/mavlink/1/1/" + sys.argv[2]])
    rows = [(message.log_time, *unpack(message.data)) for _, _, message in messages]
found = np.array(rows)
print(len(found), time.perf_counter() - began)
"""


class Run(NamedTuple):
    """Seconds; `found` is how many messages the program says that it found."""

    whole: float
    within: float
    found: int


def frames() -> list[bytes]:
    """One second of a vehicle, at the rates of rates_px4_14540 (rounded)."""
    sender = dialect.MAVLink(None, srcSystem=1, srcComponent=1)
    rng = np.random.default_rng(1)
    made: list[tuple[float, bytes]] = []

    def add(hz: int, message: object) -> None:
        for number in range(hz):
            sender.seq = int(rng.integers(256))
            made.append((number / hz, bytes(message.pack(sender))))  # type: ignore[attr-defined]

    x, y, z, u, v, w = rng.uniform(-50, 50, 6).tolist()
    add(50, sender.attitude_encode(1, x, y, z, u, v, w))
    add(50, sender.attitude_quaternion_encode(1, x, y, z, u, v, w, x))
    add(30, sender.local_position_ned_encode(1, x, y, z, u, v, w))
    add(30, sender.odometry_encode(1, 1, 12, x, y, z, [x, y, z, u], *([x] * 6), [x] * 21, [y] * 21))
    add(50, sender.highres_imu_encode(1, x, y, z, u, v, w, x, y, z, 1.0, 2.0, 3.0, 4.0, 65535))
    add(30, sender.global_position_int_encode(1, 473977420, 85455940, 490_000, 2_000, 1, 2, 3, 4))
    add(10, sender.servo_output_raw_encode(1, 0, 1500, 1500, 1500, 1500, 0, 0, 0, 0))
    add(10, sender.vfr_hud_encode(x, y, 90, 50, z, u))
    add(10, sender.position_target_local_ned_encode(1, 1, 0, x, y, z, u, v, w, x, y, z, u, v))
    add(5, sender.sys_status_encode(0, 0, 0, 100, 15_200, 100, 77, 0, 0, 0, 0, 0, 0))
    add(4, sender.statustext_encode(6, b"a text of the vehicle"))
    add(1, sender.heartbeat_encode(2, 12, 209, 0x60000, 4))
    return [frame for _, frame in sorted(made)]


def write_log(path: Path, count: int) -> None:
    """The second again and again, `count` frames, each with its own time."""
    second = frames()
    assert len(second) == HZ
    stamped = [b"\0" * 8 + frame for frame in second]
    block = np.frombuffer(b"".join(stamped), np.uint8).copy()
    starts = np.cumsum([0] + [len(each) for each in stamped[:-1]])
    with open(path, "wb") as file:
        for number in range(0, count, HZ):
            stamps = START_US + (number + np.arange(HZ, dtype=np.int64)) * 1_000_000 // HZ
            places = starts[:, None] + np.arange(8)
            block[places] = stamps.astype(">u8").view(np.uint8).reshape(-1, 8)
            left = count - number
            end = len(block) if left >= HZ else int(starts[left])
            file.write(block[:end].tobytes())


def run(code: str, *args: object) -> Run:
    return _run([sys.executable, "-c", code, *map(str, args)])


def _run(command: list[str]) -> Run:
    began = time.perf_counter()
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    whole = time.perf_counter() - began
    words = done.stdout.split()
    try:
        return Run(whole, float(words[1]), int(words[0]))
    except (ValueError, IndexError):
        return Run(whole, whole, 0)


def report(what: str, ours: list[float], theirs: list[float], count: int) -> None:
    ratio = statistics.median(b / a for a, b in zip(ours, theirs, strict=True))
    mine, other = statistics.median(ours), statistics.median(theirs)
    print(
        f"{what:48} {mine:6.2f} s ({1e6 * mine / count:5.2f} us a message),"
        f" peer {other:6.2f} s: {ratio:6.1f}x",
        flush=True,
    )


def our_import(source: Path, target: Path) -> float:
    target.unlink(missing_ok=True)
    return run(OUR_IMPORT, "log", "import", source, "-o", target).whole


def main(rounds: int) -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        log, small, record = folder / "log.tlog", folder / "small.tlog", folder / "log.mcap"
        write_log(log, MESSAGES)
        write_log(small, MESSAGES // SHARE)
        columns: list[tuple[Run, Run]] = []
        imports: list[tuple[float, float]] = []
        records: list[tuple[Run, Run]] = []
        mavio: list[tuple[float, float]] = []
        for _ in range(rounds):
            columns.append((run(OUR_COLUMNS, log, NAME), run(PYMAVLINK_COLUMNS, log, NAME)))
            assert columns[-1][0].found == columns[-1][1].found
            imports.append((our_import(log, record), run(PYMAVLINK_READ, log).whole))
            records.append((run(OUR_COLUMNS, record, NAME), run(MCAP_COLUMNS, record, NAME)))
            assert records[-1][0].found == records[-1][1].found
            if MAVIO.exists():
                mavio.append((our_import(small, record), _mavio(small, folder / "mavio.mcap")))
        report(
            "tlog to columns, whole process (pymavlink)",
            [a.whole for a, _ in columns],
            [b.whole for _, b in columns],
            MESSAGES,
        )
        report(
            "MCAP to columns, within (mcap's reader)",
            [a.within for a, _ in records],
            [b.within for _, b in records],
            MESSAGES,
        )
        report(
            "import of a tlog, whole process (pymavlink reads)",
            [a for a, _ in imports],
            [b for _, b in imports],
            MESSAGES,
        )
        if mavio:
            report(
                "import of a tlog, whole process (mavio --raw)",
                [a for a, _ in mavio],
                [b for _, b in mavio],
                MESSAGES // SHARE,
            )
        else:
            print(f"mavio is not in {MAVIO}")


def _mavio(source: Path, target: Path) -> float:
    target.unlink(missing_ok=True)
    return _run([str(MAVIO), "convert", "--raw", str(source), str(target)]).whole


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 3)
