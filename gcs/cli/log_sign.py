"""`gcs log sign`: so that nobody without the key can alter a record unseen."""

from __future__ import annotations

from pathlib import Path

import click

from gcs.cli.key import read_key_file
from gcs.cli.options import UTF8
from gcs.cli.record_files import RECORD, told


@click.command(epilog="Example: gcs log sign logs/20260101-120000_flight.mcap --key records.key")
@click.argument("files", type=RECORD, nargs=-1, required=True, metavar="FILE...")
@click.option(
    "--key", type=UTF8, required=True, metavar="KEYFILE", help="As `gcs key new` makes it."
)
def sign(files: tuple[Path, ...], key: str) -> None:
    """Sign a record, in a file beside it; gcs log audit --key KEYFILE checks it.

    The signature is over every byte: a record that is compacted or otherwise written anew is signed
    anew. Keep the key where whoever might alter the record does not come.
    """
    from gcs.record.signature import sign as sign_record

    secret = read_key_file(key)
    for file in files:
        with told(file):
            path = sign_record(file, secret)
        click.echo(f"{path}: signed with {secret.fingerprint}")
