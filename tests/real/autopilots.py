"""Real autopilots, each with its own simulation: found, started in a private network, ended.

docs/real.md says how to name one's own.
"""

import os
import shlex
import signal
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from gcs.campaign.real_autopilot import private_network

CHECKOUT = Path(__file__).resolve().parents[2]
GROUND_PORT = 14550  # where either autopilot sends to, for ground stations
ONBOARD_PORT = 14540  # PX4, for programs on board; ArduCopter by --serial1


@dataclass(frozen=True)
class Kind:
    name: str
    variable: str
    personality: str  # as the policy names its tables
    hold_mode: str
    hold_custom_mode: int
    guided_custom_mode: int


PX4 = Kind("px4", "MAVGATE_PX4", "px4", "AUTO.LOITER", 4 << 16 | 3 << 24, 6 << 16)
ARDUCOPTER = Kind("arducopter", "MAVGATE_ARDUCOPTER", "ardupilot", "BRAKE", 17, 4)
KINDS = {kind.name: kind for kind in (PX4, ARDUCOPTER)}


def command(kind: Kind) -> list[str] | None:
    """What starts it but for the folder and the port, or None where there is none."""
    named = os.environ.get(kind.variable)
    if named is None:
        run = CHECKOUT.parent / "shared" / "autopilots" / "run"
    elif Path(named).is_dir():
        run = Path(named) / "run"
    else:
        return shlex.split(named)
    return [str(run), kind.name] if run.is_file() else None


def start(kind: Kind, folder: Path) -> subprocess.Popen[bytes]:
    """Starts it in this network; what it prints goes to `folder/output.txt`."""
    found = command(kind)
    if found is None:
        raise SystemExit(f"{kind.name}: none is there; {kind.variable} names one (docs/real.md)")
    folder.mkdir(parents=True, exist_ok=True)
    if kind is PX4:
        arguments = ["0"]
    else:
        second = f"udpclient:127.0.0.1:{ONBOARD_PORT}"
        arguments = [str(GROUND_PORT), "--serial1", second]
    with (folder / "output.txt").open("wb") as output:
        return subprocess.Popen(
            [*found, str(folder), *arguments],
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            process_group=0,
        )


def end(process: subprocess.Popen[bytes]) -> None:
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGTERM)
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def in_private_network(module: str, arguments: list[str]) -> list[str] | None:
    """The command that runs a module of the tests in a network of its own, or None: not allowed."""
    network = private_network()
    return network and [*network, sys.executable, "-m", module, *arguments]
