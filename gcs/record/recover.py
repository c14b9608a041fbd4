"""`gcs log recover`: makes a killed file whole."""

from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from gcs.mcap_file.copier import Source, new_record
from gcs.mcap_file.reader import Condition, Progress, Reading


@dataclass(slots=True)
class Recovery:
    """What was saved.  `condition` tells what was wrong with the source."""

    condition: Condition
    messages: int = 0
    attachments: int = 0
    metadata: int = 0
    orphans: int = 0
    """Messages whose channel is in no readable record."""
    seconds: float = 0.0
    """From the first recovered message to the last."""


def recover(source: Path, target: Path, progress: Progress | None = None) -> Recovery:
    """Copy all that can be read of `source` into the new file `target`, indexes and all.

    `progress` is called now and then.  Raises BadRecordError, and OSError (FileExistsError where
    `target` exists).
    """
    reading = Reading(source, progress)
    found = Source()
    with closing(iter(reading)) as records:
        first = next(records, None)  # no target is made for a source that is no MCAP
        with new_record(target) as made:
            for record in chain([first] if first else [], records):
                found.copy(record, made)
    return Recovery(
        reading.condition,
        made.messages,
        made.attachments,
        made.metadata,
        found.orphans,
        made.seconds,
    )
