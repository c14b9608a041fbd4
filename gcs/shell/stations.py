"""The stations that run on this machine, as files in a folder of their user.

Each station has a description (JSON) and beside it, on Linux and macOS, its socket.  The folder is
`$XDG_RUNTIME_DIR/mavgate`, or one of the user's own in the folder for temporary files, or
`~/.mavgate` where somebody else has made that first; on Windows `%LOCALAPPDATA%\\mavgate`.
Stations are looked for in each that may be, as somebody else's folder may come and go.
Only its user may look into it.  A description whose station has died
is removed by whoever finds it.
"""

from __future__ import annotations

import contextlib
import os
import socket
import stat
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

import msgspec

from gcs.shell.endpoints import Endpoint, EndpointError, Kind, parse_endpoint

SUFFIX = ".json"
CONNECT_WAIT_S = 1.0
WILDCARDS = ("0.0.0.0", "::")


class Unsafe(Exception):  # noqa: N818 - a state of the folder, told with its reason
    """The folder cannot be trusted: it is another user's, or others can write to it."""


class Description(msgspec.Struct, frozen=True):
    """One station, as anyone of its user finds it."""

    pid: int
    schema: int  # of the lines on its socket, see `gcs.ipc.SCHEMA`
    endpoints: list[str]  # in the form of `--link`, with the ports that are really used
    socket_path: str = ""  # empty where it is a port
    port: int = 0  # TCP, on 127.0.0.1
    token: str = ""  # what a `join` must bring, where it is a port
    vehicle: str = ""  # empty before one is heard
    vehicles: list[str] = []  # of a bridge that flies all it meets: those that are heard
    log_path: str = ""
    started_ns: int = 0
    keep: bool = False
    policy: str = ""  # its name
    policy_digest: str = ""  # see gcs/policy_digest.py
    speedup: float = 1.0


def folders_of(environment: Mapping[str, str] = os.environ) -> list[Path]:
    """Where this user's stations may be, the usual place first; none need exist."""
    if sys.platform == "win32":
        return [Path(environment.get("LOCALAPPDATA") or tempfile.gettempdir()) / "mavgate"]
    runtime = Path(environment.get("XDG_RUNTIME_DIR") or os.devnull)
    if runtime.is_dir():
        return [runtime / "mavgate"]
    folders = [Path(tempfile.gettempdir()) / f"mavgate-{os.getuid()}"]
    with contextlib.suppress(RuntimeError):
        folders.append(Path.home() / ".mavgate")
    return folders


def folder_of(environment: Mapping[str, str] = os.environ) -> Path:
    """Where a new station of this user belongs; it need not exist."""
    folders = folders_of(environment)
    # Anybody may have made the first one, and could else take `gcs abort` away.
    return folders[0] if not why_unsafe(folders[0]) else folders[-1]


def why_unsafe(folder: Path) -> str:
    """Why it cannot be trusted; empty where it can, or does not exist."""
    try:
        check(folder)
    except Unsafe as error:
        return str(error)
    except OSError:
        pass
    return ""


def made_safe(folder: Path) -> Path:
    """The folder, made if need be.  Raises Unsafe, or OSError."""
    with contextlib.suppress(FileExistsError):
        folder.mkdir(mode=0o700, parents=True)
    check(folder)
    return folder


def check(folder: Path) -> None:
    """Raises Unsafe if others may have put something there, OSError if it does not exist."""
    if sys.platform == "win32":
        return  # what is under the user's profile is the user's
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode):
        raise Unsafe(f"{folder} is no folder")
    if found.st_uid != os.getuid():
        raise Unsafe(f"{folder} belongs to another user")
    if found.st_mode & 0o077:
        raise Unsafe(f"{folder} can be used by other users (mode {found.st_mode & 0o777:o})")


def write(folder: Path, description: Description) -> Path:
    """Put the description there, whole or not at all.  Raises OSError."""
    path = folder / f"{description.pid}{SUFFIX}"
    new = path.with_suffix(".new")
    descriptor = os.open(new, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    with os.fdopen(descriptor, "wb") as file:
        file.write(msgspec.json.encode(description))
    new.replace(path)
    return path


def running(*folders: Path) -> list[Description]:
    """Those that live, the oldest first; what dead ones left is removed.

    A folder that is not there holds none, and so does one that others can write to.
    """
    found = [each for folder in folders for each in _running_in(folder)]
    return sorted(found, key=lambda each: each.started_ns)


def _running_in(folder: Path) -> list[Description]:
    try:
        check(folder)
        paths = sorted(folder.glob(f"*{SUFFIX}"))
    except (OSError, Unsafe):
        return []
    found: list[Description] = []
    for path in paths:
        description = _read(path)
        if description is not None and _lives(description):
            found.append(description)
        else:
            _remove(path, description)
    return found


def connect(description: Description) -> socket.socket:
    """A connection to its socket.  Raises OSError."""
    if not description.socket_path:
        return socket.create_connection(("127.0.0.1", description.port), CONNECT_WAIT_S)
    made = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    made.settimeout(CONNECT_WAIT_S)
    try:
        made.connect(description.socket_path)
    except OSError:
        made.close()
        raise
    return made


def holds(description: Description, endpoint: Endpoint) -> bool:
    """Whether the station has that link open, so that nobody else can open it beside it."""
    for text in description.endpoints:
        try:
            held = parse_endpoint(text)
        except EndpointError:
            continue
        if held.kind is endpoint.kind and _same_place(held, endpoint):
            return True
    return False


def _same_place(held: Endpoint, wanted: Endpoint) -> bool:
    if held.kind is Kind.SERIAL:
        return held.device == wanted.device
    if held.port != wanted.port:
        return False
    anywhere = held.listens and (held.host in WILDCARDS or wanted.host in WILDCARDS)
    return anywhere or _numeric(held.host) == _numeric(wanted.host)


def _numeric(host: str) -> str:
    return "127.0.0.1" if host == "localhost" else host


def _read(path: Path) -> Description | None:
    try:
        return msgspec.json.decode(path.read_bytes(), type=Description)
    except (OSError, ValueError):
        return None


def _lives(description: Description) -> bool:
    """Somebody takes connections there; a process id alone may be another program's by now."""
    try:
        connect(description).close()
    except TimeoutError:
        return True  # it is there, and busy or stopped
    except BlockingIOError:
        return True
    except OSError:
        return False
    return True


def _remove(path: Path, description: Description | None) -> None:
    left = [path]
    if description is not None and description.socket_path:
        left.append(Path(description.socket_path))
    for each in left:
        if each.parent == path.parent:
            with contextlib.suppress(OSError):
                each.unlink()
