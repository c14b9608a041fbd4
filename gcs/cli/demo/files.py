"""What the demo writes beside its record, so that it can be looked at: a layout and a report."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Written:
    """A file beside the record, and what to do with it."""

    path: Path
    purpose: str


def write_beside(log_path: str) -> list[Written]:
    """The files that were written; one that cannot be is left out, as the record is what counts."""
    record = Path(log_path)
    return [file for file in (_write_layout(record), _write_report(record)) if file is not None]


def _write_layout(record: Path) -> Written | None:
    import json

    from gcs.mcap_file.errors import BadRecordError
    from gcs.record.viewer.layout import layout_for

    path = record.with_suffix(".layout.json")
    try:
        path.write_text(json.dumps(layout_for(record), indent=1) + "\n", encoding="utf-8")
    except (BadRecordError, OSError):
        return None
    return Written(path, "how a viewer should show it")


def _write_report(record: Path) -> Written | None:
    from gcs.flight_report.render import page
    from gcs.flight_report.scan import scan
    from gcs.mcap_file.errors import BadRecordError

    path = record.with_suffix(".html")
    try:
        path.write_text(page(scan(record)), encoding="utf-8", errors="replace")
    except (BadRecordError, OSError):
        return None
    return Written(path, "the flight on one page: open it in a browser")
