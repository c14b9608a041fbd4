"""`gcs fsa`: the gate's state machine, printed from the table that it runs from."""

from __future__ import annotations

import click

from gcs.gate.states import State

STATES = [state.name for state in State]
LAB = (State.HOVERING, State.VERIFYING, State.MOVING)


@click.command(
    name="fsa",
    epilog="Examples: gcs fsa HOVERING  |  gcs fsa --lab  |  "
    "gcs fsa --format dot | dot -Tsvg -o gate.svg",
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
@click.option("--lab", is_flag=True, help="Only the lab's three states, and the ways between them.")
def fsa(state: str | None, form: str, lab: bool) -> None:
    """Print the gate's state machine: every state, every event, what follows.

    With STATE only what leads out of it, a line an event. It is the very table that the gate runs
    from.
    """
    from gcs.gate.machine import render

    if state is not None:
        if form == "dot":
            raise click.UsageError("the graph is of all states: leave out STATE, or --format")
        if lab:
            raise click.UsageError("--lab is three states: leave out STATE, or --lab")
        click.echo(render.short(State[state]), nl=False)
    elif form == "dot":
        click.echo(render.dot(among=LAB) if lab else render.dot(), nl=False)
    elif lab:
        click.echo("\n".join(render.short(each, among=LAB) for each in LAB), nl=False)
    else:
        click.echo(render.text(), nl=False)
