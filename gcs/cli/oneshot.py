"""The one-shot commands, made from the table of words: `gcs goto 3 0 2`, `gcs land`, ..."""

from __future__ import annotations

from functools import partial
from typing import Unpack

import click

from gcs import request_words
from gcs.cli import completers
from gcs.cli.common_options import COMMON, MeetsVehicle, ToVehicle, set_up
from gcs.cli.options import TAKE, UTF8, Seconds
from gcs.operator import line_parser

EXITS = (
    "Exit codes: 0 done, 2 usage, 3 no vehicle, 5 refused by the vehicle, 6 refused by the gate, "
    "8 accepted but not completed, 9 address in use, 130 interrupted."
)
WAIT = click.Option(
    ["--wait"],
    type=Seconds(),
    default=300.0,
    show_default=True,
    metavar="S",
    help="Seconds to wait for the effect.",
)


def _command(name: str) -> click.Command:
    word = request_words.WORD_BY_NAME[name]

    def run_word(arguments: tuple[str, ...] = (), **to: Unpack[ToVehicle]) -> None:
        try:
            action = line_parser.parse_arguments(word, arguments)
        except line_parser.LineError as error:
            raise click.UsageError(f"{error.sentence}\n  hint: {error.hint}") from None
        assert isinstance(action, request_words.SendRequests)

        from gcs.cli import oneshot_session

        stops = all(request.word in request_words.STOPS for request in action.requests)
        placed = name not in ("abort", "hold")
        setup, how = set_up(name, name, to, placed=placed, stops=stops)
        code = oneshot_session.run(setup, how, oneshot_session.sending(action, to["wait"]))
        click.get_current_context().exit(code)

    typed_here = click.Argument(["arguments"], nargs=-1, type=UTF8, metavar=word.usage)
    if name == "mode":
        typed_here = click.Argument(
            ["arguments"],
            nargs=-1,
            type=UTF8,
            metavar=word.usage,
            shell_complete=completers.modes,
        )
    options: list[click.Parameter] = [WAIT, *COMMON]
    if name in request_words.STOPS:
        options.remove(TAKE)
    return MeetsVehicle(
        name,
        callback=run_word,
        params=[typed_here, *options] if word.arguments else options,
        help=word.help[0].upper() + word.help[1:] + ".",
        epilog=f"Example: gcs {word.example}\n\n{EXITS}",
        # Negative numbers look like options; what is no option of ours is an argument.
        context_settings={"ignore_unknown_options": bool(word.arguments)},
        options_metavar="[OPTIONS]",
    )


def __getattr__(name: str) -> click.Command:
    """The command of a word, as `main.py` names it."""
    if name not in request_words.WORD_BY_NAME:
        raise AttributeError(name)
    return _command(name)


def _status(**to: Unpack[ToVehicle]) -> None:
    from gcs.cli import oneshot_session
    from gcs.cli.status import report

    setup, how = set_up("status", "status", to, record=False, cautions=True)
    code = oneshot_session.run(setup, how, partial(report, as_json=to["as_json"]))
    click.get_current_context().exit(code)


status = MeetsVehicle(
    "status",
    callback=_status,
    params=[each for each in COMMON if each is not TAKE],
    help="What the vehicle reports: state, mode, position, battery, link.",
    epilog=f"Example: gcs status --json\n\n{EXITS}",
)
