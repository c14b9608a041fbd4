"""How tests of real programs wait: for what must come, as long as a slow machine may need.

What has to come soon is measured otherwise: in the rhythm of the program that does it, in the time
of the vehicle, or less what the machine kept it waiting (machine.py).
"""

from __future__ import annotations

import socket
import time
from collections.abc import Callable
from pathlib import Path

from gcs.resources import policy_path

PATIENT_S = 60.0
"""So long a test waits for anything that must come."""
PATIENT_POLICY = str(Path(__file__).with_name("patient.toml"))
RECEIVE_BUFFER_BYTES = 4 << 20


def until(condition: Callable[[], bool], what: str, timeout_s: float = PATIENT_S) -> None:
    """Waits until the condition holds; fails with `what` it was."""
    end = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < end, f"not within {timeout_s:g} s: {what}"
        time.sleep(0.02)


def hold_much(receiver: socket.socket) -> None:
    """What comes for seconds is kept: a test that the machine stops reads it afterwards."""
    receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, RECEIVE_BUFFER_BYTES)


def patient(policy: str, folder: Path) -> str:
    """A shipped policy with the patience of `patient.toml`: a file in the folder."""
    shipped = policy_path(policy).read_text(encoding="utf-8")
    keys, tables, rest = Path(PATIENT_POLICY).read_text(encoding="utf-8").partition("\n[")
    _, _, ages = keys.partition('name = "patient"\n')
    name = f'name = "{policy}"\n'
    assert name in shipped
    made = folder / f"patient_{policy}.toml"
    made.write_text(f"{shipped.replace(name, name + ages)}{tables}{rest}", encoding="utf-8")
    return str(made)
