"""A Ctrl-C at several moments of every command there is, by the first example of its help.

`python -m tools.ctrl_c [SECONDS ...]`: by default 0.3, 0.8 and 1.5 after the start.  No station
that runs is found and no vehicle is heard: it has a runtime folder of its own, and a free port
where a command takes a link.  It prints every interruption that had a traceback of ours or left a
process, then how many there were, and exits 1 where there was one.
"""

from __future__ import annotations

import os
import shlex
import sys
import tempfile

import click

from tests.system.test_ctrl_c import NOBODY, Interrupted, interrupt
from tests.unit.cli.test_every_command import COMMANDS, examples

TIMES_S = (0.3, 0.8, 1.5)


def words_of(name: str, command: click.Command) -> list[str]:
    """Its first example, with nobody on the link."""
    line = next(each for each in examples(command) if f"{each} ".startswith(f"{name} "))
    takes_link = any("--link" in option.opts for option in command.params)
    words = shlex.split(line)[1:]
    alone = takes_link and not {"--link", "--sim", "--explain"} & set(words)
    return [*words, *NOBODY.split()] if alone else words


def is_bad(ended: Interrupted) -> bool:
    traceback = "Traceback" in ended.told and not ended.before_us
    return traceback or bool(ended.left)


def main(times_s: list[float]) -> int:
    bad, interrupted, all_of_them = 0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_RUNTIME_DIR"] = folder
        for name, command in COMMANDS.items():
            for at_s in times_s:
                ended = interrupt(at_s, *words_of(name, command))
                all_of_them += 1
                interrupted += ended.good or ended.before_us
                if is_bad(ended):
                    bad += 1
                    print(f"{name} at {at_s:g} s: exit {ended.exit_code}, left {ended.left}")
                    print(ended.told, flush=True)
    print(f"{all_of_them} starts of {len(COMMANDS)} commands, {interrupted} interrupted, {bad} bad")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main([float(each) for each in sys.argv[1:]] or [*TIMES_S]))
