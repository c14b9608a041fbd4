"""What a program makes of a `PreflightReport`: what is still to be read, and how it is written."""

from __future__ import annotations

from collections.abc import Iterator

from gcs import ipc
from gcs.operator.text.control_text import as_typed_now

SIGNS = {"pass": "pass", "caution": "CAUTION", "fail": "FAIL"}


def waiting(report: ipc.PreflightReport) -> list[str]:
    """The names of the rows that wait for what may still come by itself."""
    return [row.name for row in report.rows if row.waits]


def to_read(report: ipc.PreflightReport) -> Iterator[list[ipc.Ask]]:
    """Requests that read what the station has not read; of each list the first that is completed is
    enough."""
    for names in report.unread:
        yield [ipc.Ask(0, "param_get", name=name) for name in names]
    if report.mission_unverified:
        yield [ipc.Ask(0, "mission_check")]


def lines(
    report: ipc.PreflightReport, seen: ipc.Snapshot | None = None, me: int = 0
) -> Iterator[str]:
    """A line a row, with the commands that mend it below, and a last line that sums up.  `seen`:
    who is in control of the station; `me` is the operator who reads it."""
    width = max(len(row.name) for row in report.rows)
    for row in report.rows:
        yield f"{SIGNS[row.verdict]:<8} {row.name:<{width}}  {row.sentence}"
        for command in row.remedies:
            yield f"{'':8} {'':{width}}  > {as_typed_now(command, seen, me)}"
    yield f"preflight: {summary(report)}"


def summary(report: ipc.PreflightReport) -> str:
    """`fails: gps, battery; caution: failsafes`, or that all pass."""
    words = [
        f"{word}: {', '.join(names)}"
        for word, verdict in (("fails", "fail"), ("caution", "caution"))
        if (names := [row.name for row in report.rows if row.verdict == verdict])
    ]
    return "; ".join(words) or "all pass"
