"""The socket on which a station takes further operators of its user, and its description."""

from __future__ import annotations

import contextlib
import os
import secrets
import socket
import sys
import time
from pathlib import Path

import msgspec

from gcs import ipc
from gcs.shell import stations
from gcs.shell.stations import Description

BACKLOG = 64
UNIX = sys.platform != "win32"


class LocalSocket:
    """Listens from its making to `close`; the description says where.

    Only this user can reach it: a socket of mode 0600 in a folder of mode 0700, or, where there
    are no such sockets (`unix=False`), a TCP port on loopback with a token from a file in that
    folder.
    """

    def __init__(
        self,
        endpoints: list[str],
        log_path: str,
        *,
        keep: bool,
        policy: str = "",
        policy_digest: str = "",
        speedup: float = 1.0,
        several: bool = False,
        folder: Path | None = None,
        unix: bool = UNIX,
    ) -> None:
        """`several`: every vehicle that is met is flown.  Raises OSError, or `stations.Unsafe`."""
        self._several = several
        self._folder = stations.made_safe(folder or stations.folder_of())
        stations.running(self._folder)  # removes what dead stations left
        described = Description(
            os.getpid(),
            ipc.SCHEMA,
            endpoints,
            log_path=_absolute(log_path),
            started_ns=time.time_ns(),
            keep=keep,
            policy=policy,
            policy_digest=policy_digest,
            speedup=speedup,
        )
        if unix:
            path = self._folder / f"{os.getpid()}.sock"
            self.listener = _unix_listener(path)
            self.description = msgspec.structs.replace(described, socket_path=str(path))
        else:
            self.listener = socket.create_server(("127.0.0.1", 0), backlog=BACKLOG)
            port, token = self.listener.getsockname()[1], secrets.token_urlsafe(32)
            self.description = msgspec.structs.replace(described, port=port, token=token)
        try:
            self._path = stations.write(self._folder, self.description)
        except OSError:
            self.listener.close()
            raise

    def describe(self, snapshot: ipc.Snapshot) -> None:
        """Keep the description up to date; writes only when something in it changed."""
        now = msgspec.structs.replace(
            self.description,
            vehicle=snapshot.vehicle,
            vehicles=snapshot.vehicles if self._several else [],
            log_path=_absolute(snapshot.log_path),
        )
        if now != self.description:
            self.description = now
            with contextlib.suppress(OSError):  # a full disk must not disturb the flight
                stations.write(self._folder, now)

    def close(self) -> None:
        """Nobody finds it any more."""
        self.listener.close()
        for path in (self._path, Path(self.description.socket_path or os.devnull)):
            if path.parent == self._folder:
                with contextlib.suppress(OSError):
                    path.unlink()


def _absolute(log_path: str) -> str:
    """Whoever reads the description may be in another folder."""
    return os.path.abspath(log_path) if log_path else ""


def _unix_listener(path: Path) -> socket.socket:
    with contextlib.suppress(FileNotFoundError):
        path.unlink()  # of a dead process that had our number
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    before = os.umask(0o177)
    try:
        listener.bind(str(path))
        listener.listen(BACKLOG)
    except OSError:
        listener.close()
        raise
    finally:
        os.umask(before)
    return listener
