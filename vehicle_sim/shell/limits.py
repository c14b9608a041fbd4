"""What the system allows one process: a fleet has more sockets than are usually let open."""

from __future__ import annotations

from typing import Final

SPARE: Final = 64
"""Open files beside the sockets: standard streams, logs, clients of TCP links."""


def allow_sockets(count: int) -> None:
    """Raise the soft limit of open files to what `count` sockets need, as far as it goes.

    What is refused shows when the sockets are opened.  Windows has no such limit.
    """
    try:
        import resource
    except ImportError:
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = count + SPARE
    if soft == resource.RLIM_INFINITY or soft >= wanted:
        return
    if hard != resource.RLIM_INFINITY:
        wanted = min(wanted, hard)
    try:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
    except (OSError, ValueError):
        # macOS refuses more than kern.maxfilesperproc, whatever the hard limit says.
        return
