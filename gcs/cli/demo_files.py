"""What the demo writes beside its record, so that it can be looked at: the layout."""

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
    layout = _write_layout(Path(log_path))
    return [layout] if layout is not None else []


def _write_layout(record: Path) -> Written | None:
    import json

    from gcs.record.layout import layout_for
    from gcs.record.reading import BadRecordError

    path = record.with_suffix(".layout.json")
    try:
        path.write_text(json.dumps(layout_for(record), indent=1) + "\n", encoding="utf-8")
    except (BadRecordError, OSError):
        return None
    return Written(path, "how a viewer should show it")
