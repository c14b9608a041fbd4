"""How a session at the keyboard ended, printed on the terminal that it was started from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from gcs import ipc
from gcs.operator.client import Polling, StationEnded
from gcs.operator.conversation import Conversation, exit_code_of
from gcs.operator.dialogue import InterruptSource
from gcs.operator.errors import Interrupted
from gcs.operator.text import event_text


@dataclass(frozen=True, slots=True)
class SessionResult:
    """`asked` is False if the station ended before the operator wanted to leave; `talk` is all that
    it has told, to its end."""

    talk: Conversation
    asked: bool


def until_hello(connection: Polling, interrupts: InterruptSource | None = None) -> list[ipc.Event]:
    """The events of a station until it is ready.

    Only then is the screen taken: a port in use is told where the command was typed.  Raises
    ExitError if it cannot start, and Interrupted on a Ctrl-C; then the station has ended.
    """
    events: list[ipc.Event] = []
    talk = Conversation()
    while talk.hello is None:
        polled = connection.poll(1.0, () if interrupts is None else (interrupts,))
        if interrupts is not None and interrupts.name:
            connection.send(ipc.Leave(interrupts.name))
            connection.close()
            raise Interrupted(interrupts.name)
        for event in polled.events:
            talk.told(event)
            if isinstance(event, StationEnded):
                connection.close()
                raise talk.unexpected_end()
            events.append(event)
    return events


def print_result(
    result: SessionResult, echo: Callable[[str], None], *, simulated: bool = False
) -> int:
    """Print how it ended and the log's path; returns the exit code.

    Raises ExitError if the station ended although nobody asked it to.
    """
    if not result.asked:
        raise result.talk.unexpected_end()
    ended = result.talk.ended
    assert ended is not None
    for line in event_text.end_lines(ended, simulated=simulated):
        echo(line)
    return exit_code_of(ended)
