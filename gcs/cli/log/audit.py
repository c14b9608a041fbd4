"""`gcs log audit`: is what the gate decided, and what was sent, what it decides again?

`gcs log sign`: so that nobody without the key can alter a record unseen.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gcs.cli.key import read_key_file
from gcs.cli.options import UTF8
from gcs.cli.records.files import LAST, RECORD, chosen, one_record, told
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.audit.audit import AuditResult, Difference, OwnRule
    from gcs.audit.files import SessionFiles
    from gcs.frames import Vec3
    from gcs.gate.policy.policy import Policy
    from gcs.wire.signing import SecretKey

_PROGRESS_FROM_BYTES = 500_000
"""Smaller files are audited in less than a second."""


@click.command()
@click.argument("files", type=RECORD, nargs=-1, metavar="FILE...")
@LAST
@click.option("--show", default=10, show_default=True, help="How many differences are printed.")
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object a session, one a line.")
@click.option(
    "--key",
    type=UTF8,
    metavar="KEYFILE",
    help="Each file must be as `gcs log sign` has signed it with this key.",
)
@click.option(
    "--verifier",
    type=UTF8,
    default="",
    metavar="FILE",
    help="Run this file, and ask it again what the operator's own rule (gcs fly --verifier) was "
    "asked. Without it no rule is run: its answers are taken from the record.",
)
@click.pass_context
def audit(
    ctx: click.Context,
    files: tuple[Path, ...],
    show: int,
    as_json: bool,
    key: str | None,
    verifier: str,
    last: bool,
) -> None:
    """Do again what a station did, from its record, and compare.

    Every input that was recorded is given to a fresh session: each decision, each frame that was
    sent, each log line and each other message must come out as it is in the record, byte for
    byte. The files of a session that has several parts are named together. The exit code is 1
    where anything differs, and where a record has no end, as that of a station that was killed.
    Who knows how can make a record whose parts agree with one another: only --key finds that.

    Examples: gcs log audit --last  |  gcs log audit logs/*.mcap --json
    """
    import msgspec

    from gcs.audit.files import sessions

    files = files if files and not last else (one_record(next(iter(files), None), last=last),)
    with told(files[0]):
        found = sessions(files)
    rule = _own_rule(verifier) if verifier else None
    results = []
    for number, session in enumerate(found):
        result = _audited(session, rule)
        if key is not None:
            _check_signatures(session, result, read_key_file(key))
        results.append(result)
        if as_json:
            names = [str(path).encode(errors="backslashreplace").decode() for path in session.paths]
            values = {"paths": names, "good": result.good, **msgspec.to_builtins(result)}
            values["first"] = values["first"][:show]
            click.echo(msgspec.json.encode(values).decode())
        else:
            if number:
                click.echo()
            _print(session, result, show)
    good = all(each.good and each.ended for each in results)
    ctx.exit(ExitCode.DONE if good else ExitCode.DIFFERENT)


def _own_rule(path: str) -> OwnRule:
    """The auditor's own file, loaded; never one that a record brings along."""
    from gcs.shell.rule_child import BadRuleError, judge, legs_of, load
    from gcs.shell.rule_process import rule_policy

    try:
        verify = load(path, Path(path).read_text(encoding="utf-8"))
    except BadRuleError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error)) from error
    except (OSError, UnicodeDecodeError) as error:
        text = f"{path}: {getattr(error, 'strerror', None) or error}"
        raise ExitError(ExitCode.BAD_FILE, text) from error

    def rule(legs_enu: tuple[tuple[Vec3, Vec3], ...], policy: Policy) -> tuple[str | None, bool]:
        answer = judge(verify, path, legs_of(legs_enu), rule_policy(policy))
        return answer.refusal, answer.failed

    return rule


def _audited(session: SessionFiles, rule: OwnRule | None) -> AuditResult:
    from gcs import __version__
    from gcs.audit.audit import audit as audit_session
    from gcs.audit.turns import NoStartError
    from gcs.shell.environment import environment

    with told(session.paths[0]), _progress(session) as progress:
        try:
            messages = session.messages(progress)
            attachments = session.attachments()
            result = audit_session(messages, attachments, __version__, environment(), rule)
        except NoStartError as error:
            text = f"{session.paths[0]}: cannot be audited: {error}"
            raise ExitError(ExitCode.BAD_FILE, text, error.hint) from error
    wrong = {
        "{} damaged records of the file could not be read": session.damaged,
        "{} messages have another number or publish time than was written": session.misnumbered,
        "{} bytes stand behind the end of the record": session.behind_bytes,
    }
    for text, count in wrong.items():
        if count:
            result.whole = False
            result.notes.append(text.format(count))
    return result


def _check_signatures(session: SessionFiles, result: AuditResult, key: SecretKey) -> None:
    from gcs.record.signature import why_not_signed

    for path in session.paths:
        with told(path):
            why_not = why_not_signed(path, key)
        result.whole &= not why_not
        result.notes.append(f"{path.name}: {why_not or f'signed with {key.fingerprint}'}")


def _print(session: SessionFiles, result: AuditResult, show: int) -> None:
    names = ", ".join(map(str, session.paths))
    click.echo(f"{names}: {result.seconds:.1f} s, recorded by mavgate {result.version}")
    for title, counts in (("inputs", result.inputs), ("compared", result.compared)):
        parts = sorted(counts.items(), key=lambda each: -each[1])
        click.echo(f"  {title:8}  {sum(counts.values()):7d}  ", nl=False)
        click.echo(", ".join(f"{name} {count}" for name, count in parts))
    for note in result.notes:
        click.echo(f"  note: {note}")
    for difference in result.first[:show]:
        _print_difference(difference)
    if result.differences:
        more = result.differences - min(show, len(result.first))
        rest = f", {more} more than are shown" if more > 0 else ""
        click.echo(f"{result.differences} differences{rest}")
    elif result.whole and not result.ended:
        click.echo("no difference in what is there, but the record has no end")
    elif result.whole:
        click.echo("no difference: every decision and every message is reproduced")
    else:
        click.echo("no difference in what could be audited, which is not all")


def _print_difference(difference: Difference) -> None:
    click.echo(f"\n{difference.t_s:10.3f} s  {difference.kind}, after {difference.after}")
    click.echo(f"    recorded    {difference.recorded}")
    click.echo(f"    reproduced  {difference.reproduced}")


@contextmanager
def _progress(session: SessionFiles) -> Iterator[Callable[[Path, int], None] | None]:
    """A bar on a terminal, over all files of the session."""
    sizes = [path.stat().st_size for path in session.paths]
    if sum(sizes) < _PROGRESS_FROM_BYTES or not sys.stderr.isatty():
        yield None
        return
    before = {path: sum(sizes[:number]) for number, path in enumerate(session.paths)}
    with click.progressbar(length=sum(sizes), label="auditing", file=sys.stderr) as bar:
        yield lambda path, read_bytes: bar.update(before[path] + read_bytes - bar.pos)


@click.command(epilog="Example: gcs log sign logs/20260101-120000_flight.mcap --key records.key")
@click.argument("files", type=RECORD, nargs=-1, metavar="FILE...")
@LAST
@click.option(
    "--key", type=UTF8, required=True, metavar="KEYFILE", help="As `gcs key new` makes it."
)
def sign(files: tuple[Path, ...], last: bool, key: str) -> None:
    """Sign a record, in a file beside it; gcs log audit --key KEYFILE checks it.

    The signature is over every byte: a record that is compacted or otherwise written anew is signed
    anew. Keep the key where whoever might alter the record does not come.
    """
    from gcs.record.signature import sign as sign_record

    secret = read_key_file(key)
    for file in chosen(files, last=last):
        with told(file):
            path = sign_record(file, secret)
        click.echo(f"{path}: signed with {secret.fingerprint}")
