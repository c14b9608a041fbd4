"""The file with the layout of this live view, beside the record, for as long as it serves.

It is written anew when a vehicle comes or the fence changes.  It holds the control code, so that
only its user can read it, and it goes with the live view: then the code is worth nothing.  What a
live view that was killed has left, the next one takes away.
"""

from __future__ import annotations

import contextlib
import json
import os
import re
from collections.abc import Iterable
from pathlib import Path

from gcs import ipc
from gcs.record.fence_topic import FENCE_TOPIC
from gcs.record.viewer.extent import fence_of
from gcs.record.viewer.live_layout import live_layout
from gcs.report import FenceItem

_VEHICLE = re.compile(r"/vehicle/(\d+)/")
_LAYOUT = re.compile(r"(\d{8}-\d{6}_.+)_viewer-\d{1,5}\.json(\.new)?")
_PART = re.compile(r"_part\d+$")


def remove_left(folder: Path, running: Iterable[str]) -> None:
    """Layouts of sessions that are over: `running` are the records of those that are not."""
    sessions = {_PART.sub("", Path(log_path).stem) for log_path in running}
    for file in folder.glob("*_viewer-*.json*"):
        found = _LAYOUT.fullmatch(file.name)
        if found is not None and _PART.sub("", found[1]) not in sessions:
            with contextlib.suppress(OSError):
                file.unlink()


class SessionLayout:
    """`path` is empty where it cannot be written; `why` says so."""

    def __init__(self, log_path: str, port: str, code: str) -> None:
        self._code = code
        self._vehicles: list[int] = []
        self._fence: FenceItem | None = None
        self._fence_number = 0
        self._fence_data = b""
        self.path = f"{Path(log_path).with_suffix('')}_viewer-{port}.json" if log_path else ""
        self.why = "" if log_path else "this station does not record"
        self._write()

    def topic(self, told: ipc.Topic) -> None:
        if told.topic == FENCE_TOPIC:
            self._fence_number = told.number
        found = _VEHICLE.match(told.topic)
        if found is not None and (number := int(found[1])) not in self._vehicles:
            self._vehicles.append(number)
            self._write()

    def message(self, told: ipc.TopicMessage) -> None:
        if told.number == self._fence_number and told.data != self._fence_data:
            self._fence_data = told.data
            self._fence = fence_of(told.data)
            self._write()

    def remove(self) -> None:
        if self.path:
            Path(self.path).unlink(missing_ok=True)

    def _write(self) -> None:
        if not self.path:
            return
        made = live_layout(self._vehicles, self._fence, self._code)
        new = f"{self.path}.new"
        try:
            descriptor = os.open(new, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
            with os.fdopen(descriptor, "w", encoding="utf-8") as file:
                json.dump(made, file, indent=1)
            os.replace(new, self.path)
        except OSError as error:
            self.why = f"{self.path}: {error.strerror or error}"
            self.path = ""
