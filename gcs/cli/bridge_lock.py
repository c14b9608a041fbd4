"""`gcs bridge --lock`: a vehicle that obeys its bridge and nobody else."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from gcs.cli.key import give_key, over_link, read_key_file
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.protocol.lock_setup import LockSetup


ASKS_TO_ARM = "COM_ARM_AUTH_REQ"
NEEDS_A_FENCE = (
    "it arms only with a fence of its own: GF_MAX_HOR_DIST and GF_MAX_VER_DIST above 0, or a fence "
    "plan on board"
)
"""PX4's default has neither, and then the bridge says no."""


def lock_vehicle(
    url: str, key_file: str, own_sysid: int, vehicle: int | None, timeout_s: float
) -> None:
    """Give it the key, set its parameters, and print what was changed.

    Nothing is recorded, because the key passes over the link.  Raises ExitError.
    """
    from gcs.protocol.lock_setup import LockSetup
    from gcs.shell.clock import Clock

    key = read_key_file(key_file)
    given = give_key(key, None, url, vehicle, timeout_s)
    name = f"lock: vehicle {given.vehicle}"
    had = "had the key already:" if given.had_it else "was given the key"
    click.echo(f"{name} {had} {key.fingerprint}; what is not signed with it gets nothing", err=True)
    clock = Clock()
    sysid = int(given.vehicle.split("/")[0])
    setup = LockSetup(key, own_sysid, sysid, clock.now_ns() + round(timeout_s * 1e9))
    over_link(setup, url, clock)
    for change in setup.changes:
        was = f"was {change.before:g}" if change.before != change.after else "as it was"
        click.echo(f"{name}: {change.name} = {change.after:g} ({was})", err=True)
    if any(change.name == ASKS_TO_ARM for change in setup.changes):
        click.echo(f"{name}: {NEEDS_A_FENCE}", err=True)
    trouble = _trouble(setup, given.vehicle)
    if trouble is not None:
        raise trouble


def _trouble(setup: LockSetup, vehicle: str) -> ExitError | None:
    from gcs.protocol.lock_setup import Ending

    match setup.ending:
        case Ending.DONE | None:
            return None
        case Ending.NO_VEHICLE:
            return ExitError(ExitCode.NO_VEHICLE, f"vehicle {vehicle} is not heard any more")
        case Ending.ARMED:
            text = f"vehicle {vehicle} is armed"
            return ExitError(ExitCode.REFUSED_BY_VEHICLE, text, "disarm it first")
        case Ending.INCOMPLETE:
            text = f"vehicle {vehicle} has no {setup.missing}, or does not take its value"
            hint = "it has the key, and signing protects it; its arming asks nobody"
            return ExitError(ExitCode.REFUSED_BY_VEHICLE, text, hint)
