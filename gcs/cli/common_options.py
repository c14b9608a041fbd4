"""The options of every command that meets a vehicle, told once: `gcs help options`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NotRequired, TypedDict

import click

from gcs.cli.options import (
    AS_JSON,
    LINK,
    LOG_DIR,
    POLICY,
    QUIET,
    SIGN_KEY,
    TAKE,
    TIMEOUT,
    VEHICLE,
    VERBOSE,
    WARNING,
    asked_for,
    log_level,
    station_config,
    typed,
)

if TYPE_CHECKING:
    from gcs.cli.oneshot_session import OneShotConfig
    from gcs.config import StationConfig

COMMON = (LINK, VEHICLE, POLICY, SIGN_KEY, LOG_DIR, TIMEOUT, TAKE, AS_JSON, VERBOSE, QUIET)
TITLE = "Options of every command that meets a vehicle"


class ToVehicle(TypedDict):
    """What `COMMON` come to, and `wait` of those commands that wait for an effect."""

    links: tuple[str, ...]
    vehicle: int | None
    policy: str
    sign_key: str
    log_dir: str
    timeout: float
    wait: NotRequired[float]
    as_json: bool
    take: NotRequired[bool]
    verbose: bool
    quiet: bool


def set_up(
    name: str, what: str, to: ToVehicle, *, record: bool = True, **how: Any
) -> tuple[StationConfig, OneShotConfig]:
    """A station of its own named `name`, and how one command `what` is done with it, or through one
    that runs; `how` is more of that, by its fields."""
    from gcs.cli.oneshot_session import OneShotConfig

    setup = station_config(
        to["links"],
        to["policy"],
        to["log_dir"],
        name=name,
        timeout_s=to["timeout"],
        vehicle=to["vehicle"],
        record=record,
        sign_key=to["sign_key"],
    )
    usual: dict[str, Any] = {
        "anywhere": not typed("links"),
        "take": to.get("take", False),
        "wanted": asked_for(),
        "min_level": log_level(WARNING, quiet=to["quiet"], verbose=to["verbose"]),
        "quiet": to["quiet"],
    }
    waits_s = to.get("wait", 0.0)
    return setup, OneShotConfig(to["timeout"], waits_s, to["as_json"], what, **(usual | how))


class MeetsVehicle(click.Command):
    """A command whose help lists its own options, and names the common ones."""

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        options = [param for param in self.get_params(ctx) if isinstance(param, click.Option)]
        own = [param for param in options if param not in COMMON]
        records = [found for param in own if (found := param.get_help_record(ctx)) is not None]
        with formatter.section("Options"):
            formatter.write_dl(records)
        shared = [param.opts[-1] for param in options if param in COMMON]
        with formatter.section(f"{TITLE} (gcs help options)"):
            formatter.write_text(" ".join(shared))


@click.command(hidden=True, add_help_option=False, options_metavar="")
@click.pass_context
def options(ctx: click.Context) -> None:
    """What `gcs help options` prints."""
    formatter = ctx.make_formatter()
    with formatter.section(TITLE):
        formatter.write_dl([found for each in COMMON if (found := each.get_help_record(ctx))])
    formatter.write_paragraph()
    formatter.write_text(
        "A command names those that it takes. mavgate.toml can change the defaults: gcs config."
    )
    click.echo(formatter.getvalue(), nl=False)
