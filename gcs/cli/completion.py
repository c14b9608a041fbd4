"""`gcs completion`: what a shell must read to complete commands, options, files and vehicles."""

from __future__ import annotations

import click

from gcs.cli.main import gcs as program

SHELLS = ("bash", "zsh", "fish")
PROGRAMS = ("gcs", "vehicle-sim")
INSTALL = {
    "bash": "echo 'eval \"$(gcs completion bash)\"' >> ~/.bashrc",
    "zsh": "echo 'eval \"$(gcs completion zsh)\"' >> ~/.zshrc   # after compinit",
    "fish": "echo 'gcs completion fish | source' >> ~/.config/fish/config.fish",
}


@click.command(
    epilog="Example: gcs completion bash\n\n\b\nTo have it in every new shell:\n"
    + "\n".join(f"  {line}" for line in INSTALL.values())
)
@click.argument("shell", type=click.Choice(SHELLS))
def completion(shell: str) -> None:
    """Print what SHELL must read to complete the words of gcs and vehicle-sim.

    Commands and options, files by their kind, shipped missions and policies, and the vehicles of
    running stations.
    """
    from click.shell_completion import get_completion_class

    kind = get_completion_class(shell)
    assert kind is not None, "one of SHELLS"
    click.echo(f"# To have it in every new shell:  {INSTALL[shell]}")
    for name in PROGRAMS:
        variable = f"_{name.replace('-', '_').upper()}_COMPLETE"
        click.echo(kind(program, {}, name, variable).source())
