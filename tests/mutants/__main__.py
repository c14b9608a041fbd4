"""Alters the code under test one place at a time, and asks whether a test notices.

    python -m tests.mutants                      the gate, all of it
    python -m tests.mutants vehicle              the vehicle's failsafes and estimator
    python -m tests.mutants vehicle --share 3/20 the third of twenty parts, spread evenly
    python -m tests.mutants --list               say which mutants there are, run nothing
    python -m tests.mutants --only stopping.py   those whose key contains the word
    python -m tests.mutants --sample 200         so many, spread evenly
    python -m tests.mutants --package src/p --tests tests/p   any other package

A *mutant* is the code with one alteration: `source.py`, `settings.py` and `gate_table.py` say which
there are.  It is *killed* if a test fails on it, and *survives* if none does: then either no test
looks at that place, or the alteration changes nothing that can be seen.  The latter are listed in
`equivalent.py` with the reason; an entry there that names no mutant, or one that is killed, is an
error.  A mutant that used ten times the time of its tests and five seconds is *timed out*, and
counts as killed.

How it is quick: the tests run once and it is noted which of them run which line and read which
entry of a table; a mutant faces only those that reach it, the quickest first, until one fails.
Each mutant has a process of its own, forked from one that has imported all libraries and nothing
of the package under test; there, an import hook loads the altered module.  Properties are asked
50 examples each, always the same ones.  `slow` tests of the target run with `--slow` only.

The exit code is 1 where fewer than 95 % are killed (of those that are not equivalent), or where
`equivalent.py` is wrong, and 2 where the tests fail with nothing altered.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from tests.mutants.equivalent import EQUIVALENT, UNREACHED
from tests.mutants.mutant import Mutant, Result
from tests.mutants.names import Mentions, Uses
from tests.mutants.report import Report
from tests.mutants.run import BaselineError, Chooser, baseline, generate, judge, preload
from tests.mutants.targets import TARGETS, Target


def main(arguments: Sequence[str] | None = None) -> int:
    options = _options(arguments)
    target = _target(options)
    sys.path.insert(0, str(target.root))
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # a process that forks has no threads
    with tempfile.TemporaryDirectory() as compiled:
        sys.dont_write_bytecode, sys.pycache_prefix = False, compiled
        return _run(target, options)


def _run(target: Target, options: argparse.Namespace) -> int:
    began = time.monotonic()
    mutants, enums = generate(target)
    chosen = _chosen(mutants, options)
    if options.list:
        for mutant in chosen:
            print(f"{mutant.where}: {mutant.kind}: {mutant.key}")
        print(f"{len(chosen)} of {len(mutants)} mutants")
        return 0
    try:
        base = baseline(target, slow=options.slow)
    except BaselineError as error:
        print(error, file=sys.stderr)
        return 2
    preload(base.imported)
    uses = Uses(target.sources(), target.root)
    chooser = Chooser(target, base, uses, Mentions(target.test_files(), target.root))
    print(f"{len(chosen)} of {len(mutants)} mutants, {len(base.seconds)} tests", flush=True)
    results: list[Result] = []
    for result in judge(target, enums, chosen, chooser, options.workers):
        results.append(result)
        _progress(results, len(chosen), began)
    equivalent, unreached = EQUIVALENT.get(target.name, {}), UNREACHED.get(target.name, {})
    report = Report.of(mutants, results, equivalent, unreached, time.monotonic() - began)
    print(report.text())
    if options.json:
        Path(options.json).write_text(report.json(), encoding="utf-8")
    return 0 if report.passed else 1


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        "python -m tests.mutants", formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.description = __doc__
    parser.add_argument("target", choices=sorted(TARGETS), default="gate", nargs="?")
    parser.add_argument("--package", help="a folder to alter, in the place of the target's")
    parser.add_argument("--tests", help="with --package: the folder of its tests")
    parser.add_argument("--root", default=".", help="with --package: where both are")
    parser.add_argument("--only", default="", help="mutants whose key has this in it")
    parser.add_argument("--sample", type=int, help="so many of them, spread evenly")
    parser.add_argument("--share", type=_share, help="K/N: every Nth of them, from the Kth on")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--slow", action="store_true", help="with the target's slow tests")
    parser.add_argument("--list", action="store_true", help="say which there are, run nothing")
    parser.add_argument("--json", help="write what became of each to this file")
    return parser.parse_args(arguments)


def _target(options: argparse.Namespace) -> Target:
    if options.package is None:
        return TARGETS[options.target]
    root = Path(options.root).resolve()
    return Target("other", (options.package,), (options.tests or "tests",), root=root)


def _share(text: str) -> tuple[int, int]:
    """`K/N`, K from 1 to N."""
    which, _, of = text.partition("/")
    if not (which.isdecimal() and of.isdecimal() and 1 <= int(which) <= int(of)):
        raise argparse.ArgumentTypeError(f"{text!r} is not K/N with K from 1 to N, as 1/20 is")
    return int(which), int(of)


def _chosen(mutants: Sequence[Mutant], options: argparse.Namespace) -> list[Mutant]:
    chosen = [mutant for mutant in mutants if options.only in mutant.key]
    if options.share is not None:
        which, of = options.share
        chosen = chosen[which - 1 :: of]
    if options.sample is None or options.sample >= len(chosen):
        return chosen
    return [chosen[i * len(chosen) // options.sample] for i in range(options.sample)]


def _progress(results: Sequence[Result], of: int, began: float) -> None:
    """One line that is written over where there is a terminal, else one line a hundred."""
    done = len(results)
    line = (
        f"{done}/{of}, {sum(not r.dead for r in results)} survive, {time.monotonic() - began:.0f} s"
    )
    if sys.stdout.isatty():
        print(f"\r{line}", end="" if done < of else "\n", flush=True)
    elif done % 100 == 0:
        print(f"{line}, load {os.getloadavg()[0]:.1f}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
