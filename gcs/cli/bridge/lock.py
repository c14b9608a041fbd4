"""`gcs bridge --lock`: a vehicle that obeys its bridge and nobody else."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import click

from gcs.cli.key import give_key, over_link, read_key_file
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.protocol.lock_parameters import FenceSize
    from gcs.protocol.lock_setup import LockSetup

ASKS_TO_ARM = "COM_ARM_AUTH_REQ"
NEEDS_A_FENCE = (
    "it arms only with a fence of its own: GF_MAX_HOR_DIST and GF_MAX_VER_DIST above 0, or a fence "
    "plan on board; --set-fence sets them by the policy"
)
"""PX4's default has neither, and then the bridge says no."""
ENFORCES = frozenset({"SYSID_ENFORCE", "MAV_OPTIONS"})
NO_KEY = "it has no key: whoever reaches it may set this back (PX4 has signing since 1.17)"
NOT_ENFORCED = "--enforce-sysid: PX4 has no such setting; its key keeps strangers out"


@dataclass(frozen=True, slots=True)
class LockOptions:
    """How the vehicle is to be locked: beyond its key and its arming."""

    own_sysid: int
    policy: str
    set_fence: bool
    enforce_sysid: bool


def lock_vehicles(
    urls: Sequence[str], key_file: str, options: LockOptions, vehicle: int | None, timeout_s: float
) -> None:
    """The vehicle on each link, one after the other; `vehicle` alone, on the first, where it is
    chosen.  Raises ExitError at the first that cannot be locked: what was told before it is done.
    """
    for url in urls if vehicle is None else urls[:1]:
        lock_vehicle(url, key_file, options, vehicle, timeout_s)


def lock_vehicle(
    url: str, key_file: str, options: LockOptions, vehicle: int | None, timeout_s: float
) -> None:
    """Give it the key, set its parameters, and print what was changed.

    Without a key file the parameters alone: PX4 before 1.17 has no signing.  Nothing is recorded,
    because the key passes over the link.  Raises ExitError.
    """
    from gcs.protocol.lock_parameters import Locking
    from gcs.protocol.lock_setup import LockSetup
    from gcs.shell.clock import Clock

    fence = fence_of(options.policy) if options.set_fence else None
    sysid, key = vehicle or 0, None
    if key_file:
        key = read_key_file(key_file)
        given = give_key(key, None, url, vehicle, timeout_s, options.own_sysid)
        had = "had the key already:" if given.had_it else "was given the key"
        obeys = f"{had} {key.fingerprint}; on this link it obeys what is signed with it alone"
        click.echo(f"lock: vehicle {given.vehicle} {obeys}", err=True)
        sysid = int(given.vehicle.split("/")[0])
    clock = Clock()
    lock = Locking(options.own_sysid, fence, options.enforce_sysid)
    setup = LockSetup(key, lock, sysid, clock.now_ns() + round(timeout_s * 1e9))
    over_link(setup, url, clock)
    lines = _told(setup, options)
    lines += setup.open_ports
    if key is None and setup.vehicle:
        lines.append(NO_KEY)
    for line in lines:
        click.echo(f"lock: vehicle {setup.vehicle}: {line}", err=True)
    trouble = _trouble(setup, url, timeout_s, signs=key is not None)
    if trouble is None and vehicle is None:
        trouble = _not_locked(setup, url)
    if trouble is not None:
        raise trouble


def _not_locked(setup: LockSetup, url: str) -> ExitError | None:
    """Nobody chose one, and there were several."""
    if not setup.others:
        return None
    others = ", ".join(str(sysid) for sysid in sorted(setup.others))
    text = f"vehicle {setup.vehicle} is locked, and {others} on the same link is not ({url})"
    hint = "lock each with --target SYSID, then start the bridge for all without --lock"
    return ExitError(ExitCode.USAGE, text, hint)


def fence_of(policy: str) -> FenceSize:
    """The policy's fence as a cylinder about home, as the vehicle's failsafes are judged by it.

    Raises ExitError for a policy that is none.
    """
    from gcs.gate.policy.cylinder import cylinder_of
    from gcs.policy_file import PolicyFileError, load_policy
    from gcs.protocol.lock_parameters import FenceSize

    try:
        about_home = cylinder_of(load_policy(policy)[0])
    except PolicyFileError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from None
    return FenceSize(about_home.reach_m, about_home.ceiling_up_m)


def _told(setup: LockSetup, options: LockOptions) -> list[str]:
    """A line a parameter, and what follows from them."""
    lines = []
    for change in setup.changes:
        was = f"was {change.before:g}" if change.before != change.after else "as it was"
        lines.append(f"{change.name} = {change.after:g} ({was})")
    names = {change.name for change in setup.changes}
    if ASKS_TO_ARM in names and not options.set_fence:
        lines.append(NEEDS_A_FENCE)
    if ENFORCES & names:
        lines.append(
            f"it hears system id {options.own_sysid} alone: clients need --sysid, or the "
            "like, of that number"
        )
    elif options.enforce_sysid and ASKS_TO_ARM in names:
        lines.append(NOT_ENFORCED)
    return lines


def _trouble(setup: LockSetup, url: str, timeout_s: float, *, signs: bool) -> ExitError | None:
    from gcs.protocol.lock_setup import Ending

    name = f"vehicle {setup.vehicle}"
    match setup.ending:
        case Ending.DONE | None:
            return None
        case Ending.NO_VEHICLE:
            text = f"no vehicle heard for {timeout_s:.0f} s ({url})"
            hint = "" if signs else "if it has a key, name it with --sign-key"
            return ExitError(ExitCode.NO_VEHICLE, text, hint)
        case Ending.ARMED:
            return ExitError(ExitCode.REFUSED_BY_VEHICLE, f"{name} is armed", "disarm it first")
        case Ending.INCOMPLETE:
            text = f"{name} has no {setup.missing}, or does not take its value"
            hint = "what is told above was set; the rest was not"
            return ExitError(ExitCode.REFUSED_BY_VEHICLE, text, hint)
