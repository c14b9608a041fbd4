"""Options that every command with a station of its own shares, and what they add up to."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click
from click.core import ParameterSource

from gcs.cli import completers
from gcs.cli.settings import Configured, usual_links
from gcs.config import DEFAULT_LINK, StationConfig, Wanted
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError
from gcs.operator.text.number_text import read_number, read_whole_number

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

F = TypeVar("F", bound=Callable[..., Any])


class FiniteRange(click.FloatRange):
    """A number as `read_number` takes it, within limits."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        if isinstance(value, str):
            try:
                value = read_number(value)
            except ValueError as error:
                self.fail(f"{error}.", param, ctx)
        return float(super().convert(value, param, ctx))


class Seed(click.ParamType[int]):
    """A whole number from 0."""

    name = "SEED"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:
        if not isinstance(value, str):
            return int(value)
        try:
            seed = read_whole_number(value)
        except ValueError as error:
            self.fail(f"{error}.", param, ctx)
        if seed < 0:
            self.fail(f"{seed} is negative.", param, ctx)
        return seed


class Seconds(FiniteRange):
    """More than 0, and finite."""

    def __init__(self) -> None:
        super().__init__(min=0, min_open=True)


class SystemId(click.IntRange):
    """A vehicle's, or a ground station's, MAVLink system id."""

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        return completers.vehicles(ctx, param, incomplete)

    def __init__(self) -> None:
        super().__init__(1, 255)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:
        try:
            return int(super().convert(value, param, ctx))
        except click.BadParameter:
            self.fail(
                f"{value!r} is no MAVLink system id, a whole number from 1 to 255.", param, ctx
            )


class Utf8Text(click.types.StringParamType):
    """What goes to a station goes as JSON, which has no other text; a file's name may be other."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        text = super().convert(value, param, ctx)
        try:
            text.encode()
        except UnicodeEncodeError:
            self.fail(f"{text!r} is not UTF-8.", param, ctx)
        return text


class RecordName(Utf8Text):
    """The part of a record's file name that a user chooses: no folder, and no more than fits."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        text = super().convert(value, param, ctx)
        if len(text) > RECORD_NAME_MAX:
            self.fail(f"has {len(text)} characters; at most {RECORD_NAME_MAX}.", param, ctx)
        if not _RECORD_NAME.fullmatch(text):
            self.fail(
                f"{text!r} is no part of a file name: letters, digits and . _ -, "
                "the first of them no point.",
                param,
                ctx,
            )
        return text


RECORD_NAME_MAX = 80
_RECORD_NAME = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9._-]*")
UTF8 = Utf8Text()
SYSID = SystemId()

ASCII = click.Option(
    ["--ascii", "ascii_only"],
    is_flag=True,
    help="Draw the screen in ASCII, as is done where the terminal is not UTF-8.",
)
LINK = click.Option(
    ["--link", "links"],
    multiple=True,
    type=UTF8,
    metavar="URL",
    help=f"Where the vehicle is: udpin:// udpout:// tcpin:// tcpout:// serial://, or pymavlink's "
    f"forms. May be given more than once.  [default: {DEFAULT_LINK}]",
)
POLICY = Configured(
    ["--policy"],
    setting="policy",
    default="default",
    show_default=True,
    metavar="FILE|default|lab|demo",
    help="What the gate allows.",
    shell_complete=completers.policies,
)
LOG_DIR = Configured(
    ["--log-dir"],
    setting="log_dir",
    type=UTF8,
    default="logs",
    show_default=True,
    metavar="DIR",
    help="Where the flight is recorded.",
    shell_complete=completers.folder,
)
TIMEOUT = Configured(
    ["--timeout"],
    setting="timeout_s",
    type=Seconds(),
    default=10.0,
    show_default=True,
    metavar="S",
    help="Seconds to wait for a vehicle to be heard.",
)
VEHICLE = click.Option(
    ["--vehicle"],
    type=SYSID,
    default=None,
    metavar="SYSID",
    help="Which vehicle, by its MAVLink system id, where several are heard.",
)
TAKE = click.Option(
    ["--take"],
    is_flag=True,
    help="Where another operator is in control of the running station, take it over; it is told.",
)
SIGN_KEY = click.Option(
    ["--sign-key"],
    type=UTF8,
    default="",
    metavar="FILE",
    help="The vehicle's signing key: all that leaves is signed with it, and what comes in unsigned "
    "is refused. See gcs key.",
    shell_complete=completers.any_file,
)
CLIENT_KEY = click.Option(
    ["--client-key"],
    type=UTF8,
    default="",
    metavar="FILE",
    help="The signing key of MAVLink clients: what they send unsigned is refused, and who comes to "
    "a port is sent heartbeats alone until it has signed.",
    shell_complete=completers.any_file,
)
VERBOSE = click.Option(
    ["-v", "--verbose"], is_flag=True, help="All lines of the log, those for debugging too."
)
QUIET = click.Option(
    ["-q", "--quiet"], is_flag=True, help="One level of the log less than usual, and no progress."
)
AS_JSON = click.Option(["--json", "as_json"], is_flag=True, help="Print JSON, for scripts.")


def asked_for() -> Wanted:
    """What of a station the present command line asks for by name."""
    params = click.get_current_context().params
    wanted = {name: params[name] for name in ("policy", "log_dir", "vehicle") if typed(name)}
    return Wanted(**wanted)


def typed(name: str) -> bool:
    """Whether the present command line itself names this parameter: a configuration file may say
    where links are, and which policy is usual, but no more than that."""
    source = click.get_current_context().get_parameter_source(name)
    return source in (ParameterSource.COMMANDLINE, ParameterSource.ENVIRONMENT)


WARNING = 3
"""The level from which on commands that send one request show the log."""


def log_level(usual: int, *, quiet: bool, verbose: bool) -> int:
    """From which level of the log on a command shows lines; 1 debug .. 5 fatal."""
    return 1 if verbose else usual + quiet


def with_options(*options: click.Option) -> Callable[[F], F]:
    """The given options, in this order, on a command made by a decorator."""

    def attach(function: F) -> F:
        params = function.__dict__.setdefault("__click_params__", [])
        params.extend(reversed(options))
        return function

    return attach


def _policy_file(name: str) -> str:
    """The file behind `--policy`, as a station is told it: empty for the built-in default.

    Raises ExitError with BAD_FILE.
    """
    from gcs.resources import POLICIES, policy_path

    if name == "default":
        return ""
    path = policy_path(name)
    if name in POLICIES:
        return str(path)
    if path.is_dir():
        raise ExitError(
            ExitCode.BAD_FILE,
            f"{name}: is a directory",
            "a policy is a TOML file or " + ", ".join(POLICIES),
        )
    if not path.is_file():
        raise ExitError(
            ExitCode.BAD_FILE,
            f"{name}: no such policy file",
            "a file's name, or one of: " + ", ".join(POLICIES),
        )
    return UTF8.convert(name, POLICY, None)


def station_config(
    links: tuple[str, ...],
    policy: str,
    log_dir: str,
    *,
    name: str,
    timeout_s: float,
    vehicle: int | None = None,
    record: bool = True,
    sign_key: str = "",
    client_key: str = "",
) -> StationConfig:
    """For a station that flies a vehicle which somebody else has started."""
    return StationConfig(
        endpoints=list(links) or usual_links(),
        policy_path=_policy_file(policy),
        log_dir=log_dir,
        name=name,
        connect_timeout_s=timeout_s,
        target_sysid=vehicle or 0,
        record=record,
        vehicle_key_path=sign_key,
        client_key_path=client_key,
        operator=f"gcs {name}, pid {os.getpid()}",
    )
