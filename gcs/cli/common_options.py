"""The options of every command that meets a vehicle, told once: `gcs help options`."""

from __future__ import annotations

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
)

COMMON = (LINK, VEHICLE, POLICY, SIGN_KEY, LOG_DIR, TIMEOUT, TAKE, AS_JSON, VERBOSE, QUIET)
TITLE = "Options of every command that meets a vehicle"


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
