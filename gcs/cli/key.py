"""`gcs key`: signing keys, in files and on vehicles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from gcs.cli import completers
from gcs.cli.options import SYSID, TIMEOUT, UTF8, VEHICLE, with_options
from gcs.config import DEFAULT_LINK
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.protocol.signing_setup import SigningSetup
    from gcs.shell.clock import Clock
    from gcs.shell.key_setup import Setup
    from gcs.wire.signing import SecretKey

KEY_LINK = click.Option(
    ["--link"],
    type=UTF8,
    default=DEFAULT_LINK,
    show_default=True,
    metavar="URL",
    help="Where the vehicle is. The key passes over it unencrypted: use a cable.",
)

KEY_SYSID = click.Option(
    ["--sysid"],
    type=SYSID,
    help="The MAVLink system id to speak in: an ArduPilot that `gcs bridge --lock --enforce-sysid` "
    "locked hears that of its bridge, 255, alone.  [default: 254]",
)

ON_VEHICLE = (KEY_LINK, VEHICLE, TIMEOUT, KEY_SYSID)


@click.group()
def key() -> None:
    """MAVLink 2 signing keys: make one, give it to a vehicle, take it away.

    A vehicle that has a key obeys only who signs with it. The station does with --sign-key FILE.
    """


@key.command(epilog="Example: gcs key new vehicle.key")
@click.argument("file", type=UTF8, shell_complete=completers.any_file)
def new(file: str) -> None:
    """Make a key of 32 random bytes, in a new file that only you can read."""
    from gcs.shell.key_files import KeyFileError, new_key

    try:
        made = new_key(file)
    except KeyFileError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from error
    click.echo(f"{file}: a new key, fingerprint {made.fingerprint}")


@key.command(epilog="Example: gcs key show vehicle.key")
@click.argument("file", type=UTF8, shell_complete=completers.any_file)
def show(file: str) -> None:
    """Print the fingerprint of a key, by which keys are compared; never the key."""
    click.echo(f"{file}: fingerprint {read_key_file(file).fingerprint}")


@key.command(epilog="Example: gcs key install vehicle.key --link serial:///dev/ttyACM0:115200")
@click.argument("file", type=UTF8, shell_complete=completers.any_file)
@click.option(
    "--old-key",
    type=UTF8,
    metavar="FILE",
    help="The key that the vehicle has now.",
    shell_complete=completers.any_file,
)
@with_options(*ON_VEHICLE)
def install(
    file: str,
    old_key: str | None,
    link: str,
    vehicle: int | None,
    timeout: float,
    sysid: int | None,
) -> None:
    """Give the vehicle the key; from then on it obeys only who signs with it.

    It must be disarmed. The vehicle is asked afterwards, signed and unsigned. Nothing is recorded.
    """
    new_one = read_key_file(file)
    old_one = read_key_file(old_key) if old_key else None
    setup = give_key(new_one, old_one, link, vehicle, timeout, sysid)
    had = "had already" if setup.had_it else "has"
    click.echo(
        f"vehicle {setup.vehicle} {had} the key {new_one.fingerprint}; "
        "it answers what is signed with it, and nothing that is not signed"
    )


@key.command(epilog="Example: gcs key remove vehicle.key --link udpin://127.0.0.1:14550")
@click.argument("file", type=UTF8, shell_complete=completers.any_file)
@with_options(*ON_VEHICLE)
def remove(file: str, link: str, vehicle: int | None, timeout: float, sysid: int | None) -> None:
    """Take the key in FILE away from the vehicle, which obeys anybody then.

    The file stays. The vehicle must be disarmed.
    """
    setup = give_key(None, read_key_file(file), link, vehicle, timeout, sysid)
    click.echo(
        f"vehicle {setup.vehicle} has no key{' (it had none)' if setup.had_it else ''}; "
        "it takes what is not signed"
    )


def read_key_file(file: str) -> SecretKey:
    from gcs.shell.key_files import KeyFileError, read_key

    try:
        return read_key(file)
    except KeyFileError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from error


def give_key(
    new_key: SecretKey | None,
    old_key: SecretKey | None,
    url: str,
    vehicle: int | None,
    timeout_s: float,
    own_sysid: int | None = None,
) -> SigningSetup:
    """Raises ExitError unless the vehicle is as it should be afterwards.

    `own_sysid` is the system id to speak in, None for the usual one.
    """
    from gcs.protocol.signing_setup import SENDER, SigningSetup
    from gcs.shell.clock import Clock

    clock = Clock()
    deadline_ns = clock.now_ns() + round(timeout_s * 1e9)
    setup = SigningSetup(new_key, old_key, vehicle or 0, deadline_ns, own_sysid or SENDER.sysid)
    over_link(setup, url, clock)
    trouble = _trouble(setup, url, timeout_s)
    if trouble is not None:
        raise trouble
    return setup


def over_link(setup: Setup, url: str, clock: Clock) -> None:
    """Run a set-up until it has its ending.  Raises ExitError where the link cannot be opened."""
    from gcs.shell.endpoints import EndpointError, parse_endpoint
    from gcs.shell.key_setup import run
    from gcs.shell.sockets import AddressInUse, open_link
    from gcs.shell.sockets.serial import SerialUnavailable

    try:
        opened = open_link(parse_endpoint(url))
    except EndpointError as error:
        raise ExitError(ExitCode.USAGE, str(error), error.hint) from error
    except AddressInUse as error:
        hint = "if it is a station of yours, end it first: gcs stations end"
        raise ExitError(ExitCode.ADDRESS_IN_USE, str(error), hint) from error
    except SerialUnavailable as error:
        raise ExitError(ExitCode.USAGE, f"{url}: {error}", error.hint) from error
    except OSError as error:
        raise ExitError(ExitCode.NO_VEHICLE, f"{url}: {error.strerror or error}") from error
    try:
        run(setup, opened, clock)
    finally:
        opened.close()


def _trouble(setup: SigningSetup, url: str, timeout_s: float) -> ExitError | None:
    from gcs.protocol.signing_setup import TRIES, Ending

    name = f"vehicle {setup.vehicle}"
    match setup.ending:
        case Ending.DONE | None:
            return None
        case Ending.NO_VEHICLE:
            text, hint = f"no vehicle heard for {timeout_s:.0f} s ({url})", "is it running?"
            return ExitError(ExitCode.NO_VEHICLE, text, hint)
        case Ending.ARMED:
            return ExitError(ExitCode.REFUSED_BY_VEHICLE, f"{name} is armed", "disarm it first")
        case Ending.OTHER_KEY:
            hint = "name the key that it has with --old-key"
            text = f"{name} signs already, with another key"
            return ExitError(ExitCode.REFUSED_BY_VEHICLE, text, hint)
        case Ending.NO_EFFECT:
            text = f"{name} was sent SETUP_SIGNING {TRIES} times and goes on as before"
            hint = (
                "has its firmware MAVLink 2 signing? ArduPilot has; PX4 since 1.17 (before: "
                "gcs bridge --lock without --sign-key makes it ask before it arms)"
            )
            return ExitError(ExitCode.REFUSED_BY_VEHICLE, text, hint)
        case Ending.NO_ANSWER:
            text = f"{name} signs with the key, and does not answer what is signed with it"
            hint = "restart it; is the clock of this computer right?"
            return ExitError(ExitCode.REFUSED_BY_VEHICLE, text, hint)
        case Ending.TAKES_UNSIGNED:
            text = f"{name} has the key, and answers on this link what is not signed, too"
            hint = "ArduPilot does so over USB: try again over the radio"
            return ExitError(ExitCode.DIFFERENT, text, hint)
