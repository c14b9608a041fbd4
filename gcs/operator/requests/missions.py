"""Missions, fences and rally points, as a Python program asks for them."""

from __future__ import annotations

import os

from gcs import ipc
from gcs.operator import arguments
from gcs.operator.operation import Operation
from gcs.operator.requests.asks import Asks

Path = str | os.PathLike[str]


@arguments.all_called_right
class Missions(Asks):
    """The mission on board, its fence and its rally points."""

    def fly(self, path: Path, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Upload a mission file (or a shipped mission by its name), then start it."""
        self.upload(path)
        return self.start_mission(wait=wait, timeout_s=timeout_s)

    def upload(self, path: Path, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Verify a mission file, send it to the vehicle and read it back."""
        file = arguments.path("upload", path=path)
        return self.request(ipc.Ask(0, "mission_upload", path=file), wait, timeout_s)

    def download(
        self, path: Path, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Read mission, fence and rally points on board, and where home is, into a file."""
        file = arguments.path("download", path=path)
        return self.request(ipc.Ask(0, "mission_download", path=file), wait, timeout_s)

    def clear_mission(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Remove the mission on board; its fence and rally points stay."""
        return self.request(ipc.Ask(0, "mission_clear"), wait, timeout_s)

    def put_fence(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Put the policy's own fence on board, so that the vehicle keeps it when the link is down.

        On the ground; else Refused with IN_AIR.
        """
        return self.request(ipc.Ask(0, "fence_put"), wait, timeout_s)

    def upload_fence(
        self, path: Path, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Send the fence of a file to the vehicle, in place of the one on board."""
        file = arguments.path("upload_fence", path=path)
        return self.request(ipc.Ask(0, "fence_upload", path=file), wait, timeout_s)

    def download_fence(
        self, path: Path, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Read the fence on board into a file."""
        file = arguments.path("download_fence", path=path)
        return self.request(ipc.Ask(0, "fence_download", path=file), wait, timeout_s)

    def clear_fence(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Remove the fence on board.  On the ground; else Refused with IN_AIR."""
        return self.request(ipc.Ask(0, "fence_clear"), wait, timeout_s)

    def upload_rally(
        self, path: Path, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Send the rally points of a file to the vehicle, in place of those on board."""
        file = arguments.path("upload_rally", path=path)
        return self.request(ipc.Ask(0, "rally_upload", path=file), wait, timeout_s)

    def download_rally(
        self, path: Path, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Read the rally points on board into a file."""
        file = arguments.path("download_rally", path=path)
        return self.request(ipc.Ask(0, "rally_download", path=file), wait, timeout_s)

    def clear_rally(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Remove the rally points on board."""
        return self.request(ipc.Ask(0, "rally_clear"), wait, timeout_s)

    def start_mission(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Fly the mission on board."""
        return self.request(ipc.Ask(0, "mission_start"), wait, timeout_s)
