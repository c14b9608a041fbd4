"""`gcs log replay`: an old flight over UDP, as its vehicle sent it."""

from __future__ import annotations

import select
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gcs.cli.options import SYSID, UTF8, FiniteRange
from gcs.cli.records.files import LAST, RECORD, one_record
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.replay.frames import Frames
    from gcs.replay.player import Player
    from gcs.shell.sockets.base import Link

DEFAULT_TO = "udpout://127.0.0.1:14550"
SHOW_S = 0.2
LONGEST_WAIT_S = 0.1
BURST = 64
KEYS_HELP = "space pause, left/right 5 s, down/up 30 s, + - speed, 0 begin, q end"


@click.command(
    "replay",
    epilog=f"Example: gcs log replay --last --speed 2\n\n"
    f"Keys on a terminal: {KEYS_HELP}.\n\nThen QGroundControl, or gcs status, shows the flight.",
)
@click.argument("file", type=RECORD, required=False)
@LAST
@click.option(
    "--link",
    "links",
    multiple=True,
    type=UTF8,
    metavar="URL",
    help=f"Where to play it to.  May be given more than once.  [default: {DEFAULT_TO}]",
)
@click.option(
    "--speed",
    type=FiniteRange(min=0.01, max=1000.0),
    default=1.0,
    show_default=True,
    metavar="FACTOR",
    help="How many times as fast as it was flown.",
)
@click.option("--loop", is_flag=True, help="Begin again at the end.")
@click.option("--from", "from_s", type=FiniteRange(min=0), metavar="S", help="Begin S seconds in.")
@click.option("--to", "to_s", type=FiniteRange(min=0), metavar="S", help="End S seconds in.")
@click.option("--vehicle", type=SYSID, metavar="SYSID", help="This vehicle's frames only.")
def replay(
    file: Path | None,
    last: bool,
    links: tuple[str, ...],
    speed: float,
    loop: bool,
    from_s: float | None,
    to_s: float | None,
    vehicle: int | None,
) -> None:
    """Play the frames of FILE's vehicle over UDP, in the times at which they came.

    What clients answer or ask is not heard: a recorded vehicle does nothing.
    """
    from gcs.cli.topic.source import records_of
    from gcs.replay.frames import vehicle_frames
    from gcs.replay.player import Player

    file = one_record(file, last=last)
    with tempfile.TemporaryFile(buffering=1 << 20) as spool:
        frames = vehicle_frames(records_of(file), spool, sysid=vehicle, from_s=from_s, to_s=to_s)
        if not len(frames):
            raise ExitError(
                ExitCode.BAD_FILE,
                f"{file}: no frame of a vehicle in it"
                + (" in that time" if from_s or to_s else ""),
                f"gcs log info {file} tells what is",
            )
        with _opened(links or (DEFAULT_TO,)) as outlets, _keys() as keyboard:
            player = Player(frames.times_ns, time.perf_counter_ns(), speed=speed, loop=loop)
            to = ", ".join(str(link.endpoint) for link in outlets)
            click.echo(
                f"{file}: {len(frames)} frames, {player.length_s:.1f} s, to {to}; "
                f"{frames.left_out} of ground stations are left out"
            )
            if keyboard.usable:
                click.echo(KEYS_HELP)
            told = _Told(sys.stderr.isatty())
            try:
                _play(player, frames, outlets, keyboard, told)
            except KeyboardInterrupt:
                pass
            finally:
                told.clear()
    refused = sum(link.counters.refused for link in outlets)
    click.echo(f"{told.sent} frames sent, {told.ignored} of clients ignored")
    if player.slipped:
        click.echo(f"this computer was over a second late {player.slipped} times", err=True)
    if refused:
        click.echo(f"nobody listened at first, or all the time: {refused} refused", err=True)


def _play(
    player: Player, frames: Frames, outlets: list[Link], keyboard: _Keyboard, told: _Told
) -> None:
    """Until the end, or until it is left by a key."""
    while not player.ended:
        now_ns = time.perf_counter_ns()
        due = player.advance(now_ns)
        for number in range(due.first, due.end):
            raw = frames.read(number)
            for link in outlets:
                link.send(raw)
        told.sent += due.end - due.first
        deadline_ns = player.deadline_ns()
        wait_s = LONGEST_WAIT_S
        if deadline_ns is not None:
            wait_s = min(max(0.0, (deadline_ns - time.perf_counter_ns()) / 1e9), LONGEST_WAIT_S)
        watched = [link.fileno() for link in outlets] + keyboard.filenos
        ready, _, _ = select.select(watched, [], [], wait_s)
        for link in outlets:
            if link.fileno() in ready:
                told.ignored += len(link.drain(BURST))
        if any(fd in ready for fd in keyboard.filenos) and not keyboard.act(player):
            return
        told.show(player)


class _Told:
    """What is counted, and the one line on a terminal that says where it is."""

    def __init__(self, shown: bool) -> None:
        self.sent = 0
        self.ignored = 0
        self._shown = shown
        self._at_s = 0.0

    def show(self, player: Player) -> None:
        now_s = time.monotonic()
        if not self._shown or now_s - self._at_s < SHOW_S:
            return
        self._at_s = now_s
        state = "paused" if player.paused else f"x {player.speed:g}"
        at_s = player.position_s(time.perf_counter_ns())
        line = f"{at_s:8.1f} of {player.length_s:.1f} s  {state}  {self.sent} frames sent"
        again = f", round {player.rounds + 1}" if player.rounds else ""
        click.echo(f"\r\x1b[K{line}{again}, {self.ignored} ignored", nl=False, err=True)

    def clear(self) -> None:
        if self._shown:
            click.echo("\r\x1b[K", nl=False, err=True)


@contextmanager
def _opened(links: tuple[str, ...]) -> Iterator[list[Link]]:
    """Raises ExitError."""
    from gcs.shell.endpoints import EndpointError, Kind, parse_endpoint
    from gcs.shell.sockets import open_link
    from gcs.shell.sockets.base import AddressInUse

    outlets: list[Link] = []
    try:
        for text in links:
            endpoint = parse_endpoint(text)
            if endpoint.kind not in (Kind.UDP_OUT, Kind.UDP_IN):
                hint = f"such as {DEFAULT_TO}"
                raise ExitError(ExitCode.USAGE, f"{text}: it is played over UDP only", hint)
            outlets.append(open_link(endpoint))
        yield outlets
    except EndpointError as error:
        raise ExitError(ExitCode.USAGE, str(error), error.hint) from error
    except AddressInUse as error:
        raise ExitError(ExitCode.ADDRESS_IN_USE, str(error)) from error
    finally:
        for link in outlets:
            link.close()


class _Keyboard:
    """Single keys of a terminal; without one, nothing to watch."""

    usable = False

    @property
    def filenos(self) -> list[int]:
        return [sys.stdin.fileno()] if self.usable else []

    def act(self, player: Player) -> bool:
        """Do what was pressed; False to end."""
        import os

        from gcs.replay.player import keys_of

        pressed = os.read(sys.stdin.fileno(), 64)
        for key in keys_of(pressed):
            if key is None:
                return False
            player.press(key, time.perf_counter_ns())
        return bool(pressed)


@contextmanager
def _keys() -> Iterator[_Keyboard]:
    """The terminal gives single keys meanwhile, and is as it was afterwards."""
    keyboard = _Keyboard()
    if sys.platform == "win32" or not sys.stdin.isatty():
        yield keyboard
        return
    import termios
    import tty

    fd = sys.stdin.fileno()
    before = termios.tcgetattr(fd)
    try:
        tty.setcbreak(fd)
        keyboard.usable = True
        yield keyboard
    finally:
        with suppress(termios.error):
            termios.tcsetattr(fd, termios.TCSADRAIN, before)
