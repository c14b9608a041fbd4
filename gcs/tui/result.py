"""How a session at the keyboard ended, told on the terminal that it was started from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from gcs import ipc
from gcs.cli import say
from gcs.cli.dialogue import Link, death, final_exit
from gcs.shell.client import LinkDown


@dataclass(frozen=True, slots=True)
class Result:
    """`asked` is False where the link ended before the operator wanted to leave."""

    down: LinkDown
    asked: bool
    trouble: ipc.Trouble | None = None


def until_hello(link: Link) -> list[ipc.Event]:
    """What a link says until it is there.  Raises Fail, with its own words, where it cannot be.

    Only then is the screen taken: a port in use is told where the command was typed.
    """
    events: list[ipc.Event] = []
    trouble: ipc.Trouble | None = None
    while not any(isinstance(event, ipc.Hello) for event in events):
        for heard in link.poll(1.0).heard:
            if isinstance(heard, LinkDown):
                link.close()
                raise death(heard, trouble)
            if isinstance(heard, ipc.Trouble):
                trouble = heard
            events.append(heard)
    return events


def tell(result: Result, echo: Callable[[str], None]) -> int:
    """Print log path and outcome; gives the exit code.  Raises Fail where the link died."""
    if not result.asked:
        raise death(result.down, result.trouble)
    bye = result.down.bye
    if bye is None:
        echo(f"gcs: the link ended without a good-bye\n{result.down.stderr_tail}".rstrip())
    else:
        for line in say.farewell_lines(bye):
            echo(line)
    return final_exit(result.down)
