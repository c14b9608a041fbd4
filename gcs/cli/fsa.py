"""`gcs fsa`: the gate's state machine, printed from the table that it runs from."""

from __future__ import annotations

import click

from gcs.gate.states import State

STATES = [state.name for state in State]


@click.command(
    name="fsa",
    epilog="Examples: gcs fsa HOVERING  |  gcs fsa --format dot | dot -Tsvg -o gate.svg",
)
@click.argument("state", required=False, type=click.Choice(STATES, case_sensitive=False))
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "dot"]),
    default="text",
    show_default=True,
    help="Every cell as text, or a graph for Graphviz.",
)
def fsa(state: str | None, form: str) -> None:
    """Print the gate's state machine: every state, every event, what follows.

    With STATE only what leads out of it, a line an event. It is the very table that the gate runs
    from.
    """
    from gcs.gate.machine import render

    if state is not None:
        if form == "dot":
            raise click.UsageError("the graph is of all states: leave out STATE, or --format")
        click.echo(render.short(State[state]), nl=False)
        return
    click.echo(render.dot() if form == "dot" else render.text(), nl=False)
