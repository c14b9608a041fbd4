"""`gcs fsa`: the gate's state machine, printed from the table that it runs from."""

from __future__ import annotations

import click


@click.command(
    name="fsa",
    epilog="Example:  gcs fsa --format dot | dot -Tsvg -o gate.svg",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "dot"]),
    default="text",
    show_default=True,
    help="Every cell as text, or a graph for Graphviz.",
)
def fsa(form: str) -> None:
    """Print the gate's state machine: every state, every event, what follows.

    It is the very table that the gate runs from.
    """
    from gcs.gate.machine import render

    click.echo(render.dot() if form == "dot" else render.text(), nl=False)
