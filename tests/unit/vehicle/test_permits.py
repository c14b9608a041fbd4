"""Motion leaves with a permit of this very moment, and from one place."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import gcs
from gcs.gate.effects import CommandKind, SendCommand
from gcs.gate.permit import Permit, issue
from gcs.protocol.effects import Address
from gcs.session.speedup_waits import Times
from gcs.vehicle.setpoints import setpoint
from gcs.vehicle.talk.commands import NEEDS_PERMIT, Commands
from tests.unit.station.vehicles import SECOND_NS, vehicle

PACKAGE = Path(gcs.__file__).parent


def calls_of(name: str) -> set[str]:
    """Files of the package that call `name` or `<module>.name`."""
    found = set()
    for path in PACKAGE.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)) if name in text else ():
            if isinstance(node, ast.Call):
                called = node.func
                word = getattr(called, "attr", None) or getattr(called, "id", None)
                if word == name:
                    found.add(path.relative_to(PACKAGE).as_posix())
    return found


def test_setpoints_are_made_in_one_file() -> None:
    assert calls_of("SetPositionTargetLocalNed") == {"vehicle/setpoints.py"}
    assert calls_of("SetPositionTargetGlobalInt") == set()
    assert calls_of("SetAttitudeTarget") == {"vehicle/setpoints.py"}


def test_permits_are_issued_in_one_file() -> None:
    assert calls_of("issue") == {"gate/machine/gate.py"}


def test_nobody_makes_a_permit_without_the_seal() -> None:
    with pytest.raises(PermissionError):
        Permit(object(), (0.0, 0.0, 0.0), None, 0, "forged")


def test_a_setpoint_leaves_with_a_permit_of_now_and_not_with_an_old_one() -> None:
    permit = issue((1.0, 2.0, -3.0), None, SECOND_NS, "a test")
    message = setpoint(vehicle(), permit, 0, SECOND_NS)
    assert (message.x, message.y, message.z) == (1.0, 2.0, -3.0)
    with pytest.raises(PermissionError):
        setpoint(vehicle(), permit, 0, SECOND_NS + 1)


@pytest.mark.parametrize("kind", [kind for kind in CommandKind if kind in NEEDS_PERMIT])
def test_a_command_that_moves_needs_a_permit(kind: CommandKind) -> None:
    with pytest.raises(PermissionError):
        Commands(Address(255, 190), Times()).send(SendCommand(1, kind, SECOND_NS), vehicle(), 0)


def test_what_needs_no_permit_moves_nothing() -> None:
    still = {
        CommandKind.HOLD,
        CommandKind.DISARM,
        CommandKind.FORCE_DISARM,
        CommandKind.PHOTO,
    }
    assert set(CommandKind) - NEEDS_PERMIT == still
