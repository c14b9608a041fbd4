"""How a session at the keyboard ended, told on the terminal that it was started from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from gcs import ipc
from gcs.cli.dialogue import death, final_exit
from gcs.shell.client import LinkDown


@dataclass(frozen=True, slots=True)
class Result:
    """`asked` is False where the link ended before the operator wanted to leave."""

    down: LinkDown
    asked: bool
    trouble: ipc.Trouble | None = None


def tell(result: Result, echo: Callable[[str], None]) -> int:
    """Print log path and outcome; gives the exit code.  Raises Fail where the link died."""
    if not result.asked:
        raise death(result.down, result.trouble)
    bye = result.down.bye
    if bye is None:
        echo(f"gcs: the link ended without a good-bye\n{result.down.stderr_tail}".rstrip())
    else:
        if bye.sentence:
            echo(f"gcs: {bye.sentence}")
        if bye.log_path:
            echo(f"log: {bye.log_path}")
    return final_exit(result.down)
