"""The control line of `vehicle-sim --control`: one JSON object a line, for tests.

    {"id": 1, "do": "fault", "kind": "gps_lost", "keys": {}, "vehicle": 1}   -> {"id": 1}
    {"id": 2, "do": "mend", "kind": "gps_lost", "keys": {}, "vehicle": 1}    -> {"id": 2}
    {"id": 3, "do": "truth", "vehicle": 1}                  -> {"id": 3, "truth": {...}}
    anything else                                           -> {"id": 4, "error": "why not"}

Kinds and keys are those of a fault file; a fault without a vehicle is injected into all of them.
One that is not there is not mended.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Final, Protocol

from vehicle_sim.autopilot.interface import Truth
from vehicle_sim.simulation.fault_script import AnyFault, FaultFileError, fault_of

LINE_MAX: Final = 65_536


class Stage(Protocol):
    """What the control line can see and do."""

    def truth(self, system: int) -> Truth | None:
        """None = no such vehicle."""
        ...

    def inject(self, fault: AnyFault, system: int | None) -> bool:
        """False = no such vehicle, or no such link."""
        ...

    def faults(self, system: int | None) -> list[AnyFault]:
        """Those that are there: of a vehicle, or (None) of any, and of the links."""
        ...


class _WrongError(Exception):
    """A line that cannot be carried out; the message says why."""


def answer(line: bytes, stage: Stage) -> bytes:
    """The answer to one line, a line too.  Never raises."""
    number: object = None
    try:
        asked = _object(line)
        number = asked.get("id")
        answer = _carry_out(asked, stage)
    except (_WrongError, FaultFileError) as wrong:
        answer = {"error": str(wrong)}
    return json.dumps({"id": number, **answer}).encode() + b"\n"


def _object(line: bytes) -> dict[str, object]:
    try:
        asked = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise _WrongError(f"no JSON: {error}") from error
    if not isinstance(asked, dict):
        raise _WrongError("a line is one JSON object")
    return asked


def _carry_out(asked: dict[str, object], stage: Stage) -> dict[str, object]:
    system = asked.get("vehicle")
    if system is not None and (isinstance(system, bool) or not isinstance(system, int)):
        raise _WrongError("vehicle: must be a system id")
    match asked.get("do"):
        case "fault" | "mend" as do:
            keys = asked.get("keys", {})
            if not isinstance(keys, dict):
                raise _WrongError("keys: must be an object")
            kind = str(asked.get("kind"))
            given = fault_of(kind, keys, "fault")
            fault = given.ended() if do == "mend" else given
            if fault is None:
                raise _WrongError(f"{kind}: does not last, and cannot be mended")
            present = stage.faults(system)
            known = system is None or stage.truth(system) is not None
            if do == "mend" and known and fault not in [each.ended() for each in present]:
                there = "; ".join(each.described() for each in present) or "none"
                raise _WrongError(f"{kind}: no such fault to mend; there are: {there}")
            if not stage.inject(fault, system):
                raise _WrongError(f"vehicle {system}: no such vehicle or link")
            return {}
        case "truth":
            truth = stage.truth(system if system is not None else 1)
            if truth is None:
                raise _WrongError(f"vehicle {system}: no such vehicle")
            return {"truth": asdict(truth)}
        case other:
            raise _WrongError(f"do: must be fault, mend or truth, is {other!r}")


class Lines:
    """Bytes from a pipe, cut into lines; a line beyond all measure is dropped."""

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> list[bytes]:
        *lines, self._rest = (self._rest + data).split(b"\n")
        if len(self._rest) > LINE_MAX:
            self._rest = b""
        return [line for line in lines if line.strip()]
