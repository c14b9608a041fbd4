"""`gcs log check`: is a record as a reader expects it?"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gcs.cli.record_files import RECORD, reading_progress, told
from gcs.exit_codes import ExitCode

if TYPE_CHECKING:
    from gcs.record.check import CheckResult


@click.command()
@click.argument("files", type=RECORD, nargs=-1, required=True, metavar="FILE...")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object a file, one a line.")
@click.pass_context
def check(ctx: click.Context, files: tuple[Path, ...], as_json: bool) -> None:
    """Is each FILE whole, indexed and in order, and can every message be decoded?

    The exit code is 1 where anything is wrong, and 4 where a FILE is no MCAP at all. Whether the
    messages are those that were written is what gcs log audit tells.

    Example: gcs log check logs/*.mcap
    """
    import msgspec

    from gcs.record.check import check as check_file

    good = True
    for file in files:
        with told(file), reading_progress(file, "checking") as progress:
            result = check_file(file, progress)
        good = good and result.good
        if as_json:
            name = result.path.encode(errors="backslashreplace").decode()
            values = {**msgspec.to_builtins(result), "path": name, "good": result.good}
            click.echo(msgspec.json.encode(values).decode())
        else:
            _print(result)
    ctx.exit(ExitCode.DONE if good else ExitCode.DIFFERENT)


def _print(result: CheckResult) -> None:
    word = "good" if result.good else "NOT GOOD"
    click.echo(
        f"{result.path}: {word}: {result.messages} messages on {result.channels} channels, "
        f"{result.seconds:.1f} s"
    )
    for finding in result.findings:
        click.echo(f"  {finding.kind}: {finding.text}")
    for kind, count in result.counts.items():
        told = sum(finding.kind == kind for finding in result.findings)
        if count > told:
            click.echo(f"  {kind}: {count - told} more")
    if "file" in result.counts:
        click.echo(f"  hint: gcs log recover {result.path} -o whole.mcap")
    if result.not_decoded:
        click.echo(f"  {result.not_decoded} messages are of encodings that are not decoded here")
